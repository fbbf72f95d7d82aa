"""What the observer received around a fault, as a table."""
from integration_tests.harness.quaternion import angle

LEVEL_NAMES = ("starting", "FULL", "DEGRADED", "SINGLE", "COASTING", "LOST")
BEFORE, AFTER = 2, 16  # frames shown


def steps_text(steps):
    return " -> ".join(f"{LEVEL_NAMES[level]} at {sequence:+d}" for sequence, level in steps)


def axes_text(mask):
    return ", ".join(str(axis) for axis in range(24) if mask >> axis & 1) or "–"


def cell(samples, begin_s):
    """When the samples of one frame arrived [ms after begin_s]."""
    return "; ".join(f"{1e3 * (sample.arrival_s - begin_s):.1f} ms" for sample in samples) or "–"


def table(observed, title, since, end):
    """Frames around `since`, the newest that was voted when the harm began, and the events until `end`."""
    epoch, first = since
    shown = [(epoch, sequence) for sequence in range(first - BEFORE, first + AFTER + 1)]
    truth = {sample.identity: sample for sample in observed.truth}
    begin_s = next((sample.arrival_s for sample in observed.truth if sample.identity == since), 0.0)
    lines = [f"## {title}", "", "Times from the arrival of that frame's truth.", "",
             "| frame | truth | voter 1 | voter 2 | `voted` | by voter | level | lanes | isolated | error [rad] |", "|" + "---|" * 10]
    for identity in shown:
        merged = [sample for sample in observed.merged if sample.identity == identity]
        plain = [sample for sample in observed.plain if sample.identity == identity]
        said = (merged or [None])[-1]
        true = truth.get(identity)
        lines.append("| " + " | ".join((
            f"{identity[1] - first:+d}",
            cell([true] if true else [], begin_s),
            *(cell([sample for sample in merged if sample.voter == voter], begin_s) for voter in (1, 2)),
            cell(plain, begin_s),
            ", ".join(str(sample.voter) for sample in plain) or "–",
            LEVEL_NAMES[said.level] if said else "–",
            " ".join("abc"[place] for place in range(3) if said.vouching >> place & 1) if said else "–",
            axes_text(said.isolated) if said else "–",
            f"{angle(said.attitude, true.attitude):.1e}" if said and true else "–",
        )) + " |")
    events = [event for event in observed.events if since <= event.identity <= end and event.severity > 1]
    lines += ["", *(f"- {event.identity[1] - first:+d} {event.source}: {event.text}" for event in sorted(events, key=lambda event: event.arrival_s)[:20]), ""]
    return "\n".join(lines)
