"""One start of each order of cold_start.py, which repeats them many times."""
import unittest

from integration_tests.harness.foreign import consumer
from integration_tests.harness.pipeline import ask_for_priority
from integration_tests.interop.cold_start import READERS, Start

LEASE_FRAMES = 10  # 50 ms at 200 Hz, all that a voter keeps on loopback


class ColdStart(Start):
    @classmethod
    def setUpClass(cls):
        for name in READERS:
            consumer(name)  # built before any frame flows

    def holds(self, order):
        for name, given in self.given(order).items():
            with self.subTest(name):
                self.assertGreater(given.samples, LEASE_FRAMES)
                self.assertLessEqual(given.repeated, LEASE_FRAMES)

    def test_a_reader_that_starts_with_the_system_is_given_no_more_than_a_lease_of_frames_twice(self):
        self.holds("together")

    def test_so_is_one_that_waits_for_the_system(self):
        self.holds("earlier")

    def test_so_is_one_that_starts_while_frames_flow(self):
        self.holds("later")


if __name__ == "__main__":
    ask_for_priority()
    unittest.main(defaultTest="ColdStart", verbosity=2)
