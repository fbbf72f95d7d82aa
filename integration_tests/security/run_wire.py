"""What an attacker on the loopback sees and can send again: `python3 -m integration_tests.security.run_wire` prints the table.

Exit code 1 if a secured attitude is found in plain text, if a secured frame is accepted twice, or if the twin without security shows neither."""
import argparse
import sys
from dataclasses import dataclass

from integration_tests.harness.pipeline import LEVELS, NotInTime, Pipeline, ask_for_priority
from integration_tests.security.rogues import VENDORS, Listener
from integration_tests.security.wire import Sniffer, ports_of, renumbered, replay, texts_in, values_in

RATE_HZ, CAPTURE_FRAMES = 50, 100
COUNTED_S = 15  # a listener reports ten times a second
STOPPED = "stopped"  # a listener that no longer reports: the attack has disabled it


@dataclass
class Sight:
    """What the attacker achieved at one level."""

    level: str
    datagrams: int
    attitudes: int  # components of voted attitudes that were found
    of_attitudes: int  # that were looked for
    topics: int  # datagrams with the name of a topic
    replayed: dict  # frames accepted twice by the monitor on each vendor, or STOPPED: captured datagrams as they were
    renumbered: dict  # and with later numbers
    alive: bool  # the system published on through the replay

    def broken(self):
        plain = self.level != "encrypt"
        if bool(self.attitudes) != plain:
            yield f"{self.attitudes} values in plain text"
        for vendor in VENDORS:
            if self.replayed[vendor]:
                yield f"{self.replayed[vendor]} replayed frames accepted on {vendor}"
            if self.renumbered[vendor] and self.level != "none":
                yield f"{self.renumbered[vendor]} renumbered frames accepted on {vendor}"
        if self.level == "none" and not any(self.renumbered.values()):
            yield "no renumbered frame was accepted, on either vendor: the twin shows nothing"
        if self.level != "none" and not self.alive:
            yield "the system stopped"


def look(level):
    """Captures while the demo starts and runs, then replays."""
    with Pipeline("source.duration_s=600", "source.faults=[]", level=level, rate_hz=RATE_HZ) as pipeline:
        sniffer = Sniffer(ports_of(pipeline.domain))
        listeners = {vendor: Listener(vendor, pipeline) for vendor in VENDORS}
        try:
            pipeline.until(lambda: all(listener.receives() for listener in listeners.values()), "a monitor on each vendor receives both voters")
            pipeline.until_running()
            pipeline.until_frame(pipeline.truth.newest.identity[1] + CAPTURE_FRAMES)
            datagrams = sniffer.stop()
            voted = {component for sample in pipeline.merged.samples for component in sample.attitude}
            as_it_was = repeated_by(pipeline, listeners, datagrams)
            with_later_numbers = repeated_by(pipeline, listeners, [(address, port, renumbered(content)) for address, port, content in datagrams])
            alive = progresses(pipeline)
            return Sight(level, len(datagrams), values_in(datagrams, voted), len(voted), texts_in(datagrams, b"quorient/"), as_it_was,
                         with_later_numbers, alive)
        finally:
            for listener in listeners.values():
                listener.stop()


def repeated_by(pipeline, listeners, datagrams):
    before = {vendor: listeners[vendor].counts["repeated"] for vendor in VENDORS}
    replay(datagrams)
    reports = {vendor: listeners[vendor].reports for vendor in VENDORS}
    reported = lambda vendor: listeners[vendor].reports > reports[vendor] + 3  # noqa: E731
    try:
        pipeline.until(lambda: all(map(reported, VENDORS)), "the listeners have counted the replay", COUNTED_S)
    except NotInTime:
        pass  # the one that has not is what the attack did
    return {vendor: listeners[vendor].counts["repeated"] - before[vendor] if reported(vendor) else STOPPED for vendor in VENDORS}


def progresses(pipeline):
    before = len(pipeline.merged.samples)
    try:
        pipeline.until(lambda: len(pipeline.merged.samples) > before + 50, "half a second of voted frames", 5)
        return True
    except NotInTime:
        return False


HEADER = ("level", "datagrams captured", "attitude values found", "datagrams with topic names", "replayed frames accepted: Fast DDS", "Cyclone DDS",
          "renumbered frames accepted: Fast DDS", "Cyclone DDS", "system goes on", "outcome")


def row(sight):
    return (sight.level, sight.datagrams, f"{sight.attitudes} of {sight.of_attitudes}", sight.topics, *sight.replayed.values(), *sight.renumbered.values(),
            "yes" if sight.alive else "no", "; ".join(sight.broken()) or "as promised")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--level", choices=LEVELS, action="append", help="default: all")
    options = parser.parse_args()
    ask_for_priority()
    broken = 0
    print("| " + " | ".join(HEADER) + " |\n|" + "---|" * len(HEADER), flush=True)
    for level in options.level or LEVELS:
        sight = look(level)
        broken += any(sight.broken())
        print("| " + " | ".join(map(str, row(sight))) + " |", flush=True)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
