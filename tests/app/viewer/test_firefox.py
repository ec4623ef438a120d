"""The page in Firefox: the sheet is drawn in space, folds, is clicked and typed at."""

import threading
from io import BytesIO

import numpy as np
import pytest
from firefox import firefox

from exactfold.app.serving import view_server
from exactfold.app.viewer import write_view
from exactfold.pattern.data import example_path

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    folder = tmp_path_factory.mktemp("firefox")
    with firefox(folder) as found:
        write_view("two-vertex", folder / "two-vertex.html", frames=8)
        found.open((folder / "two-vertex.html").as_uri())
        yield found


def sheet(browser):
    """The colours of the canvas, as they are seen."""
    image = pytest.importorskip("PIL.Image", reason="Pillow is not installed")
    from selenium.webdriver.common.by import By

    canvas = browser.driver.find_element(By.CSS_SELECTOR, "#canvas")
    with image.open(BytesIO(canvas.screenshot_as_png)) as found:
        return np.asarray(found.convert("RGB")).astype(int)


def is_drawn_in_space_and_folds(browser):
    browser.slide(0)
    flat = sheet(browser)
    browser.slide(700)
    folded = sheet(browser)
    red, _, blue = np.moveaxis(flat, -1, 0)
    assert np.mean(blue - red > 60) > 0.02  # the upper side is blue
    assert np.mean(np.abs(flat - folded).max(axis=-1) > 30) > 0.02
    z = np.array(browser.run("exactfold.positions()")).reshape(-1, 3)[:, 2]
    assert np.ptp(z) > 0.05


def clicks_and_keys_reach_it(browser):
    before = browser.shown()[0]
    browser.click('[data-vertex="4"] .reach')
    assert browser.shown()[0] != before
    browser.run("document.activeElement.blur()")
    way = browser.run("exactfold.store.get().way")
    browser.press("\ue013" if way else "\ue015")  # up or down
    assert abs(browser.run("exactfold.store.get().way") - way) == 1
    browser.press("m")
    assert browser.shown()[2]


def letters_are_asked_for_and_undone(browser):
    browser.click('[data-fold="4-5"] .reach')
    assert browser.text("#count") == "4 of 4 branches agree"
    assert browser.run("[...exactfold.store.get().asks.values()]") == ["M"]
    browser.press_with_control("z")
    assert browser.run("exactfold.store.get().asks.size") == 0


def two_ways_fold_side_by_side(browser):
    browser.click("#beside")
    assert not browser.run("document.getElementById('stage2').hidden")
    one, two = (
        browser.run(f"document.getElementById('{name}').getBoundingClientRect().width")
        for name in ("stage", "stage2")
    )
    assert abs(one - two) < 4
    browser.click("#beside")
    assert browser.run("document.getElementById('stage2').hidden")


def a_drawing_is_dropped_counted_and_its_vertex_moved(browser):
    """The page with the engine behind it."""
    ready = "window.exactfold && exactfold.view && !exactfold.view.page.busy"
    path = example_path("two-vertex")
    with view_server(frames=4) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
        thread.start()
        try:
            browser.driver.get(server.address)
            browser.until("document.body.classList.contains('waiting')")
            browser.driver.execute_script(
                "const data = new DataTransfer();"
                f"data.items.add(new File([arguments[0]], {path.name!r}));"
                "document.body.dispatchEvent("
                "new DragEvent('drop', {dataTransfer: data, bubbles: true}))",
                path.read_text("utf-8"),
            )
            browser.until(f"{ready} && exactfold.page.ways.length === 4")
            assert browser.run("exactfold.store.get().ways.every((way) => way.motion)")
            before = browser.run("exactfold.view.sheet.points[5]")
            browser.click("#edit")
            browser.run("document.querySelector(\"[data-handle='5']\").focus()")
            browser.press("\ue013")  # up
            browser.until(f"{ready} && exactfold.view.sheet.points[5][1] > {before[1]}")
            browser.until("!document.getElementById('undo').hidden")
            browser.until(f"{ready} && exactfold.page.ways.length === 4")
            browser.click("#undo")
            browser.until(f"{ready} && exactfold.view.sheet.points[5][1] === {before[1]}")
        finally:
            server.shutdown()
            thread.join()


def nothing_is_complained_of(browser):
    assert browser.complaints() == []
    browser.run("setTimeout(() => { throw new Error('heard') })")
    browser.until("true")
    for _ in range(100):
        if browser.complaints():
            break
        browser.run("new Promise((done) => setTimeout(done, 50))")
    assert "heard" in browser.complaints()[0]


def test_the_page_in_firefox(browser):
    """One test for all, as each process would start Firefox again."""
    is_drawn_in_space_and_folds(browser)
    clicks_and_keys_reach_it(browser)
    letters_are_asked_for_and_undone(browser)
    two_ways_fold_side_by_side(browser)
    a_drawing_is_dropped_counted_and_its_vertex_moved(browser)
    nothing_is_complained_of(browser)
