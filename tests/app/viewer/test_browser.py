"""The page in a real browser: it opens, folds, is clicked, typed at, and saves a file."""

import json
import time
from itertools import pairwise

import numpy as np
import pytest
from test_document import CORNER_AND_CENTRE

from exactfold.app.pictures.crease_style import COLOUR
from exactfold.app.viewer import write_view
from exactfold.branches import count_branches
from exactfold.motion import follow
from exactfold.pattern import load, open_pattern

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def pages(folder, browser):
    """Addresses of the pages of three sheets, written once there is a browser."""
    for name in ("h1-4", "zigzags", "waterbomb"):
        write_view(name, folder / f"{name}.html", name=name)
    write_view(CORNER_AND_CENTRE, folder / "free-corner.html", frames=4)
    return {path.stem: path.as_uri() for path in folder.glob("*.html")}


def test_it_opens_without_a_complaint_and_asks_nothing_of_a_network(browser, pages):
    for name, address in pages.items():
        browser.open(address)
        assert browser.complaints() == [], name
        asked = browser.run("performance.getEntriesByType('resource').map((e) => e.name)")
        assert [one for one in asked if not one.startswith("data:")] == []
    browser.open(pages["waterbomb"])
    assert browser.run("document.title") == "waterbomb - exactfold"
    assert "1 family of ways to fold, of dimension 3" in browser.text("#answer")


def test_sliders_choose_another_way_of_a_family_and_play_goes_on(browser, pages):
    browser.open(pages["waterbomb"])
    sheet = load("waterbomb")
    i, j = np.array(sheet.edges).T
    at = [browser.run(f"exactfold.store.get().ways[0].family.drivers[{k}]") for k in range(3)]
    names = browser.run(
        "Array.from(document.querySelectorAll('#family label span'), (n) => n.textContent)"
    )
    assert names == ["Fold {}–{}".format(*sheet.folds[k]) for k in at]
    before = browser.run("exactfold.angles()")
    wish = round(before[at[0]]) + 25
    browser.run(
        "(() => { const slider = document.querySelector('#family input');"
        f" slider.value = {wish}; slider.dispatchEvent(new Event('input')) }})()"
    )
    after = browser.run("exactfold.angles()")
    assert after[at[0]] == pytest.approx(wish, abs=1e-3)
    assert [after[k] for k in at[1:]] == pytest.approx([before[k] for k in at[1:]], abs=1e-3)
    shape = np.array(browser.run("exactfold.positions()")).reshape(-1, 3)
    flat = np.array([[float(x), float(y)] for x, y in sheet.vertices])
    lengths = [np.linalg.norm(c[i] - c[j], axis=1) for c in (shape, flat)]
    assert np.allclose(*lengths, atol=1e-6)
    browser.click("#play")
    browser.until("exactfold.store.get().time !== 0.55")
    assert browser.complaints() == []


def test_an_empty_list_is_no_listbox(browser, pages):
    role = "document.getElementById('ways').getAttribute('role')"
    browser.open(pages["h1-4"])
    assert browser.run(role) == "listbox"
    browser.click("#search")
    browser.press("#99")
    assert browser.text("#ways").startswith("No branch of this sheet agrees with the search")
    assert browser.run(role) == "group"
    browser.click("#clear")
    assert browser.run(role) == "listbox"


def test_without_a_motion_there_is_nothing_to_play(browser, pages):
    browser.open(pages["zigzags"])
    browser.click(".way:last-child")
    assert browser.run("document.getElementById('transport').hidden")
    browser.click(".way:first-child")
    assert not browser.run("document.getElementById('transport').hidden")


def test_the_slider_folds_the_sheet(browser, pages):
    browser.open(pages["h1-4"])
    spans = []
    for value in (0, 500, 1000):
        browser.slide(value)
        z = np.array(browser.run("exactfold.positions()")).reshape(-1, 3)
        spans.append(float(np.ptp(z[:, 2])))
    assert spans[0] == 0
    assert spans[1] > 0.05
    assert spans[2] > 0.05
    assert spans[2] != spans[1]
    before = _pixels(browser)
    browser.run("exactfold.store.set({time: 0.2})")
    assert _pixels(browser) != before


