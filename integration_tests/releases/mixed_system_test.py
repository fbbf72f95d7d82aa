"""Debian 12 and Debian 13 in one running system. An attempt that fails while the machine stood still is void."""
import unittest

from integration_tests.harness.pipeline import ask_for_priority
from integration_tests.harness.witness import until_held
from integration_tests.releases.mixed_system import absence, run, table


class MixedSystem(unittest.TestCase):
    def holds(self, scenario):
        reason = absence(scenario)
        if reason:
            self.skipTest(reason)
        attempts = []

        def once():
            steps, figures, broken = run(scenario)
            attempts.append("\n".join((table(steps, figures), *broken)))
            return not broken

        old = "The programs of the other release may be older than these sources: build them there again."
        self.assertTrue(until_held(once), "\n\n".join((*attempts, old)))

    def test_no_frame_is_lost_when_processes_die_beside_a_lane_of_the_other_release(self):
        self.holds("kills")

    def test_no_frame_is_lost_while_lane_by_lane_moves_to_the_other_release_and_back(self):
        self.holds("upgrade")

    def test_a_sensor_moves_to_the_other_release_and_back_and_each_time_the_attitude_is_as_stated(self):
        self.holds("sensor")


if __name__ == "__main__":
    ask_for_priority()
    unittest.main(verbosity=2)
