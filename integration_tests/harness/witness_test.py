"""When a failed attempt counts, is tried again, or says nothing."""
import contextlib
import io
import unittest
from unittest import mock

from integration_tests.harness import witness
from integration_tests.harness.witness import NoQuietMachine, until_held


class Stalls:
    """In place of the witness: the pauses that each attempt sees, in turn."""

    def __init__(self, *longest_s):
        self._longest_s = list(longest_s)

    def __call__(self):
        return self

    def __enter__(self):
        self.longest_s = self._longest_s.pop(0)
        return self

    def __exit__(self, *_):
        pass


class UntilHeld(unittest.TestCase):
    def judged(self, outcomes, *longest_s):
        left = list(outcomes)
        with mock.patch.object(witness, "Witness", Stalls(*longest_s)), contextlib.redirect_stderr(io.StringIO()):
            held = until_held(lambda: left.pop(0))
        self.assertEqual(left, [], "every attempt is made")
        return held

    def test_believes_success_on_any_machine(self):
        self.assertTrue(self.judged([True], 0.5))

    def test_believes_a_failure_on_a_quiet_machine_at_once(self):
        self.assertFalse(self.judged([False], 0.005))

    def test_tries_again_after_a_pause(self):
        self.assertTrue(self.judged([False, True], 0.011, 0.005))
        self.assertFalse(self.judged([False, False], 0.5, 0.005))

    def test_believes_failures_of_which_one_saw_only_a_short_pause(self):
        self.assertFalse(self.judged([False, False, False], 0.5, 0.011, 0.5))

    def test_says_nothing_where_the_machine_stood_still_in_every_attempt(self):
        with self.assertRaisesRegex(NoQuietMachine, "in each of 3 attempts it stood still for 40 ms or more"):
            self.judged([False, False, False], 0.5, 0.04, 0.3)


if __name__ == "__main__":
    unittest.main(verbosity=2)
