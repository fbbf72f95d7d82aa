"""What a foreign publisher does wrong is named in events by detectors and integrators, and ends none of them."""
import pathlib
import re
import signal
import unittest

from integration_tests.harness import exact_json
from integration_tests.harness.foreign import InteropTest, node
from integration_tests.harness.processes import CONFIGURATIONS

REJECTED_INPUT, NO_MATCH, INCOMPATIBLE_QOS, UNKNOWN_REVISION = 42, 44, 45, 54
DETECTORS = {f"fdi-{lane}" for lane in "abc"}
INTEGRATORS = {f"attitude-{lane}" for lane in "abc"}
LARGEST_RESIDENT_MB = 48
LARGEST_GROWTH_MB = 8  # in two rounds of 10 000 units after the first; 2.5 measured, and 10 MB in the first
LANES = DETECTORS | INTEGRATORS

# What wrong_publisher can do: the event's code, parts of its text, the services that must report it.
MISTAKES = {
    "axis-nan": (REJECTED_INPUT, ("axis 2", "not finite"), LANES),
    "revision": (UNKNOWN_REVISION, ("revision 9", "1 is the newest"), LANES),
    "no-description": (UNKNOWN_REVISION, ("without a description",), LANES),
    "restart": (REJECTED_INPUT, ("after 59", "new, larger epoch"), LANES),
    "axis-count": (REJECTED_INPUT, ("has 5 axes, its description 4",), LANES),
    "interval": (REJECTED_INPUT, ("frame", "interval must be 1 ns to an hour",), LANES),
    "time": (REJECTED_INPUT, ("sample time is not after",), LANES),
    "value": (REJECTED_INPUT, ("axis 2 is not finite",), LANES),
    "sequence-edge": (REJECTED_INPUT, ("after 18446744073709551615",), LANES),
    "no-axes": (REJECTED_INPUT, ("3 to 24 axes",), LANES),
    "axes-255": (REJECTED_INPUT, ("3 to 24 axes",), LANES),
    "interval-nan": (REJECTED_INPUT, ("description is refused", "interval must be 1 ns to an hour",), LANES),
    "axis-norm": (REJECTED_INPUT, ("axis 2: norm",), LANES),
    "instrument-255": (REJECTED_INPUT, ("instrument",), LANES),
    "sigma-negative": (REJECTED_INPUT, ("noise of axis 1",), LANES),
    "other-axes": (REJECTED_INPUT, ("other axes", "restart the lane"), INTEGRATORS),
}


class ForeignPublisher(InteropTest):
    def setUp(self):
        super().setUp()
        self.services = self.start_services(CONFIGURATIONS / "demo.yaml")
        _, self.events = self.start_logged("events", *self.command("quorient", "echo", "event", "--json", "--domain", self.domain))

    def publish(self, mistake):
        publisher, _ = self.start_logged(f"publisher-{mistake}", *node("wrong_publisher"), self.domain, mistake)
        return publisher

    def stop(self, publisher):
        publisher.send_signal(signal.SIGTERM)
        self.assertEqual(publisher.wait(10), 0)

    def all_events(self):
        return exact_json.objects(self.events)

    def refused(self, since=0):
        return [e for e in self.all_events()[since:] if e["code"] in (REJECTED_INPUT, UNKNOWN_REVISION) and e["source_name"] in LANES]

    def is_named(self, mistake):
        code, words, by = MISTAKES[mistake]
        since = len(self.all_events())
        publisher = self.publish(mistake)

        def sources():
            return {e["source_name"] for e in self.refused(since) if e["code"] == code and all(word in e["text"] for word in words)}

        try:
            self.eventually(lambda: by <= sources(), f"{mistake} named by {sorted(by)}", timeout=8)
        finally:
            self.stop(publisher)
        self.all_alive(self.services)

    def is_followed(self):
        """A correct publisher that starts when its predecessor has fallen silent."""
        since = len(self.all_events())
        newest = max((event["epoch"] for event in self.all_events()), default=0)
        publisher = self.publish("none")
        try:
            self.eventually(lambda: self.follows(newest, 100), "its frames are voted on")
        finally:
            self.stop(publisher)
        self.assertEqual(self.refused(since), [])
        self.assertEqual(self.unmatched(), set())
        self.all_alive(self.services)

    def follows(self, epoch, sequence):
        """Whether a frame after that sequence, of a later epoch, has been voted on."""
        # The history comes first; behind it the present.
        present = self.echo("voter_output", 200)[-1:]
        return any(voted["sequence_number"] > sequence and voted["epoch"] > epoch for voted in present)

    def unmatched(self):
        return {event["source_name"] for event in self.all_events() if event["code"] == NO_MATCH and "frame matched nobody for 5 s" in event["text"]}

    def memory_mb(self):
        """Resident, of every service."""
        def resident(process):
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
            return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024

        return {name: resident(process) for name, (process, _) in self.services.items()}

    def test_frames_of_another_type_are_told_from_silence(self):
        """DDS matches by type: a publisher of `frame` from another IDL never matches, and every lane reports that."""
        publisher = self.publish("type")
        self.eventually(lambda: LANES <= self.unmatched(), "every lane reports that it has no match", timeout=12)
        self.stop(publisher)
        self.all_alive(self.services)

    def test_a_qos_that_does_not_fit_is_named(self):
        publisher = self.publish("qos")

        def told_of_reliability():
            return {e["source_name"] for e in self.all_events() if e["code"] == INCOMPATIBLE_QOS and "frame" in e["text"] and "RELIABILITY" in e["text"].upper()}

        self.eventually(lambda: LANES <= told_of_reliability(), "every lane names the policy", timeout=12)
        self.stop(publisher)
        self.all_alive(self.services)

    def test_ten_thousand_units_of_others_cost_little(self):
        memory = []
        for _ in range(3):
            publisher = self.publish("units")
            before = max((event["epoch"] for event in self.all_events()), default=0)
            self.eventually(lambda: self.follows(before, 700), "the unit is voted on while 10 000 others are published")
            memory.append(self.memory_mb())
            self.stop(publisher)
        self.all_alive(self.services)
        for name, resident in memory[-1].items():
            self.assertLess(resident, LARGEST_RESIDENT_MB, f"{name}: {memory}")
            self.assertLess(resident, memory[0][name] + LARGEST_GROWTH_MB, f"{name} grows with every 10 000 units: {memory}")

    def test_every_mistake_is_named_and_nobody_ends(self):
        # The first of them meets services that never had a description.
        for mistake in MISTAKES:
            with self.subTest(mistake):
                self.is_named(mistake)
        self.is_followed()

    def test_without_a_mistake_nothing_is_refused(self):
        self.is_followed()


if __name__ == "__main__":
    unittest.main(verbosity=2)
