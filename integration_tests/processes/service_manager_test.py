"""The notify protocol of systemd, with a stand-in for systemd."""
import os
import signal
import socket
import unittest

from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest


class ServiceManager(ProcessTest):
    WATCHDOG_S = 2.0

    def setUp(self):
        super().setUp()
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.socket.close)
        path = str(self.run_directory / "notify")
        self.socket.bind(path)
        self.environment.update(NOTIFY_SOCKET=path, WATCHDOG_USEC=str(int(self.WATCHDOG_S * 1e6)))

    def receive(self, timeout_s):
        """The next datagram, or nothing."""
        self.socket.settimeout(timeout_s)
        try:
            return self.socket.recv(4096).decode()
        except TimeoutError:
            return None

    def drain(self):
        while self.receive(0.01):
            pass

    def start_sensor(self):
        return self.start(
            "quorient-sensor", CONFIGURATIONS / "demo.yaml", "--domain", self.domain,
            "--set", "source.duration_s=60", "--set", "source.faults=[]", "--set", "sensor.wait_s=0",
        )

    def test_a_service_says_ready_then_feeds_the_watchdog_then_that_it_stops(self):
        sensor = self.start_sensor()
        self.assertEqual(self.receive(10), "READY=1")
        for _ in range(5):
            self.assertEqual(self.receive(self.WATCHDOG_S), "WATCHDOG=1")
        sensor.terminate()
        received = self.receive(5)
        while received == "WATCHDOG=1":
            received = self.receive(5)
        self.assertEqual(received, "STOPPING=1")
        self.assertEqual(sensor.wait(10), 0)

    def test_a_stopped_process_starves_the_watchdog(self):
        sensor = self.start_sensor()
        self.assertEqual(self.receive(10), "READY=1")
        sensor.send_signal(signal.SIGSTOP)
        self.drain()
        self.assertIsNone(self.receive(2 * self.WATCHDOG_S))
        sensor.send_signal(signal.SIGCONT)
        self.assertEqual(self.receive(5), "WATCHDOG=1")

    def test_a_detector_that_hears_no_sensor_is_not_ready_and_feeds_nothing(self):
        detector = self.start("quorient-fdi", CONFIGURATIONS / "demo.yaml", "--name", "fdi-a", "--domain", self.domain)
        self.eventually(lambda: self.heartbeat("fdi-a").exists(), "the detector is up")
        self.assertIsNone(self.receive(3 * self.WATCHDOG_S))
        self.assertIsNone(detector.poll())

    def test_a_composition_is_ready_once_and_feeds_the_watchdog_when_all_its_services_handle_frames(self):
        self.start("quorient-run", CONFIGURATIONS / "demo.yaml", "fdi-a", "attitude-a", "--domain", self.domain)
        self.eventually(lambda: self.heartbeat("attitude-a").exists(), "the composition is up")
        self.assertIsNone(self.receive(self.WATCHDOG_S))
        managed = self.environment
        self.environment = {name: value for name, value in managed.items() if name != "NOTIFY_SOCKET"}
        self.start("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain, "--join", "--without", "fdi-a", "--without", "attitude-a",
                   "--set", "source.duration_s=60", "--set", "expect=null", "--json")
        self.environment = managed
        self.assertEqual(self.receive(20), "READY=1")
        for _ in range(3):
            self.assertEqual(self.receive(self.WATCHDOG_S), "WATCHDOG=1")

    def test_a_composition_with_the_sensor_is_not_ready_while_another_of_its_services_is_not(self):
        self.start("quorient-run", CONFIGURATIONS / "demo.yaml", "sensor", "attitude-a", "--domain", self.domain)
        self.eventually(lambda: self.heartbeat("attitude-a").exists() and self.heartbeat("sensor").exists(), "the composition is up")
        self.assertIsNone(self.receive(2 * self.WATCHDOG_S), "no detector runs, so the integrator is not ready")

    def test_a_watchdog_for_another_process_is_not_fed(self):
        self.environment["WATCHDOG_PID"] = str(os.getpid())
        self.start_sensor()
        self.assertEqual(self.receive(10), "READY=1")
        self.assertIsNone(self.receive(2 * self.WATCHDOG_S))


if __name__ == "__main__":
    unittest.main(verbosity=2)
