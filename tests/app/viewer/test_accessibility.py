"""axe-core (npm) finds nothing to complain of in the page; NODE_PATH says where it is."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from browser import chromium

from exactfold.app.viewer.page import write_view

pytestmark = pytest.mark.slow
FOUND = (
    "axe.run(document, {resultTypes: ['violations']}).then((found) => arguments[0]("
    "found.violations.flatMap(({id, nodes}) => nodes.map((node) => `${id}: ${node.target}`))))"
)


@pytest.mark.parametrize("name", ["two-vertex", "pinwheel-base", "waterbomb"])
def test_axe_finds_nothing_in_light_and_dark_wide_and_narrow(name, tmp_path):
    axe = Path(os.environ.get("NODE_PATH", "")) / "axe-core" / "axe.min.js"
    if not axe.is_file():
        pytest.skip("the npm package axe-core is not installed where NODE_PATH says")
    write_view(name, tmp_path / "page.html", frames=4)
    with chromium(tmp_path) as browser:
        for dark in (False, True):
            for width in (1280, 390):
                browser.open((tmp_path / "page.html").as_uri(), width=width, dark=dark)
                browser.driver.execute_script(axe.read_text("utf-8"))
                assert browser.driver.execute_async_script(FOUND) == [], (dark, width)
        browser.run("document.getElementById('answer').style.color = '#333'")
        found = browser.driver.execute_async_script(FOUND)
        assert [one for one in found if one.startswith("color-contrast")]  # on dark ground
