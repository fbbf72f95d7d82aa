"""The page of `quorient diagnose --html` on a phone of 360 px: nothing stands beyond its right edge."""
import math
import pathlib
import subprocess
import tempfile
import time
import unittest

from integration_tests.harness.browser import PROGRAM, Browser
from integration_tests.harness.processes import BIN

WIDTH = 360
BEYOND = "[...document.querySelectorAll('body *')].filter(e => e.getBoundingClientRect().right > innerWidth + 1).map(e => e.tagName)"


def log_of_a_stuck_gyro():
    """Three gyros at 100 Hz for 60 s; the last one's axes stop after 30 s."""
    names = [f"gyro{i}" for i in range(3)]
    lines = ["time_s," + ",".join(f"{name}_{axis}_rad_s" for name in names for axis in "xyz")]
    for n in range(6000):
        t = 0.01 * n
        for_last = min(t, 30.0)
        rates = [[0.5 * math.sin(0.7 * at), 0.4 * math.sin(1.1 * at), 0.3 * math.cos(0.5 * at)] for at in (t, t, for_last)]
        lines.append(f"{t:.2f}," + ",".join(f"{rate + 1e-3 * math.sin(n * (7 + i)):.6f}" for i, triad in enumerate(rates) for rate in triad))
    return "\n".join(lines) + "\n"


@unittest.skipUnless(PROGRAM, "chromium is not installed")
class DiagnosisPage(unittest.TestCase):
    def test_fits_a_phone_without_scrolling_sideways(self):
        with tempfile.TemporaryDirectory() as folder:
            log, page = pathlib.Path(folder, "flight.csv"), pathlib.Path(folder, "flight.html")
            log.write_text(log_of_a_stuck_gyro())
            subprocess.run([BIN / "quorient", "diagnose", log, "--html", page], check=True, stdout=subprocess.DEVNULL, timeout=60)
            with Browser(WIDTH, 740) as browser:
                browser.open(f"file://{page}")
                deadline = time.monotonic() + 20
                while browser.evaluate("document.readyState") != "complete" or not browser.evaluate("!!document.querySelector('pre')"):
                    self.assertLess(time.monotonic(), deadline, "the page has not been loaded")
                self.assertEqual(browser.evaluate("innerWidth"), WIDTH)
                self.assertGreater(browser.evaluate("document.querySelectorAll('svg').length"), 4)
                self.assertGreater(browser.evaluate("document.querySelectorAll('li').length"), 0)
                self.assertEqual(browser.evaluate("document.documentElement.scrollWidth"), WIDTH)
                self.assertEqual(browser.evaluate(BEYOND), [])
                self.assertEqual(browser.problems, [])
                browser.evaluate("document.querySelector('pre').style.whiteSpace = 'pre'")
                self.assertGreater(browser.evaluate("document.documentElement.scrollWidth"), WIDTH, "lines that do not wrap are noticed")


if __name__ == "__main__":
    unittest.main()
