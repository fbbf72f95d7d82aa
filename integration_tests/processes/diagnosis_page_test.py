"""The page of `quorient diagnose --html` on a phone of 360 px: nothing is cut off, and everything can be read."""
import math
import pathlib
import subprocess
import tempfile
import time
import unittest

from integration_tests.harness.browser import PROGRAM, Browser
from integration_tests.harness.processes import BIN

WIDTH = 360
NAMES = ("gyro_at_the_front_left_arm", "gyro_at_the_rear", "gyro2")
LEAST_LETTER_PX = 11
BEYOND = """[...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > innerWidth + 1 || e.getBoundingClientRect().left < -1)
  .map((e) => `${e.tagName} ${e.textContent.slice(0, 40)}`)"""
# The height of the letters as they are shown: a drawing that is made smaller makes its letters smaller.
SMALL = """[...document.querySelectorAll('h1, h2, p, li, pre, figcaption, text')]
  .map((e) => [parseFloat(getComputedStyle(e).fontSize) * (e.getScreenCTM ? e.getScreenCTM().d : 1), e.textContent.slice(0, 40)]).filter(([px]) => px < %f)""" % LEAST_LETTER_PX
# Texts of one drawing that cover each other.
COVERED = """[...document.querySelectorAll('figure')].flatMap((figure) => {
  const boxes = [...figure.querySelectorAll('figcaption, text')].map((e) => [e.textContent, e.getBoundingClientRect()]);
  const meet = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 4 && b.top < a.bottom - 4;
  return boxes.flatMap(([name, box], i) => boxes.slice(i + 1).filter(([, other]) => meet(box, other)).map(([other]) => `${name} / ${other}`));
})"""
CAPTIONS = "[...document.querySelectorAll('figcaption')].map((e) => e.textContent)"


def log_of_a_stuck_gyro():
    """Three gyros at 100 Hz for 60 s; the last one's axes stop after 30 s."""
    lines = ["time_s," + ",".join(f"{name}_{axis}_rad_s" for name in NAMES for axis in "xyz")]
    for n in range(6000):
        t = 0.01 * n
        for_last = min(t, 30.0)
        rates = [[0.5 * math.sin(0.7 * at), 0.4 * math.sin(1.1 * at), 0.3 * math.cos(0.5 * at)] for at in (t, t, for_last)]
        lines.append(f"{t:.2f}," + ",".join(f"{rate + 1e-3 * math.sin(n * (7 + i)):.6f}" for i, triad in enumerate(rates) for rate in triad))
    return "\n".join(lines) + "\n"


@unittest.skipUnless(PROGRAM, "chromium is not installed")
class DiagnosisPage(unittest.TestCase):
    def open(self, width):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        log, page = folder / "flight.csv", folder / "flight.html"
        log.write_text(log_of_a_stuck_gyro())
        subprocess.run([BIN / "quorient", "diagnose", log, "--html", page], check=True, stdout=subprocess.DEVNULL, timeout=60)
        browser = self.enterContext(Browser(width, 740))
        browser.open(f"file://{page}")
        deadline = time.monotonic() + 20
        while browser.evaluate("document.readyState") != "complete" or not browser.evaluate("!!document.querySelector('pre')"):
            self.assertLess(time.monotonic(), deadline, "the page has not been loaded")
        self.assertEqual(browser.evaluate("innerWidth"), width)
        return browser

    def test_fits_a_phone_without_scrolling_sideways(self):
        browser = self.open(WIDTH)
        self.assertGreater(browser.evaluate("document.querySelectorAll('svg').length"), 4)
        self.assertGreater(browser.evaluate("document.querySelectorAll('li').length"), 0)
        self.assertEqual(browser.evaluate("document.documentElement.scrollWidth"), WIDTH)
        self.assertEqual(browser.evaluate(BEYOND), [])
        self.assertEqual(browser.problems, [])
        browser.evaluate("document.querySelector('pre').style.whiteSpace = 'pre'")
        self.assertGreater(browser.evaluate("document.documentElement.scrollWidth"), WIDTH, "lines that do not wrap are noticed")

    def test_can_be_read_on_a_phone_and_on_a_desktop_with_long_names(self):
        for width in (WIDTH, 1280):
            browser = self.open(width)
            captions = " ".join(browser.evaluate(CAPTIONS))
            for name in NAMES:
                self.assertIn(name, captions)
            self.assertEqual((browser.evaluate(SMALL), browser.evaluate(COVERED), browser.evaluate(BEYOND)), ([], [], []), f"{width} px")


if __name__ == "__main__":
    unittest.main()
