"""A machine that does not carry the rate: frames are left out, and no isolation is lost. A standstill is no overload: nothing is left out."""
import json
import os
import signal
import unittest

from integration_tests.harness.processes import CONFIGURATIONS, ProcessTest
from integration_tests.harness.streams import Recording

OVERLOADED = 58  # EventCode
RATE_HZ = 200
STOP_S = 0.2
END_OF_GRACE_FRAMES = 20
ONE_VENDOR = ("dds=fastdds", "lanes.b.dds=fastdds", "voters.voter-2.dds=fastdds")


def settings(*assignments):
    return [word for assignment in assignments for word in ("--set", assignment)]


class Overload(ProcessTest):
    def demo(self, *assignments):
        return self.start("quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", self.domain,
                          *settings("expect=null", "source.faults=[]", "source.duration_s=120", *assignments))

    def record(self, topic, parse):
        recording = Recording(self.command("quorient", "echo", topic, "--json", "--domain", self.domain), self.environment,
                              lambda sample, _: parse(sample))
        self.addCleanup(recording.stop)
        return recording

    def record_overloads(self):
        """@returns what the events of an overload say, so far."""
        events = self.record("event", lambda event: (event["code"], event["text"]))
        return lambda: [text for code, text in events.samples if code == OVERLOADED]

    def process_of(self, launch, name):
        with open(f"/proc/{launch.pid}/task/{launch.pid}/children") as children:
            for child in children.read().split():
                with open(f"/proc/{child}/cmdline") as command:
                    if name in command.read().split("\0"):
                        return int(child)
        return self.fail(f"no process {name}")

    def test_is_no_standstill_of_a_fifth_of_a_second(self):
        overloads = self.record_overloads()
        streams = {"verdict": self.record("verdict", lambda verdict: (verdict["detector"], verdict["sequence_number"])),
                   "attitude": self.record("attitude", lambda attitude: (attitude["lane"], attitude["sequence_number"])),
                   "voter_output": self.record("voter_output", lambda output: ("any voter", output["sequence_number"]))}
        launch = self.demo(f"source.rate_hz={RATE_HZ}")
        newest = lambda: streams["voter_output"].newest[1] if streams["voter_output"].newest else 0  # noqa: E731
        self.eventually(lambda: newest() > 3 * RATE_HZ, "three seconds of frames")
        first = newest()
        for name in ("fdi-a", "attitude-b", "voter-1", "voter-2"):
            process = self.process_of(launch, name)
            before = newest()
            os.kill(process, signal.SIGSTOP)
            try:
                self.eventually(lambda: newest() >= before + STOP_S * RATE_HZ, "the others go on")
            finally:
                os.kill(process, signal.SIGCONT)
            self.eventually(lambda: newest() >= before + 2 * RATE_HZ, "two seconds of frames")
        wanted = set(range(first, newest() - END_OF_GRACE_FRAMES))
        for topic, recording in streams.items():
            sources = {source for source, _ in recording.samples}
            self.assertEqual(len(sources), 1 if topic == "voter_output" else 3)
            for source in sources:
                given_out = {sequence for its, sequence in recording.samples if its == source}
                self.assertEqual(sorted(wanted - given_out), [], f"{topic} of {source}")
        self.assertEqual(overloads(), [])

    def test_on_one_processor_leaves_frames_out_and_loses_no_isolation(self):
        processors = os.sched_getaffinity(0)
        overloads = self.record_overloads()
        os.sched_setaffinity(0, {min(processors)})
        try:
            self.demo("source.rate_hz=1000", *ONE_VENDOR)
        finally:
            os.sched_setaffinity(0, processors)
        try:
            self.eventually(overloads, "an overload")
        except AssertionError:
            self.skipTest("one processor of this machine carries 1 kHz")
        status = json.loads(self.run_program("quorient", "status", "--json", "--domain", self.domain).stdout)
        self.assertTrue(any(service["overloaded"] for service in status["starving"]), status["starving"])
        injected = self.run_program("quorient", "inject", "axis=G2,kind=bias,value=0.05,start=0", "--domain", self.domain)
        self.assertEqual(injected.returncode, 0, injected.stdout + injected.stderr)
        self.eventually(lambda: sorted(self.isolated_by_detector().values()) == 3 * [0b10], "all lanes isolate the fault")

    def isolated_by_detector(self):
        echo = self.run_program("quorient", "echo", "verdict", "--count", 60, "--json", "--timeout", 10, "--domain", self.domain)
        return {verdict["detector"]: verdict["isolated_mask"] for verdict in map(json.loads, echo.stdout.splitlines())}


if __name__ == "__main__":
    unittest.main()
