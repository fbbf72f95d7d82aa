"""The monitor's page in a real browser, while a gyro fails and a lane is killed."""
import os
import pathlib
import subprocess
import sys
import unittest

from integration_tests.harness import browser
from integration_tests.harness.monitored import MonitoredSystem
from integration_tests.harness.processes import words_of

PICTURES = pathlib.Path(os.environ["QUORIENT_PICTURES"]) if "QUORIENT_PICTURES" in os.environ else None
LIGHTEST_CONTRAST = 4.5

# Every visible text with its colour and the colour behind it, and every control without a name.
LOOK = """(() => {
  const channels = (text) => text.match(/[\\d.]+/g).map(Number);
  const luminance = (rgb) => rgb.slice(0, 3).map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const colour = channels(getComputedStyle(at).backgroundColor);
      if (colour.length < 4 || colour[3] === 1) return colour;
    }
    return [255, 255, 255];
  };
  const pale = [];
  let least = 99;
  for (const element of document.querySelectorAll("body *")) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (!own || element.closest("svg, noscript, option") || !element.getClientRects().length) continue;
    const [a, b] = [luminance(channels(getComputedStyle(element).color)), luminance(behind(element))];
    const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    least = Math.min(least, contrast);
    if (contrast < %f) pale.push(`${element.tagName}.${element.className} "${element.textContent.slice(0, 20)}" ${contrast.toFixed(2)}`);
  }
  const nameless = [...document.querySelectorAll("button, select, input")]
    .filter((control) => control.getClientRects().length && !control.textContent.trim() && !control.ariaLabel && !(control.labels && control.labels.length)).map((control) => control.id);
  return { pale, least, nameless, wide: document.documentElement.scrollWidth - innerWidth };
})()""" % LIGHTEST_CONTRAST


@unittest.skipUnless(browser.PROGRAM, "neither chromium-headless-shell nor chromium is installed")
class Page(MonitoredSystem):
    def open(self, **size):
        page = self.enterContext(browser.Browser(**{"width": 1280, "height": 1000} | size))
        page.open(f"http://127.0.0.1:{self.port}/")
        self.eventually(lambda: page.evaluate("document.getElementById('link')?.textContent") == "live", "the page is live")
        return page

    def tiles(self, page):
        return page.evaluate("Object.fromEntries([...document.querySelectorAll('.tile')].map((tile) => [tile.querySelector('b').textContent, tile.dataset.state]))")

    def keep_picture(self, page, name):
        if PICTURES:
            PICTURES.mkdir(parents=True, exist_ok=True)
            page.picture(PICTURES / f"{name}.png")

    def check_looks(self, page, name):
        looks = page.evaluate(LOOK)
        self.assertEqual((looks["pale"], looks["nameless"]), ([], []), name)
        self.assertLessEqual(looks["wide"], 0, f"{name}: the page is wider than its window")
        print(f"{name}: least contrast {looks['least']:.2f}", file=sys.stderr)
        self.keep_picture(page, name)

    def test_a_failed_gyro_and_a_killed_lane_are_seen_on_the_page(self):
        self.start_system()
        page = self.open()
        self.assertEqual(set(self.tiles(page).values()), {"healthy"})
        self.assertEqual(page.evaluate("document.getElementById('level').textContent"), "FULL")
        self.assertTrue(page.evaluate("document.getElementById('orders').hidden"))
        self.inject("axis=1,kind=bias,value=0.05,start=0")
        self.eventually(lambda: self.tiles(page)["G2"] == "isolated", "G2's tile turns to isolated", timeout=2)
        self.assertEqual(self.tiles(page), {"G1": "healthy", "G2": "isolated", "G3": "healthy", "G4": "healthy"})
        self.eventually(lambda: page.evaluate("!!document.querySelector('#events [data-code=ISOLATED]')"), "the event is listed", timeout=2)
        victim = next(pid for pid in self.children() if "attitude-a" in words_of(pid))
        subprocess.run(["kill", "-STOP", str(victim)], check=True)
        standing = "document.querySelector('#lanes tbody tr').cells[1].textContent"
        self.eventually(lambda: page.evaluate(standing) == "silent", "lane a is shown as silent", timeout=5)
        self.eventually(lambda: page.evaluate("document.getElementById('level').textContent") != "FULL", "the level changes", timeout=2)
        subprocess.run(["kill", "-CONT", str(victim)], check=True)
        self.check_looks(page, "desktop")
        page.press("d")
        self.check_looks(page, "dark")
        page.press("p")
        self.assertEqual(page.evaluate("document.getElementById('pause').textContent"), "Resume")
        page.press("p")
        page.resize(390, 844)
        self.check_looks(page, "phone")
        self.assertEqual(page.problems, [])

    def first_paint_ms(self, page):
        page.open(f"http://127.0.0.1:{self.port}/")
        paint = lambda: page.evaluate("performance.getEntriesByName('first-contentful-paint')[0]?.startTime")  # noqa: E731
        self.eventually(paint, "something is drawn")
        return paint()

    def test_the_page_is_light_and_drawn_soon_and_connects_again(self):
        self.start_system()
        page = self.open()
        sizes = page.evaluate("performance.getEntriesByType('resource').concat(performance.getEntriesByType('navigation')).filter((e) => !/stream|history/.test(e.name)).map((e) => e.transferSize)")
        first_paint_ms = min(self.first_paint_ms(page) for _ in range(3))  # others may be using the processors
        print(f"weight {sum(sizes)} bytes in {len(sizes)} files, first paint after {first_paint_ms:.0f} ms", file=sys.stderr)
        self.assertGreater(len(sizes), 5)
        self.assertLess(sum(sizes), 300_000)
        self.assertLess(first_paint_ms, 1000)
        self.eventually(lambda: page.evaluate("document.getElementById('link')?.textContent") == "live", "the page is live")
        killed = self.monitor()
        subprocess.run(["kill", "-9", str(killed)], check=True)
        self.eventually(lambda: self.monitor() not in (None, killed) and (self.get("/state") or {}).get("attitude"), "another monitor serves")
        newest = self.get("/state")["attitude"]["sequence"]
        shown = lambda: int(page.evaluate("document.querySelector('#attitude-figures dd:last-child').textContent"))  # noqa: E731
        self.eventually(lambda: shown() > newest, "the page shows frames from the other monitor")


if __name__ == "__main__":
    unittest.main(verbosity=2)
