"""Orders to the monitor from another address than loopback: with the token they reach the system, without it they are refused.

The tests run in a network namespace of their own, whose loopback interface gets a second address."""
import ctypes
import os
import subprocess
import unittest

from integration_tests.harness import browser
from integration_tests.harness.monitored import MonitoredSystem
from integration_tests.harness.processes import CONFIGURATIONS

ELSEWHERE = "192.0.2.1"  # of the range for documents [RFC 5737]
CLONE_NEWNET, CLONE_NEWUSER = 0x40000000, 0x10000000
TOKEN = "0123456789abcdef0123456789ABCDEF"
CLEAR = '{"action":"clear"}'
BREAK_G2 = '{"action":"inject","fault":"axis=1,kind=bias,value=0.05,start=0"}'


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True, timeout=30)


def leave_the_network():
    """From here on this process and its children have a network of their own. @returns why that is not permitted; None where it is."""
    try:
        if ctypes.CDLL(None, use_errno=True).unshare(CLONE_NEWNET | (CLONE_NEWUSER if os.geteuid() else 0)) != 0:
            return os.strerror(ctypes.get_errno())
        ip("link", "set", "lo", "up")
    except FileNotFoundError as problem:
        return f"{problem.filename} is not installed"
    except subprocess.CalledProcessError as problem:
        return f"`{' '.join(problem.cmd)}`: {problem.stderr.strip()}"
    return None


class Orders(MonitoredSystem):
    @classmethod
    def setUpClass(cls):
        if why := leave_the_network():
            raise unittest.SkipTest(f"no network namespace: {why}")

    def token_file(self, mode=0o600):
        path = self.write("token", TOKEN + "\n")
        path.chmod(mode)
        return path

    def start_for_all(self, *arguments):
        self.start_system("--set", "monitor.address=0.0.0.0", "--set", "monitor.allow_orders=true", *arguments)
        # Only now: the services take the loopback's addresses as they are when they start, and would use this one.
        address = f"{ELSEWHERE}/32"
        ip("address", "add", address, "dev", "lo")
        self.addCleanup(ip, "address", "del", address, "dev", "lo")

    def order(self, address, order=CLEAR, authorization=None):
        headers = {"Content-Type": "application/json"} | ({"Authorization": authorization} if authorization else {})
        return self.request("POST", "/order", order, headers, address)

    def test_another_host_needs_the_token_and_this_one_does_not(self):
        self.start_for_all("--set", f"monitor.token_file={self.token_file()}")
        for wrong in (None, "Bearer", f"Bearer {TOKEN[:-1]}", f"Bearer {TOKEN[:-1]}E", f"Bearer {TOKEN}0", f"Basic {TOKEN}"):
            status, text = self.order(ELSEWHERE, BREAK_G2, wrong)
            self.assertEqual(status, 403, wrong)
            self.assertNotIn(TOKEN, text)
        self.assertEqual({axis["state"] for axis in self.get("/state")["axes"]}, {"healthy"})
        self.assertEqual(self.order("127.0.0.1")[0], 202)
        self.assertEqual(self.order(ELSEWHERE, BREAK_G2, f"Bearer {TOKEN}")[0], 202)
        self.eventually(lambda: self.get("/state")["axes"][1]["state"] == "isolated", "G2 is isolated")

    def test_without_a_token_orders_come_from_this_host_alone(self):
        self.start_for_all()
        self.assertEqual(self.order(ELSEWHERE)[0], 403)
        self.assertEqual(self.order(ELSEWHERE, authorization=f"Bearer {TOKEN}")[0], 403)
        self.assertEqual(self.order("127.0.0.1")[0], 202)

    def test_a_token_that_others_can_read_is_refused_before_anything_starts(self):
        path = self.token_file(0o644)
        token = ("--set", f"monitor.token_file={path}")
        launched = self.run_program("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, *token)
        self.assertEqual(launched.returncode, 2)
        self.assertIn(f"{path}: others may read or write it (mode 0644): chmod 600", launched.stderr)
        self.assertNotIn(TOKEN, launched.stdout + launched.stderr)
        path.chmod(0o600)
        checked = self.run_program("quorient", "check", CONFIGURATIONS / "demo.yaml", *token)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn(f"token_file: {path}", checked.stdout)
        self.assertNotIn(TOKEN, checked.stdout + checked.stderr)

    @unittest.skipUnless(browser.PROGRAM, "neither chromium-headless-shell nor chromium is installed")
    def test_the_page_asks_for_the_token_where_it_is_opened_from_elsewhere(self):
        self.start_for_all("--set", f"monitor.token_file={self.token_file()}")
        page = self.enterContext(browser.Browser(1280, 1000))
        self.open_orders(page, ELSEWHERE)
        self.assertTrue(page.evaluate(self.send_with("wrong")), "it asks for the token")
        self.answered(page, "needs the token")
        self.assertEqual(page.evaluate("document.getElementById('token').value"), "", "a refused token is forgotten")
        self.assertTrue(page.evaluate(self.send_with(TOKEN)))
        self.answered(page, "accepted")
        self.open_orders(page, "127.0.0.1")
        self.assertFalse(page.evaluate(self.send_with("")), "it asks this host for no token")
        self.answered(page, "accepted")

    def open_orders(self, page, address):
        page.open(f"http://{address}:{self.port}/")
        self.eventually(lambda: page.evaluate("document.getElementById('orders')?.hidden") is False, "the page shows the orders")

    def answered(self, page, words):
        answer = lambda: page.evaluate("document.getElementById('order-answer').textContent")  # noqa: E731
        self.eventually(lambda: words in answer(), f"the page shows the answer: {words}")

    @staticmethod
    def send_with(token):
        """Asks to clear all faults and confirms with this token. @returns whether the dialog has a field for one."""
        return f"""(() => {{
          document.getElementById("order-answer").textContent = "";
          document.getElementById("clear").click();
          const field = document.getElementById("token");
          const asked = field.getClientRects().length > 0;
          field.value = "{token}";
          document.getElementById("order-send").click();
          return asked;
        }})()"""


if __name__ == "__main__":
    unittest.main(verbosity=2)
