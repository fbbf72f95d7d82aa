"""Two rogue nodes on each vendor and a twin that is admitted. All cases: `python3 -m integration_tests.security.run_rogues`."""
import unittest

from integration_tests.harness.debian import NO_SECURED_PAIRS
from integration_tests.security.rogues import CASES
from integration_tests.security.run_rogues import outcomes

SHORT = ("no certificate", "the same, its DDS patched to permit it", "twin: a second sensor of the system")


@unittest.skipIf(NO_SECURED_PAIRS, NO_SECURED_PAIRS)
class Rogues(unittest.TestCase):
    def test_neither_publish_nor_receive_what_they_may_not(self):
        cases = [case for case in CASES if case.name in SHORT]
        self.assertEqual(len(cases), len(SHORT))
        for outcome in outcomes("encrypt", cases):
            with self.subTest(rogue=outcome.case.name, vendor=outcome.vendor):
                self.assertEqual(list(outcome.broken()), [])


if __name__ == "__main__":
    unittest.main()