def test_vertices_to_look_at_have_a_ring_and_say_why(browser, pages):
    browser.open(pages["zigzags"])
    ring = "[data-vertex='9'] .ring.refuted"
    assert browser.run('document.querySelectorAll("#pattern .ring").length') == 4
    assert browser.run(f'document.querySelector("{ring}") !== null')
    label = browser.run("document.querySelector(\"[data-vertex='9']\").getAttribute('aria-label')")
    assert "It cannot start to fold with the letters of the file: its mountains 9-13, 4-9" in label
    assert "vertex that cannot start to fold" in browser.text("#legend")
    browser.open(pages["h1-4"])
    assert browser.run('document.querySelectorAll("#pattern .ring").length') == 0


def _pixels(browser):
    """A picture of the page, once what was asked for is drawn."""
    browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return browser.command("Page.captureScreenshot")["data"]


def test_play_moves_and_pause_stops(browser, pages):
    browser.open(pages["h1-4"])
    before = browser.run("exactfold.store.get().time")
    browser.click("#play")
    browser.until(f"Math.abs(exactfold.store.get().time - {before}) > 0.02")
    assert browser.run("document.getElementById('play').getAttribute('aria-label')") == "Pause"
    browser.click("#play")
    stopped = browser.run("exactfold.store.get().time")
    time.sleep(0.3)
    assert browser.run("exactfold.store.get().time") == stopped


def test_a_click_on_a_vertex_pops_it_through(browser, pages):
    browser.open(pages["h1-4"])
    count = count_branches("h1-4")
    signs, letters, _ = browser.shown()
    vertex = count.pattern.interior[2]
    browser.click(f'[data-vertex="{vertex}"] .reach')
    flipped = signs[:2] + ("+" if signs[2] == "-" else "-") + signs[3:]
    assert browser.shown() == (flipped, count[flipped].assignment_text, False)
    browser.click(f'[data-vertex="{vertex}"] .reach')
    assert browser.shown() == (signs, letters, False)
    assert f"Vertex {vertex} popped through" in browser.text("#message")


def test_clicks_on_folds_ask_for_letters_and_the_list_shrinks(browser, pages):
    browser.open(pages["h1-4"])
    count = count_branches("h1-4")
    folds = count.pattern.folds
    i, j = folds[-1]
    selector = f'[data-fold="{i}-{j}"] .reach'

    total = len(count)
    for letter in "MV":  # of the two mirror images of a branch one agrees
        browser.click(selector)
        sides = sum(branch.assignment[i, j] in "MV" for branch in count)
        assert browser.text("#count") == f"{sides} of {total} branches {_agree(sides)}"
        _, letters, mirrored = browser.shown()
        shown = letters.translate(str.maketrans("MV", "VM")) if mirrored else letters
        assert shown[-1] == letter
    k, m = folds[0]
    browser.click(f'[data-fold="{k}-{m}"] .reach')  # M there, V at the last
    both = sum(
        (branch.assignment[k, m], branch.assignment[i, j]) in (("M", "V"), ("V", "M"))
        for branch in count
    )
    assert 0 < both < total
    assert browser.text("#count") == f"{both} of {total} branches {_agree(both)}"
    assert browser.run("document.querySelectorAll('.way').length") == both
    browser.click(f'[data-fold="{k}-{m}"] .reach')
    browser.click(f'[data-fold="{k}-{m}"] .reach')
    browser.click(selector)  # any
    assert browser.text("#count") == f"{total} branches"


def _agree(number):
    return "agrees" if number == 1 else "agree"


