"""A dozen named cells of the kill matrix; the whole of it: run_cell.py --all. An attempt that fails while the machine stood still is void."""
import unittest

from integration_tests.harness.pipeline import ask_for_priority
from integration_tests.harness.witness import until_held
from integration_tests.kill_matrix.run_cell import BY_NAME, attempt


class KillMatrix(unittest.TestCase):
    def holds(self, name):
        logs = {}

        def once():
            _, broken, of_attempt, _ = attempt(BY_NAME[name], attempts_allowed=1)
            logs.update(of_attempt)
            return not broken

        self.assertTrue(until_held(once), "\n".join(f"--- {process}\n{log}" for process, log in logs.items()))


NAMED = (
    "attitude-a/kill/quiet", "attitude-a/kill/isolating", "attitude-a/stop/quiet", "attitude-b/restart/quiet",
    "fdi-a/kill/isolating", "fdi-a/restart/quiet", "fdi-a/stop/quiet",
    "voter-1/kill/quiet", "voter-1/stop/quiet", "voter-2/kill/isolating",
    "sensor/kill/quiet", "sensor/stop/quiet",
    "one-process-fdi-a+attitude-a/kill/isolating", "one-process-fdi-a+attitude-a/stop/quiet",
)
for cell in NAMED:
    setattr(KillMatrix, f"test_{cell}", lambda self, cell=cell: self.holds(cell))

if __name__ == "__main__":
    ask_for_priority()
    unittest.main(verbosity=2)
