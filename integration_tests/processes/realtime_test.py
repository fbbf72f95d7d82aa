"""A service that is refused the priority, locked memory or processors it asks for reports that once and goes on without."""
import os
import resource
import shutil
import subprocess
import unittest

from integration_tests.harness.processes import BIN, CONFIGURATIONS, ProcessTest

NOBODY = 65534
NO_SUCH_PROCESSOR = 1023


class RealTime(ProcessTest):
    def start_without_rights(self, *settings):
        """As an ordinary user whose limits allow nothing."""
        def give_up():
            resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
            resource.setrlimit(resource.RLIMIT_MEMLOCK, (0, 0))
            if os.geteuid() == 0:
                os.setgroups([])
                os.setresgid(NOBODY, NOBODY, NOBODY)
                os.setresuid(NOBODY, NOBODY, NOBODY)

        self.run_directory.chmod(0o777)
        # Copies, since that user may not be let into the folders of the build.
        program = shutil.copy(BIN / "quorient-fdi", self.run_directory)
        system = shutil.copy(CONFIGURATIONS / "demo.yaml", self.run_directory)
        words = [program, system, "--name", "fdi-a", "--domain", str(self.domain), *(word for value in settings for word in ("--set", value))]
        process = subprocess.Popen(words, env=self.environment, preexec_fn=give_up, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.processes.append(process)
        self.eventually(lambda: (self.run_directory / "fdi-a.heartbeat").exists(), "the detector is up")
        process.terminate()
        said, _ = process.communicate(timeout=10)
        self.assertEqual(process.returncode, 0, said)
        return [line for line in said.splitlines() if "refused" in line]

    def test_refusal_is_one_warning_that_names_all_and_the_service_runs(self):
        refused = self.start_without_rights("priority=50", "lock_memory=true", f"processors=[{NO_SUCH_PROCESSOR}]")
        self.assertEqual(len(refused), 1, refused)
        for what in ("warning", "real-time priority", "memory lock", "processor affinity"):
            self.assertIn(what, refused[0])

    def test_who_asks_for_nothing_is_refused_nothing(self):
        self.assertEqual(self.start_without_rights(), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