def test_what_was_asked_is_undone_step_by_step(browser, pages):
    browser.open(pages["h1-4"])
    (i, j), (k, m) = (load("h1-4").folds[at] for at in (-1, 0))
    hidden = "document.getElementById('undo').hidden"
    asked = "[...exactfold.store.get().asks.values()].join('')"
    assert browser.run(hidden)
    way = browser.run("exactfold.store.get().way")
    for edge in (f"{i}-{j}", f"{i}-{j}", f"{k}-{m}"):
        browser.click(f'[data-fold="{edge}"] .reach')
    assert browser.run(asked) == "VM"
    browser.click("#undo")
    assert browser.run(asked) == "V"
    browser.press_with_control("z")
    assert browser.run(asked) == "M"
    browser.click("#undo")
    assert (browser.run(asked), browser.run(hidden)) == ("", True)
    assert browser.run("exactfold.store.get().way") == way
    assert browser.run("document.activeElement.closest('#pattern') !== null")
    browser.click(f'[data-fold="{i}-{j}"] .reach')
    browser.click("#search")
    browser.press("#1")
    browser.click("#clear")
    assert browser.run("document.getElementById('search').value") == ""
    browser.click("#undo")  # what "Clear" took away comes back
    assert browser.run("document.getElementById('search').value") == "#1"
    assert browser.run(asked) == "M"


def test_the_hint_says_what_a_click_does(browser, pages):
    browser.open(pages["h1-4"])
    count = count_branches("h1-4")
    signs, letters, _ = browser.shown()
    vertex, (i, j) = count.pattern.interior[1], count.pattern.folds[-1]
    browser.run(f"document.querySelector('[data-vertex=\"{vertex}\"]').focus()")
    way, back = ("down", "up") if signs[1] == "-" else ("up", "down")
    browser.says("#pattern-hint", f"Vertex {vertex}: popped {way}. Click: pop it {back}.")
    browser.run(f"document.querySelector('[data-fold=\"{i}-{j}\"]').focus()")
    name = {"M": "mountain", "V": "valley"}[letters[-1]]
    browser.says("#pattern-hint", f"Fold {i}–{j}: {name}. Click: ask for a mountain.")
    browser.run("document.activeElement.blur()")
    browser.says("#pattern-hint", "Click a vertex or a fold")


def test_lines_have_the_colours_of_pictures(browser, pages):
    browser.open(pages["h1-4"])
    shown = browser.run(
        "Array.from(document.querySelectorAll('.fold .line'), (n) => getComputedStyle(n).stroke)"
    )
    _, letters, _ = browser.shown()
    colours = [tuple(int(COLOUR[letter][k : k + 2], 16) for k in (1, 3, 5)) for letter in letters]
    assert shown == [f"rgb{colour}" for colour in colours]


def test_everything_is_reached_by_keys(browser, pages):
    from selenium.webdriver.common.keys import Keys

    browser.open(pages["h1-4"])
    reached = []
    while "download" not in reached:
        assert len(reached) < 20
        browser.press(Keys.TAB)
        reached.append(
            browser.run(
                "(document.activeElement.id || Object.keys(document.activeElement.dataset)[0])"
            )
        )
        ring = browser.run(
            "(() => { const a = document.activeElement;"
            " const n = a.querySelector?.('.reach') ?? a; const s = getComputedStyle(n);"
            " return a === document.body || s.outlineStyle !== 'none' || +s.strokeOpacity < 1"
            " || +s.fillOpacity < 1 })()"
        )
        assert ring, reached
    wanted = ["fold", "vertex", "mirror", "home", "canvas", "play", "time", "search", "ways"]
    assert [name for name in reached if name in wanted] == wanted

    browser.open(pages["h1-4"])
    signs, _, _ = browser.shown()
    browser.press(Keys.TAB, Keys.TAB, Keys.ARROW_RIGHT, Keys.ENTER)  # the second vertex
    assert browser.shown()[0] == signs[0] + ("+" if signs[1] == "-" else "-") + signs[2:]
    browser.run("document.activeElement.blur()")
    browser.press(Keys.ARROW_DOWN)
    assert browser.run("exactfold.store.get().way") == 1 + count_branches("h1-4").branches.index(
        count_branches("h1-4")[signs[0] + ("+" if signs[1] == "-" else "-") + signs[2:]]
    )
    before = browser.run("exactfold.store.get().time")
    browser.press(Keys.ARROW_LEFT)
    assert browser.run("exactfold.store.get().time") < before
    browser.press(Keys.SPACE)
    assert browser.run("exactfold.store.get().playing")
    browser.press(Keys.SPACE, "m")
    assert browser.run("[exactfold.store.get().playing, exactfold.store.get().mirrored]") == [
        False,
        True,
    ]


