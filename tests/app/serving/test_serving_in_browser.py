"""The page with the engine behind it, in a real browser: drop, list, move, undo, and save."""

import threading
import time

import numpy as np
import pytest

from exactfold.app.serving import view_server
from exactfold.branches import count_branches, find_branch
from exactfold.pattern import load
from exactfold.pattern.data import example_path

pytestmark = pytest.mark.slow
READY = "window.exactfold && exactfold.view && !exactfold.view.page.busy"


@pytest.fixture(scope="module")
def server(browser):
    with view_server(frames=6) as found:
        thread = threading.Thread(target=found.serve_forever, kwargs={"poll_interval": 0.05})
        thread.start()
        yield found
        found.shutdown()
        thread.join()


@pytest.fixture
def page(browser, server):
    """The empty page."""
    size = {"width": 1280, "height": 800, "deviceScaleFactor": 1, "mobile": False}
    browser.command("Emulation.setDeviceMetricsOverride", **size)
    browser.driver.get("about:blank")
    browser.driver.get(server.address)
    browser.until("document.body.classList.contains('waiting')")
    return browser


def opened(page, path):
    """The page after a file was chosen, and all its ways were followed."""
    page.run("document.getElementById('file').style = ''")
    page.driver.find_element("id", "file").send_keys(str(path))
    page.until(f"{READY} && exactfold.page.ways.length > 0")
    return page


def handle_of(page, vertex):
    """The handle of a vertex, once the page has its last layout."""
    if page.run("document.getElementById('edit-tools').hidden"):
        page.click("#edit")
    time.sleep(0.5)
    return page.driver.find_element("css selector", f"[data-handle='{vertex}']")


def test_a_drawing_that_is_dropped_is_read_counted_and_listed(page):
    path = example_path("fish-base")
    page.driver.execute_script(
        "const data = new DataTransfer();"
        f"data.items.add(new File([arguments[0]], {path.name!r}));"
        "document.body.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true}))",
        path.read_text("utf-8"),
    )
    page.until("window.exactfold.page && exactfold.page.ways.length > 0")
    assert "4 families of ways to fold, each of dimension 3" in page.text("#answer")
    page.until("exactfold.store.get().ways[0].motion !== null")
    assert page.run("exactfold.store.get().time") == 0.55
    assert "2 lines cut there" in page.text(".facts details[open]")
    page.until(READY)
    assert page.run("exactfold.store.get().ways.every((way) => way.motion || way.why)")
    assert page.complaints() == []


def test_the_empty_page_has_its_landmark_and_hides_its_parts(page):
    """A screen reader finds the main part; parts with nothing to show are neither seen nor read."""
    seen = "(one) => getComputedStyle(document.querySelector(one)).visibility"
    assert page.run(f"['main', '#ways', '#play'].map({seen})") == ["visible", "hidden", "hidden"]


def test_a_file_that_is_no_drawing_gets_a_sentence_and_the_page_goes_on(page, tmp_path):
    wrong = tmp_path / "wrong.svg"
    wrong.write_text("<svg", encoding="utf-8")
    page.run("document.getElementById('file').style = ''")
    page.driver.find_element("id", "file").send_keys(str(wrong))
    page.until("document.getElementById('message').className.includes('wrong')")
    assert "wrong.svg" in page.text("#message")
    opened(page, example_path("two-vertex"))
    assert page.text("#name") == example_path("two-vertex").name
    assert page.run("exactfold.page.ways.length") == 4


def test_a_vertex_is_dragged_the_answer_changes_live_and_is_undone(page):
    from selenium.webdriver.common.action_chains import ActionChains

    opened(page, example_path("two-vertex"))
    handle = handle_of(page, 4)
    before = page.run("exactfold.view.sheet.points[4]")
    ActionChains(page.driver).click_and_hold(handle).move_by_offset(30, -18).perform()
    page.until("document.getElementById('live').dataset.milliseconds !== undefined")
    assert page.text("#live").startswith("degrees of freedom: 1")
    mark, handle = page.run(
        "['[data-vertex=\"4\"] .mark', '[data-handle=\"4\"]'].map((one) =>"
        " (({left, right}) => (left + right) / 2)"
        "(document.querySelector(one).getBoundingClientRect()))"
    )
    assert abs(mark - handle) < 2  # the handle goes with its vertex
    assert "4 ways to start folding" in page.text("#answer")
    ActionChains(page.driver).release().perform()
    page.until("!document.getElementById('undo').hidden")
    page.until(f"{READY} && exactfold.page.ways.length > 0")
    after = page.run("exactfold.view.sheet.points[4]")
    assert after != before
    steps = np.array(after) * 16  # the sheet is the unit square
    assert np.allclose(steps, steps.round())
    page.driver.execute_script("delete document.getElementById('live').dataset.milliseconds")
    page.click("#undo")
    page.until(f"{READY} && exactfold.view.sheet.points[4][0] === {before[0]}")
    assert page.run("exactfold.view.sheet.points[4]") == before
    assert page.run("document.getElementById('undo').hidden")
    assert page.complaints() == []


