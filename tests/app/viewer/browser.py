"""A headless Chromium, driven by Selenium; tests are skipped where there is none."""

from __future__ import annotations

import shutil
from contextlib import contextmanager
from pathlib import Path

import pytest

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
HARMLESS = ("GPU stall due to ReadPixels", "Automatic fallback to software WebGL")


@contextmanager
def chromium(folder: Path):
    """A browser with a profile and downloads of its own in a folder."""
    webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
    program, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if program is None or driver is None:
        pytest.skip("chromium and chromedriver (Debian: chromium-driver) are not installed")
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = program
    for flag in (*FLAGS, f"--user-data-dir={folder / 'profile'}"):
        options.add_argument(flag)
    options.add_experimental_option(
        "prefs", {"download.default_directory": str(folder / "downloads")}
    )
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    found = webdriver.Chrome(options=options, service=Service(driver))
    try:
        yield Browser(found)
    finally:
        found.quit()


class Browser:
    """The few things the tests do with a browser."""

    def __init__(self, driver):
        self.driver = driver

    def open(self, address, *, width=1280, height=800, dark=False, calm=True):
        """Open a page, at a size and with preferences."""
        self.command(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=width < 500,
        )
        self.command("Emulation.setFocusEmulationEnabled", enabled=True)  # as a window in front
        features = {
            "prefers-color-scheme": "dark" if dark else "light",
            "prefers-reduced-motion": "reduce" if calm else "no-preference",
        }
        self.command(
            "Emulation.setEmulatedMedia",
            features=[{"name": name, "value": value} for name, value in features.items()],
        )
        self.driver.get_log("browser")  # of the page before
        self.driver.get(address)
        self.until("window.exactfold && exactfold.drawn() > 0")

    def command(self, name, **arguments):
        return self.driver.execute_cdp_cmd(name, arguments)

    def run(self, expression):
        """The value of an expression in the page."""
        return self.driver.execute_script(f"return {expression}")

    def until(self, expression, seconds=60):
        """Wait until an expression is true in the page."""
        from selenium.webdriver.support.ui import WebDriverWait

        WebDriverWait(self.driver, seconds, 0.05).until(lambda _: self.run(expression))

    def shown(self):
        """Signs and letters of what is shown, from the page's state."""
        return tuple(
            self.run(
                "(({ways, way, mirrored}) => [ways[way].signs, ways[way].letters, mirrored])"
                "(exactfold.store.get())"
            )
        )

    def press(self, *keys):
        """Keys, to whatever has the focus."""
        from selenium.webdriver.common.action_chains import ActionChains

        chain = ActionChains(self.driver)
        for key in keys:
            chain.send_keys(key)
        chain.perform()

    def press_with_control(self, key):
        """A key while Ctrl is held."""
        from selenium.webdriver.common.action_chains import ActionChains

        chain = ActionChains(self.driver).key_down("\ue009")
        chain.send_keys(key).key_up("\ue009").perform()

    def click(self, selector):
        """A click of the mouse on the middle of an element, also if it is drawn anew meanwhile."""
        from selenium.common.exceptions import StaleElementReferenceException
        from selenium.webdriver.common.action_chains import ActionChains
        from selenium.webdriver.common.by import By

        def move():
            node = self.driver.find_element(By.CSS_SELECTOR, selector)
            ActionChains(self.driver).move_to_element(node).perform()

        try:
            move()
        except StaleElementReferenceException:
            move()
        ActionChains(self.driver).click().perform()

    def slide(self, value):
        """The slider, from 0 to 1000, as if it were moved."""
        self.run(
            "(() => { const slider = document.getElementById('time');"
            f" slider.value = {value}; slider.dispatchEvent(new Event('input')) }})()"
        )

    def says(self, selector, text):
        """Wait until an element has this text."""
        self.until(f"document.querySelector({selector!r}).textContent === {text!r}", 20)

    def text(self, selector):
        return self.run(f"document.querySelector({selector!r}).textContent")

    def complaints(self):
        """What the console says, but for remarks of the software renderer."""
        lines = [entry["message"] for entry in self.driver.get_log("browser")]
        return [line for line in lines if not any(known in line for known in HARMLESS)]