def test_the_list_is_searched_by_signs_and_letters(browser, pages):
    browser.open(pages["h1-4"])
    count = count_branches("h1-4")
    browser.click("#search")
    browser.press("+-?+")
    wanted = sorted({branch.sign_text for branch in count if _fits(branch.sign_text, "+-?+")})
    mirrored = {branch.sign_text for branch in count if _fits(_turned(branch.sign_text), "+-?+")}
    rows = browser.run("document.querySelectorAll('.way').length")
    assert rows == len(set(wanted) | mirrored)
    browser.press("??")  # more signs than vertices
    assert browser.text("#ways") == (
        'No branch of this sheet agrees with the search. "Clear" shows all again.'
    )
    browser.click("#clear")
    assert browser.text("#count") == f"{len(count)} branches"


def _fits(text, wanted):
    return all(w in ("?", c) for c, w in zip(text, wanted, strict=True))


def _turned(signs):
    return signs.translate(str.maketrans("+-", "-+"))


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_branch_is_saved_as_fold(browser, pages, folder, mirrored):
    browser.open(pages["h1-4"])
    for kept in (folder / "downloads").iterdir():
        kept.unlink()
    browser.run(f"exactfold.store.set({{way: 5, mirrored: {str(mirrored).lower()}}})")
    branch = count_branches("h1-4").branches[5]
    browser.click("#download")
    signs = _turned(branch.sign_text) if mirrored else branch.sign_text
    path = folder / "downloads" / f"h1-4_branch_{signs}.fold"
    for _ in range(200):
        if path.exists():
            break
        time.sleep(0.05)
    document = json.loads(path.read_text("utf-8"))
    assert load(path).sha256 == branch.pattern.sha256  # the exact sheet
    assert open_pattern(path).assignment == dict(
        follow(branch, side=-1 if mirrored else 1).assignment
    ) | {edge: "B" for edge in branch.pattern.edges if edge not in branch.pattern.folds}
    motion = follow(branch, side=-1 if mirrored else 1, frames=32)
    frames = document["file_frames"]
    assert len(frames) == 32
    at = [branch.pattern.edges.index(fold) for fold in branch.pattern.folds]
    for frame, time_, angles, coords in zip(
        frames, motion.times, motion.angles, motion.coords, strict=True
    ):
        assert frame["frame_exactfold:time"] == pytest.approx(time_, abs=1e-9)
        found = np.array(frame["edges_foldAngle"])[at]
        assert np.abs(found - np.degrees(angles)).max() < 1e-3
        i, j = np.array(branch.pattern.edges).T
        shape = np.array(frame["vertices_coords"])
        lengths = [np.linalg.norm(c[i] - c[j], axis=1) for c in (shape, coords)]
        assert np.allclose(*lengths, atol=1e-6)


def test_dark_and_light_are_those_of_the_reader(browser, pages):
    grounds = {}
    for dark in (False, True):
        browser.open(pages["h1-4"], dark=dark)
        found = browser.run("getComputedStyle(document.body).backgroundColor")
        grounds[dark] = sum(int(part) for part in found[4:-1].split(","))
    assert grounds[True] < 150 < 600 < grounds[False]


def test_panes_stack_on_a_phone(browser, pages):
    browser.open(pages["h1-4"], width=360, height=740)
    assert browser.run("document.documentElement.scrollWidth") <= 360
    boxes = browser.run(
        "Array.from(document.querySelectorAll('main > .pane, .side > .pane'), (node) => {"
        " const b = node.getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom] })"
    )
    assert len(boxes) == 4
    boxes.sort(key=lambda box: box[1])
    assert boxes[0][1] == browser.run("document.querySelector('.sheet').getBoundingClientRect().y")
    for (_, _, right, bottom), (left, top, _, _) in pairwise(boxes):
        assert left < 20
        assert right > 340
        assert top >= bottom
    small = browser.run(
        "Array.from(document.querySelectorAll('#play, #mirror, #home, #download'),"
        " (node) => node.getBoundingClientRect().height)"
    )
    assert min(small) >= 32


