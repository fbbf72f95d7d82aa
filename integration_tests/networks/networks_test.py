"""Three cells on hosts that are network namespaces; all of them: run_cell.py --all."""
import unittest

from integration_tests.networks.run_cell import BY_NAME, attempt
from integration_tests.networks.hosts import not_permitted
from integration_tests.harness.pipeline import ask_for_priority

RATE_HZ = 50  # at the 200 Hz of run_cell.py a slow machine that simulates four hosts is busy without a pause
REASON = not_permitted()


@unittest.skipIf(REASON, f"networks cannot be made here: {REASON}")
class Networks(unittest.TestCase):
    def holds(self, name):
        outcome, _ = attempt(BY_NAME[name], RATE_HZ)
        self.assertFalse(outcome.broken, "\n".join(f"--- {process}\n{log}" for process, log in outcome.logs.items()))

    def test_a_lane_cut_off_while_a_fault_begins_comes_back(self):
        self.holds("link-b/2s/isolating")

    def test_either_network_carries_the_system(self):
        self.holds("networks/A-cut/2s")

    def test_a_lossy_link_loses_nothing(self):
        self.holds("loss-20%/b")


if __name__ == "__main__":
    ask_for_priority()
    unittest.main(verbosity=2)
