"""A service that is refused the priority, locked memory or processors it asks for reports that once and goes on without; spinning."""
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
        self.eventually(lambda: self.heartbeat("fdi-a").exists(), "the detector is up")
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


class Spinning(ProcessTest):
    """`spin` of the sensor: its thread does not wait for messages. Judged by what the kernel counts, whatever else the machine does."""

    CPU_S = 0.5
    WAITS = 20

    def waits_and_cpu_s(self, process):
        """Times that the main thread gave up the processor of its own accord, and the time it used."""
        thread = f"/proc/{process.pid}/task/{process.pid}"
        with open(f"{thread}/status") as status:
            waits = next(int(line.split()[1]) for line in status if line.startswith("voluntary_ctxt_switches"))
        with open(f"{thread}/stat") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return waits, (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def outcome(self, spin):
        """Which comes first in a sensor that waits for its consumers: some processor time, or some waiting."""
        process = self.start("quorient-sensor", CONFIGURATIONS / "demo.yaml", "--domain", self.domain,
                             "--set", "sensor.wait_s=600", "--set", f"sensor.spin={spin}")
        self.eventually(lambda: self.heartbeat("sensor").exists(), "the sensor is up")
        waits, cpu_s = self.waits_and_cpu_s(process)
        reached = {}

        def decided():
            new_waits, new_cpu_s = self.waits_and_cpu_s(process)
            reached.update(waits=new_waits - waits >= self.WAITS, cpu=new_cpu_s - cpu_s >= self.CPU_S)
            return any(reached.values())

        self.eventually(decided, "the sensor works or waits")
        process.terminate()
        process.communicate(timeout=10)
        return reached

    def test_sensor_that_is_told_to_spin_does_not_wait(self):
        self.assertEqual(self.outcome("true"), {"waits": False, "cpu": True})

    def test_sensor_that_is_not_told_to_spin_waits(self):
        self.assertEqual(self.outcome("false"), {"waits": True, "cpu": False})


if __name__ == "__main__":
    unittest.main(verbosity=2)