def test_on_a_phone_the_sheet_stays_in_sight_while_folds_are_clicked(browser, pages):
    browser.open(pages["h1-4"], width=390, height=844)
    (i, j) = load("h1-4").folds[0]
    browser.click(f'[data-fold="{i}-{j}"] .reach')
    assert browser.run("exactfold.store.get().asks.size") == 1
    box = "document.getElementById('stage').getBoundingClientRect()"
    top, bottom = browser.run(f"[{box}.top, {box}.bottom]")
    assert 0 <= top < bottom - 150
    pattern = "document.getElementById('pattern').getBoundingClientRect()"
    assert browser.run(f"{pattern}.top") > bottom
    assert browser.run(f"{pattern}.bottom") <= 844


def test_panels_are_followed_or_have_a_reason(browser, pages):
    browser.open(pages["zigzags"])
    names = browser.run(
        "Array.from(document.querySelectorAll('.way .signs'), (n) => n.textContent)"
    )
    assert names[-1] == "way 4does not fold on"
    browser.click(".way:last-child")
    assert "does not close" in browser.text("#empty")
    assert browser.run("document.getElementById('transport').hidden")
    browser.click(".way:first-child")
    assert browser.run("document.getElementById('empty').hidden")
    assert not browser.run("document.getElementById('transport').hidden")
    assert browser.complaints() == []


def test_two_ways_fold_side_by_side_and_faster(browser, pages):
    browser.open(pages["h1-4"])
    browser.click("#beside")
    assert not browser.run("document.getElementById('stage2').hidden")
    first = browser.text("#beside-name")
    browser.press("\ue015", "\ue015")  # two ways down the list
    browser.until("exactfold.store.get().way === 2")
    assert browser.text("#beside-name") == first
    assert browser.run("exactfold.store.get().beside.way") == 0
    browser.run("exactfold.store.set({time: 0.3})")
    before = _pixels(browser)
    browser.run("exactfold.store.set({time: 0.9})")
    assert _pixels(browser) != before
    browser.run(
        "(() => { const box = document.getElementById('speed'); box.value = '4';"
        " box.dispatchEvent(new Event('change')) })()"
    )
    assert browser.run("exactfold.store.get().speed") == 4
    browser.click("#beside")
    assert browser.run("document.getElementById('stage2').hidden")
    assert browser.complaints() == []


def test_the_letters_of_the_file_are_asked_for_at_once(browser, pages, folder):
    write_view("miura", folder / "miura.html", name="miura", frames=4)
    browser.open((folder / "miura.html").as_uri())
    drawn = browser.run("exactfold.page.drawn")
    assert browser.run("exactfold.store.get().way") == drawn["way"]
    browser.click(".way:last-child")
    browser.click("#as-drawn")
    assert browser.run("exactfold.store.get().way") == drawn["way"]
    assert browser.run("exactfold.store.get().asks.size") == 24
    assert browser.text("#count") == "1 of 8 ways agrees"


def test_the_picture_that_is_shown_is_saved(browser, pages, folder):
    image = pytest.importorskip("PIL.Image")
    browser.open(pages["h1-4"])
    browser.click("#png")
    [path] = _saved(folder, ".png")
    picture = image.open(path).convert("RGB")
    assert picture.size == tuple(
        browser.run("[exactfold.view.picture().width, exactfold.view.picture().height]")
    )
    colours = {colour for _, colour in picture.getcolors(1 << 20)}
    assert (255, 255, 255) in colours  # the ground of the page, not black
    assert len(colours) > 20
    assert browser.run("document.getElementById('mp4').hidden")  # it needs the server


