"""Rogue nodes against the running demo: `python3 -m integration_tests.security.run_rogues` prints the table, exit code 1 if one publishes or receives what it may not.

The victims are the demo's own processes, on both vendors at once, and a monitor on each vendor that counts forged samples."""
import argparse
import json
import subprocess
import sys
import threading

from integration_tests.harness.pipeline import LEVELS, Pipeline, ask_for_priority
from integration_tests.security.rogues import CASES, VENDORS, WITHOUT_SECURITY, Listener, prepare, run_case

RATE_HZ = 50  # the machine also carries the attackers and listeners


class Events:
    """The system's events, as a list that grows."""

    def __init__(self, pipeline):
        self.received = []
        self._process = subprocess.Popen(pipeline.command("echo", "event", "--json", "--domain", pipeline.domain, *pipeline.with_keys()),
                                         env=pipeline.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self._process.stdout:
            self.received.append(json.loads(line))

    def stop(self):
        self._process.kill()
        self._process.wait(5)


def outcomes(level, cases):
    """Runs every case from both vendors against one run of the demo."""
    with Pipeline("source.duration_s=600", "source.faults=[]", level=level, prepare=prepare, rate_hz=RATE_HZ) as pipeline:
        listeners = {vendor: Listener(vendor, pipeline) for vendor in VENDORS}
        events = Events(pipeline)
        try:
            pipeline.until_running()
            pipeline.until(lambda: all(listener.receives() for listener in listeners.values()), "a monitor on each vendor receives both voters")
            for case in cases:
                for vendor in VENDORS:
                    yield run_case(case, vendor, pipeline, listeners, events.received)
        finally:
            events.stop()
            for listener in listeners.values():
                listener.stop()


HEADER = ("rogue", "on", "forged samples at Fast DDS", "at Cyclone DDS", "samples read from Fast DDS", "from Cyclone DDS", "refused locally",
          "reported by Fast DDS", "by Cyclone DDS", "outcome")


def row(outcome):
    return (outcome.case.name, outcome.vendor, *outcome.arrived.values(), *outcome.read.values(), "yes" if outcome.refused_locally else "no",
            *(len(outcome.refusals(vendor)) for vendor in VENDORS), "; ".join(outcome.broken()) or "holds")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--level", choices=LEVELS, default="encrypt", help="none: shows that a plain node then gets in")
    parser.add_argument("--only", help="cases whose name contains this")
    parser.add_argument("--events", action="store_true", help="print the refusals of each case as the services report them")
    options = parser.parse_args()
    ask_for_priority()
    cases = WITHOUT_SECURITY if options.level == "none" else CASES
    broken = 0
    print("| " + " | ".join(HEADER) + " |\n|" + "---|" * len(HEADER), flush=True)
    for outcome in outcomes(options.level, [case for case in cases if not options.only or options.only in case.name]):
        broken += any(outcome.broken())
        print("| " + " | ".join(map(str, row(outcome))) + " |", flush=True)
        if options.events:
            for vendor in VENDORS:
                for text in outcome.refusals(vendor):
                    print(f"    a service on {vendor}: {text}", file=sys.stderr)
    print(f"\nlevel {options.level}; made by `python3 -m integration_tests.security.run_rogues {' '.join(sys.argv[1:])}`")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
