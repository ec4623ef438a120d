"""Firefox on a display in memory: without any display it does not draw in space."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from browser import Browser


@contextmanager
def firefox(folder: Path):
    """A browser under Xvfb with WebGL drawn by the processor; its log is in a folder."""
    webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
    path = f"{os.environ.get('PATH', '')}{os.pathsep}{Path(sys.executable).parent}"
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    driver, display = shutil.which("geckodriver", path=path), shutil.which("Xvfb")
    for name, found in (("firefox", program), ("geckodriver", driver), ("Xvfb", display)):
        if found is None:
            pytest.skip(f"{name} is not installed")
    from selenium.webdriver.firefox.service import Service

    options = webdriver.FirefoxOptions()
    options.binary_location = program
    options.set_preference("webgl.force-enabled", True)
    options.set_preference("devtools.console.stdout.content", True)
    log = folder / "firefox.log"
    with virtual_display(display) as number:
        service = Service(
            driver,
            log_output=str(log),
            env={**os.environ, "DISPLAY": f":{number}", "LIBGL_ALWAYS_SOFTWARE": "1"},
        )
        found = webdriver.Firefox(options=options, service=service)
        try:
            found.set_window_size(1280, 900)
            yield Firefox(found, log)
        finally:
            found.quit()


@contextmanager
def virtual_display(program: str):
    """The number of a display that is drawn in memory."""
    reading, writing = os.pipe()
    screen = ["-screen", "0", "1400x1000x24", "+extension", "GLX"]
    server = subprocess.Popen(
        [program, "-displayfd", str(writing), *screen],
        pass_fds=[writing],
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    try:
        with os.fdopen(reading) as told:
            number = told.readline()
        if not number:
            pytest.skip("Xvfb does not start: it needs xkbcomp (Debian: x11-xkb-utils)")
        yield int(number)
    finally:
        server.terminate()
        server.wait()


class Firefox(Browser):
    """The same few things, where Firefox has another way to do them."""

    def __init__(self, driver, log):
        super().__init__(driver)
        self.log = log

    def open(self, address):
        """Open a page in the window as it is."""
        self.driver.get(address)
        self.until("window.exactfold && exactfold.drawn() > 0")

    def complaints(self):
        """Errors of pages; the browser's own are no matter of the page."""
        lines = self.log.read_text("utf-8", errors="replace").splitlines()
        ours = [line for line in lines if ".html" in line or "127.0.0.1" in line]
        return [line for line in ours if "error" in line.lower()]