def test_an_animation_is_saved_without_a_server(browser, pages, folder):
    image = pytest.importorskip("PIL.Image")
    browser.open(pages["h1-4"])
    shown = browser.run("exactfold.positions()")
    browser.click("#gif")
    [path] = _saved(folder, ".gif")
    gif = image.open(path)
    assert gif.n_frames == 90
    assert gif.n_frames * gif.info["duration"] / 1000 == pytest.approx(6.4, rel=0.02)
    assert gif.size == tuple(
        browser.run("[exactfold.view.picture().width, exactfold.view.picture().height]")
    )
    seen = []
    for k in (0, 45):
        gif.seek(k)
        seen.append(gif.convert("RGB").copy())
    assert (255, 255, 255) in {colour for _, colour in seen[0].getcolors(1 << 20)}
    assert image_difference(*seen) > 1000  # flat, and folded
    assert browser.run("exactfold.positions()") == shown  # the page shows what it showed


def image_difference(one, other):
    """How many pixels of two pictures differ."""
    chops = pytest.importorskip("PIL.ImageChops")
    return sum(chops.difference(one, other).convert("L").histogram()[40:])


def _saved(folder, ending):
    """The files with an ending that were downloaded."""
    for _ in range(200):
        found = list((folder / "downloads").glob(f"*{ending}"))
        if found:
            return found
        time.sleep(0.05)
    return []


def test_the_address_holds_the_state(browser, pages):
    browser.open(pages["h1-4"])
    browser.run("exactfold.store.set({way: 3, mirrored: true, time: 0.25})")
    browser.run("exactfold.store.set({asks: new Map([[1, 'M']])})")
    way, mirrored = browser.run("[exactfold.store.get().way, exactfold.store.get().mirrored]")
    browser.until("location.hash.includes('asks=1M')")
    address = browser.run("location.href")
    browser.driver.get("about:blank")
    browser.open(address)
    state = browser.run(
        "(({way, mirrored, time, asks}) => [way, mirrored, time, [...asks]])(exactfold.store.get())"
    )
    assert state == [way, mirrored, 0.25, [[1, "M"]]]


CONTRAST = """(() => {
  const rgb = (text) => (text.match(/[\\d.]+/g) ?? []).map(Number);
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255)
    .map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, k) => sum + c * [0.2126, 0.7152, 0.0722][k], 0);
  const ground = (node) => {
    for (let at = node; at; at = at.parentElement) {
      const found = rgb(getComputedStyle(at).backgroundColor);
      if (found.length === 3 || found[3] > 0.99) return found;
    }
    return [255, 255, 255];
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const bad = [];
  while (walker.nextNode()) {
    const node = walker.currentNode.parentElement;
    const text = walker.currentNode.data.trim();
    if (!text || node.closest("script, svg title, .message, option")) continue;
    if (!node.getClientRects().length) continue;
    const style = getComputedStyle(node);
    const ink = rgb(node.closest("svg") ? style.fill : style.color);
    const pair = [light(ink), light(ground(node))].sort((a, b) => b - a);
    const ratio = (pair[0] + 0.05) / (pair[1] + 0.05);
    if (ratio < 4.5) bad.push(`${ratio.toFixed(2)} ${node.className} ${text}`);
  }
  return bad;
})()"""


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("name", ["h1-4", "zigzags", "waterbomb"])
def test_all_text_has_enough_contrast(browser, pages, name, dark):
    browser.open(pages[name], dark=dark)
    browser.run("document.querySelectorAll('details').forEach((one) => (one.open = true))")
    assert browser.run(CONTRAST) == []
    last = "document.querySelector('.way:last-child')"
    browser.run(f"{last}.click()")
    assert browser.run(CONTRAST) == []


def test_on_a_phone_the_sheet_stays_in_sight_while_a_way_is_chosen(browser, pages):
    browser.open(pages["h1-4"], width=390, height=844)
    browser.run("document.querySelector('.way:last-child').scrollIntoView({block: 'end'})")
    browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    box = "document.getElementById('stage').getBoundingClientRect()"
    top, bottom = browser.run(f"[{box}.top, {box}.bottom]")
    assert 0 <= top < bottom <= 844
    assert bottom - top > 150
    low = browser.run("document.querySelector('.way:last-child').getBoundingClientRect().bottom")
    assert low > bottom  # the way is below the sheet, not behind it
    assert low <= browser.run("innerHeight") + 1
