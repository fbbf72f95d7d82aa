#!/usr/bin/env python3
"""What a foreign publisher does wrong is named in events by detectors and integrators, and ends none of them."""
import json
import signal
import unittest

from foreign import HERE, InteropTest, build
from harness import CONFIGURATIONS

REJECTED_INPUT, UNKNOWN_REVISION = 42, 54
DETECTORS = {f"fdi-{lane}" for lane in "abc"}
INTEGRATORS = {f"attitude-{lane}" for lane in "abc"}
LANES = DETECTORS | INTEGRATORS

# What wrong_publisher can do: the event's code, words of its text, who must say them.
MISTAKES = {
    "axis-nan": (REJECTED_INPUT, ("axis 2", "not finite"), LANES),
    "revision": (UNKNOWN_REVISION, ("revision 9", "1 is the newest"), LANES),
    "no-description": (UNKNOWN_REVISION, ("without a description",), LANES),
    "restart": (REJECTED_INPUT, ("after 59", "new, larger epoch"), LANES),
    "axis-count": (REJECTED_INPUT, ("has 5 axes, its description 4",), LANES),
    "interval": (REJECTED_INPUT, ("frame", "interval must be above 0",), LANES),
    "time": (REJECTED_INPUT, ("sample time is not after",), LANES),
    "value": (REJECTED_INPUT, ("axis 2 is not finite",), LANES),
    "sequence-edge": (REJECTED_INPUT, ("after 18446744073709551615",), LANES),
    "no-axes": (REJECTED_INPUT, ("3 to 24 axes",), LANES),
    "axes-255": (REJECTED_INPUT, ("3 to 24 axes",), LANES),
    "interval-nan": (REJECTED_INPUT, ("description is refused", "interval must be above 0",), LANES),
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
        program = build(HERE / "wrong_publisher", "wrong_publisher")
        publisher, _ = self.start_logged(f"publisher-{mistake}", program, self.domain, mistake)
        return publisher

    def stop(self, publisher):
        publisher.send_signal(signal.SIGTERM)
        self.assertEqual(publisher.wait(10), 0)

    def told(self):
        return [json.loads(line) for line in self.events.read_text().split("\n")[:-1]]

    def refused(self, since=0):
        return [event for event in self.told()[since:] if event["code"] in (REJECTED_INPUT, UNKNOWN_REVISION)]

    def is_named(self, mistake):
        code, words, by = MISTAKES[mistake]
        since = len(self.told())
        publisher = self.publish(mistake)

        def sources():
            return {e["source_name"] for e in self.refused(since) if e["code"] == code and all(word in e["text"] for word in words)}

        try:
            self.eventually(lambda: by <= sources(), f"{mistake} named by {sorted(by)}", timeout=8)
        finally:
            self.stop(publisher)
        self.all_alive(self.services)

    def is_followed(self):
        """A publisher that does everything right, from the moment when its predecessor has fallen silent."""
        since = len(self.told())
        newest = max((event["epoch"] for event in self.told()), default=0)
        publisher = self.publish("none")
        try:
            self.eventually(lambda: self.follows_an_epoch_after(newest), "its frames are voted on")
        finally:
            self.stop(publisher)
        self.assertEqual(self.refused(since), [])
        self.all_alive(self.services)

    def follows_an_epoch_after(self, newest):
        # The history comes first; behind it the present.
        present = self.echo("voter_output", 200)[-1:]
        return any(voted["sequence_number"] > 100 and voted["epoch"] > newest for voted in present)

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
