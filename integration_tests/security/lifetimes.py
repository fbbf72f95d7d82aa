"""What a running system does about a certificate that expires or is revoked: `python3 -m integration_tests.security.lifetimes` prints the table.

The member is an operator on each vendor. It subscribes to what the voters publish and sends orders; a monitor on each vendor counts them."""
import argparse
import shutil
import sys
import time

from integration_tests.harness.pipeline import NotInTime, Pipeline, ask_for_priority
from integration_tests.security.rogues import VENDORS, Listener, Rogue, quorient
from integration_tests.security.run_rogues import RATE_HZ

LIFETIME_S = 30
OBSERVED_S = 4.0
PATIENCE_S = 25  # for the member to take part, before its certificate expires
DAY_S = 86400


class Member:
    """An operator beside the system, and what passes between the two."""

    def __init__(self, pipeline, listeners, vendor, keys, name):
        self._listeners, self._vendor = listeners, vendor
        self._rogue = Rogue(vendor, pipeline, "--keys", keys, "--as", name, "--publish", "command", "--seconds", 1000)

    def counts(self):
        """Samples read from the voter, and orders received by the monitor, on each vendor."""
        return [*(self._rogue.read_from(victim) for victim in VENDORS), *(self._listeners[victim].forged(self._vendor) for victim in VENDORS)]

    def takes_part(self, pipeline):
        before = self.counts()
        pipeline.until(lambda: all(now > then for now, then in zip(self.counts(), before)), "the member takes part", PATIENCE_S)

    def during(self, seconds):
        before = self.counts()
        time.sleep(seconds)
        return [now - then for now, then in zip(self.counts(), before)]

    def stop(self):
        self._rogue.stop()


def expires(pipeline, join):
    quorient("keys", "--out", pipeline.keys, "--add", "brief", "--role", "operator", "--days", LIFETIME_S / DAY_S)
    expiry_s = time.monotonic() + LIFETIME_S
    member = join(pipeline.keys, "brief")
    yield member
    member.takes_part(pipeline)
    time.sleep(max(0.0, expiry_s + 1 - time.monotonic()))


def is_revoked(pipeline, join):
    quorient("keys", "--out", pipeline.keys, "--add", "late", "--role", "operator")
    member = join(pipeline.keys, "late")
    yield member
    member.takes_part(pipeline)
    quorient("keys", "--out", pipeline.keys, "--revoke", "late")
    time.sleep(1)


def joins_revoked(pipeline, join):
    quorient("keys", "--out", pipeline.keys, "--add", "later", "--role", "operator")
    before = pipeline.run_directory / "before"
    shutil.copytree(pipeline.keys, before)
    quorient("keys", "--out", pipeline.keys, "--revoke", "later")
    member = join(before, "later")
    yield member
    time.sleep(OBSERVED_S)


SITUATIONS = (("a member's certificate expires", expires), ("a member is revoked", is_revoked),
              ("a revoked member joins; the others have not restarted since", joins_revoked))


def outcome(situation, vendor):
    """@returns what passed in OBSERVED_S afterwards."""
    with Pipeline("source.duration_s=600", "source.faults=[]", level="encrypt", rate_hz=RATE_HZ) as pipeline:
        listeners = {victim: Listener(victim, pipeline) for victim in VENDORS}
        member = None
        try:
            pipeline.until_running()
            pipeline.until(lambda: all(listener.receives() for listener in listeners.values()), "a monitor on each vendor receives both voters")
            steps = situation(pipeline, lambda keys, name: Member(pipeline, listeners, vendor, keys, name))
            member = next(steps)
            next(steps, None)
            return member.during(OBSERVED_S)
        finally:
            for node in (*listeners.values(), *([member] if member else [])):
                node.stop()


def begun(situation, vendor, attempts=3):
    """outcome(). On a busy machine an attempt may not come to the situation; then the next one counts."""
    for left in reversed(range(attempts)):
        try:
            return outcome(situation, vendor)
        except NotInTime as problem:
            print(f"again: {problem}", file=sys.stderr, flush=True)
            if not left:
                raise


HEADER = ("what happens", "member on", "samples read from Fast DDS", "from Cyclone DDS", "orders received on Fast DDS", "on Cyclone DDS")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--on", choices=VENDORS, action="append", help="the member's vendor; default: each in turn")
    options = parser.parse_args()
    ask_for_priority()
    print("| " + " | ".join(HEADER) + " |\n|" + "---|" * len(HEADER), flush=True)
    for name, situation in SITUATIONS:
        for vendor in options.on or VENDORS:
            print("| " + " | ".join(map(str, (name, vendor, *begun(situation, vendor)))) + " |", flush=True)
    print(f"\nIn the {OBSERVED_S:.0f} s after it; made by `python3 -m integration_tests.security.lifetimes {' '.join(sys.argv[1:])}`")
    return 0


if __name__ == "__main__":
    sys.exit(main())
