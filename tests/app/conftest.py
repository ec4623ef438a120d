"""A Chromium for the tests that look at pages in it; without one they are skipped."""

import pytest
from browser import chromium


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder for pages, with one for the files that the browser saves."""
    found = tmp_path_factory.mktemp("pages")
    (found / "downloads").mkdir()
    return found


@pytest.fixture(scope="module")
def browser(folder):
    with chromium(folder) as found:
        yield found
