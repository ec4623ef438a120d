"""The page in Firefox: the sheet is drawn in space, folds, is clicked and typed at."""

from io import BytesIO

import numpy as np
import pytest
from firefox import firefox

from exactfold.app.viewer import write_view

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
    nothing_is_complained_of(browser)