def test_letters_stay_asked_for_as_a_vertex_moves_and_both_are_undone(page):
    opened(page, example_path("two-vertex"))
    page.click('[data-fold="4-5"] .reach')
    asked = "JSON.stringify([...exactfold.store.get().asks])"
    assert page.run(asked) == '[[6,"M"]]'
    before = page.run("exactfold.view.sheet.points[5]")
    handle_of(page, 5)
    page.run("document.querySelector(\"[data-handle='5']\").focus()")
    page.run("exactfold.view.old = true")
    page.press("\ue013")  # up
    page.until(f"{READY} && !exactfold.view.old && exactfold.page.ways.length === 4")
    assert page.run("exactfold.view.sheet.points[5][1]") > before[1]
    assert page.run(asked) == '[[6,"M"]]'
    page.click("#edit")
    page.click('[data-fold="4-5"] .reach')
    assert page.run(asked) == '[[6,"V"]]'
    page.press_with_control("z")  # first the letter
    assert page.run(asked) == '[[6,"M"]]'
    page.press_with_control("z")  # then the vertex
    page.until(f"{READY} && exactfold.view.sheet.points[5][1] === {before[1]}")
    assert page.run(asked) == '[[6,"M"]]'


def test_a_vertex_that_cannot_go_somewhere_comes_back(page):
    from selenium.webdriver.common.action_chains import ActionChains

    opened(page, example_path("two-vertex"))
    before = page.run("exactfold.view.sheet.points")
    handle = handle_of(page, 4)
    ActionChains(page.driver).click_and_hold(handle).move_by_offset(400, 0).release().perform()
    page.until("document.getElementById('message').className.includes('wrong')")
    page.until(f"JSON.stringify(exactfold.view.sheet.points) === {str(before).replace(' ', '')!r}")


def test_vertices_are_moved_by_keys_too(page):
    opened(page, example_path("two-vertex"))
    handle_of(page, 5)
    before = page.run("exactfold.view.sheet.points[5]")
    page.run("document.querySelector(\"[data-handle='5']\").focus()")
    page.press("\ue013")  # up
    page.until(f"{READY} && exactfold.view.sheet.points[5][1] > {before[1]}")


def test_the_address_holds_the_sheet(page, server):
    opened(page, example_path("two-vertex"))
    page.run("exactfold.store.set({way: 2, time: 0.375})")
    page.until("location.hash.includes('sheet=') && location.hash.includes('t=0.375')")
    address = page.run("location.href")
    points = page.run("exactfold.view.sheet.points")
    page.driver.get("about:blank")
    page.driver.get(address)
    page.until(f"{READY} && exactfold.page.ways.length === 4")
    assert page.run("exactfold.view.sheet.points") == points
    assert page.run("[exactfold.store.get().way, exactfold.store.get().time]") == [2, 0.375]


def test_other_branches_of_a_large_sheet_come_as_they_are_asked_for(browser):
    with view_server("h1-4", branches=["++++"], frames=4) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
        thread.start()
        try:
            browser.driver.get(server.address)
            browser.until(f"{READY} && exactfold.store.get().ways[0].motion !== null")
            vertex = load("h1-4").interior[1]
            browser.click(f'[data-vertex="{vertex}"] .reach')
            browser.until("exactfold.store.get().ways.length === 2")
            assert browser.shown() == ("+-++", find_branch("h1-4", "+-++").assignment_text, False)
            browser.click("#search")
            browser.press("++x", "\ue007")
            browser.until("document.getElementById('message').className.includes('wrong')")
            assert "'x' is not a vertex sign" in browser.text("#message")
            assert browser.complaints() == []
        finally:
            server.shutdown()
            thread.join()


def test_an_animation_is_saved(page, folder):
    image = pytest.importorskip("PIL.Image")
    opened(page, example_path("two-vertex"))
    assert len(count_branches("two-vertex")) == 4
    page.run(
        "(() => { const box = document.getElementById('speed'); box.value = '4';"
        " box.dispatchEvent(new Event('change')) })()"
    )
    page.click("#gif")
    for _ in range(400):
        found = list((folder / "downloads").glob("*.gif"))
        if found:
            break
        time.sleep(0.05)
    gif = image.open(found[0])
    assert gif.n_frames > 10
    seconds = gif.n_frames * gif.info["duration"] / 1000
    assert seconds == pytest.approx(1.6, rel=0.2)
