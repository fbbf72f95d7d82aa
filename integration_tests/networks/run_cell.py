"""Spoils the network between the hosts of a running pipeline and judges what is left: `--list`, NAME…, `--all`."""
import argparse
import signal
import sys
import time
from typing import Callable, NamedTuple

from integration_tests.networks.hosts import Hosts, not_permitted
from integration_tests.networks.load import Load
from integration_tests.networks.spread_pipeline import Place, SpreadPipeline
from integration_tests.harness.judge import Figures, errors_beyond, judge
from integration_tests.harness.pipeline import ALL_LANES, RATE_HZ, NotInTime, ask_for_priority, at_least_once, rate_between
from integration_tests.harness.steady import Steady
from integration_tests.harness.streams import DEGRADED, HELD, SINGLE

FAULTY_AXIS = 1
FAULT_AFTER_S = 0.5  # after the harm begins: the lane that is cut off learns of the fault when the harm is over
NOTICED_S = 0.5  # after which nothing but DEGRADED is right while a lane is cut off
LANE_NAMES = "abc"
LEVEL_NAMES = ("starting", "FULL", "DEGRADED", "SINGLE", "COASTING", "LOST")


class Layout(NamedTuple):
    networks_of_host: dict
    places: dict
    listener: Place
    begin_s: float = 1.5  # from the first frame to the harm


def lanes_on_hosts():
    """One network; lanes a, b, c on three hosts, the sensor, the voters and the listeners on a fourth. Vendors as in the demo."""
    lanes = {"a": "cyclonedds", "b": "fastdds", "c": "cyclonedds"}
    places = {f"{role}-{lane}": Place(lane, vendor) for lane, vendor in lanes.items() for role in ("attitude", "fdi")}
    core = {"voter-1": Place("core", "cyclonedds"), "voter-2": Place("core", "fastdds"), "sensor": Place("core", "cyclonedds")}
    return Layout({host: ("A",) for host in ("core", *lanes)}, core | places, Place("core", "cyclonedds"))


def two_networks():
    """Lane a on network A, lane c on network B, all else on both. A process on both runs on Fast DDS, which sends on all its networks.
    In its first second Fast DDS announces itself fifty times to every participant slot of every peer; the harm begins after that."""
    networks = {"core": ("A", "B"), "a": ("A",), "b": ("A", "B"), "c": ("B",)}
    lanes = {"a": ("cyclonedds", "eth0"), "b": ("fastdds", "any"), "c": ("fastdds", "eth0")}
    places = {f"{role}-{lane}": Place(lane, *joins) for lane, joins in lanes.items() for role in ("attitude", "fdi")}
    core = {name: Place("core", "fastdds", "any") for name in ("voter-1", "voter-2", "sensor")}
    return Layout(networks, core | places, Place("core", "fastdds", "any"), begin_s=2.5)


class Cell(NamedTuple):
    name: str
    duration_s: float
    begin: Callable  # harm, given the hosts
    end: Callable
    layout: Callable = lanes_on_hosts
    impaired: dict = {}
    without: str = ""  # the lane that is cut off
    fault: bool = False


def unplugged(duration_s, fault):
    return Cell(f"link-b/{duration_s}s/{'isolating' if fault else 'quiet'}", duration_s, lambda hosts: hosts.unplug("b"),
                lambda hosts: hosts.plug("b"), without="b", fault=fault)


def network_cut(network, lane, duration_s):
    return Cell(f"networks/{network}-cut/{duration_s}s", duration_s, lambda hosts: hosts.cut(network), lambda hosts: hosts.heal(network),
                layout=two_networks, without=lane)


def loss(percent, where, affected):
    def begin(hosts):
        for host in affected:
            hosts.lose(host, percent / 100)

    def end(hosts):
        for host in affected:
            hosts.lose_nothing(host)

    return Cell(f"loss-{percent}%/{where}", 6, begin, end)


def bad_cable(what, options, where, affected):
    return Cell(f"{what}/{where}", 6, lambda hosts: hosts.impair("bad"), lambda hosts: hosts.impair("good"),
                impaired={host: (*options, "--seed", str(seed)) for seed, host in enumerate(affected)})


ONE_OR_ALL = (("b", ("b",)), ("all", ("core", *LANE_NAMES)))
EVERYTHING = [
    *(unplugged(duration_s, fault) for duration_s in (2, 14) for fault in (False, True)),
    *(network_cut(network, lane, duration_s) for duration_s in (2, 14) for network, lane in (("A", "a"), ("B", "c"))),
    *(loss(percent, *affected) for percent in (5, 20) for affected in ONE_OR_ALL),
    *(bad_cable("delay-20ms", ("--delay-ms", "20"), *affected) for affected in ONE_OR_ALL),
    *(bad_cable("corruption-1%", ("--corruption", "0.01"), *affected) for affected in ONE_OR_ALL),
]
BY_NAME = {cell.name: cell for cell in EVERYTHING}


class Outcome(NamedTuple):
    figures: Figures = None
    levels: str = ""  # the levels reported while the harm lasted
    busy: float = None  # the share of the machine's time in use; None where the run ended before
    broken: list = []  # the bounds that were not met
    logs: dict = {}


def back(sample):
    return sample.vouching == ALL_LANES and sample.excluded == 0 and sample.level <= SINGLE


def run(cell, rate_hz):
    layout = cell.layout()
    fault_s = layout.begin_s + FAULT_AFTER_S
    faults = [f"axis={FAULTY_AXIS},kind=scale,value=0.8,start={fault_s}"] if cell.fault else []
    with Hosts(layout.networks_of_host, cell.impaired) as hosts, \
            SpreadPipeline(hosts, layout.places, layout.listener, rate_hz, "source.duration_s=600", f"source.faults={faults}") as pipeline:
        pipeline.until_running()
        load = Load()
        begun = pipeline.until_frame(layout.begin_s * rate_hz)
        cell.begin(hosts)
        healed = pipeline.until_frame((layout.begin_s + cell.duration_s) * rate_hz)
        cell.end(hosts)
        late = None
        try:
            pipeline.until(Steady(pipeline.merged.samples, back), "all lanes again behind both voters", 20)
        except NotInTime as problem:
            late = str(problem)
        busy = load.busy()
        summary = pipeline.finish()
        merged = pipeline.merged.samples
        figures = judge(merged, pipeline.plain.samples, pipeline.truth.samples, summary, healed, pipeline.end,
                        1 << FAULTY_AXIS if cell.fault else 0, (1, 2), back)
        during = [sample for sample in merged if (begun[0], begun[1] + NOTICED_S * rate_hz) <= sample.identity < healed]
        broken = list(bounds_broken(cell, figures, during))
        broken += [f"{name} ended with {code}" for name, code in pipeline.gone.items()]
        if late:
            broken.append(late)
        logs = {name: pipeline.log_of(name) for name in layout.places} if broken else {}
    return Outcome(figures, said(during), busy, broken, logs)


def said(during):
    """The levels while the harm lasts, with their shares."""
    shares = {level: sum(sample.level == level for sample in during) / max(len(during), 1) for level in {sample.level for sample in during}}
    return ", ".join(f"{LEVEL_NAMES[level]} {share:.0%}" for level, share in sorted(shares.items()))


def bounds_broken(cell, figures, during):
    """Yields a sentence for each promise that does not hold."""
    if figures.wrong_isolations:
        yield f"{figures.wrong_isolations} wrong isolations"
    if figures.disordered:
        yield f"{figures.disordered} samples out of order"
    if figures.missing:
        yield f"{figures.missing} voted frames missing"
    yield from errors_beyond(figures, cell.fault)
    if figures.frames_to_full is None:
        yield "never back"
    if cell.without:
        lane = 1 << LANE_NAMES.index(cell.without)
        wrong = sum(sample.level < DEGRADED or sample.level not in HELD and bool(sample.vouching & lane) for sample in during)
        if wrong or not during:
            yield f"{wrong} of {len(during)} samples do not say that lane {cell.without} is cut off"


HEADER = ("cell", "frames missing", "plain gap [frames]", "level meanwhile", "largest error [rad]", "final error [rad]",
          "wrong isolations", "healed to all lanes [frames]", "processors busy", "outcome")


def row(cell, outcome, attempts):
    figures, levels, busy, broken, _ = outcome
    if figures is None:
        return (cell.name, *("–",) * 8, "; ".join(broken))
    verdict = "; ".join(broken) if broken else "holds" if attempts == 1 else f"holds at attempt {attempts}"
    return (cell.name, figures.missing, figures.plain_gap, levels, f"{figures.largest_error_rad:.1e}", f"{figures.final_error_rad:.1e}",
            figures.wrong_isolations, "–" if figures.frames_to_full is None else figures.frames_to_full, f"{busy:.0%}", verdict)


def attempt(cell, rate_hz, attempts_allowed=2):
    """On a shared machine one attempt may get too little processor time: the second one counts, and the table says so.
    @returns outcome, attempts."""
    for attempts in range(1, attempts_allowed + 1):
        try:
            outcome = run(cell, rate_hz)
        except NotInTime as problem:
            outcome = Outcome(broken=[str(problem)])
        if not outcome.broken:
            break
        busy = "" if outcome.busy is None else f", processors {outcome.busy:.0%} busy"
        print(f"{cell.name}: attempt {attempts}{busy}: {'; '.join(outcome.broken)}", file=sys.stderr, flush=True)
    return outcome, attempts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cells", nargs="*", help="names as --list shows them")
    parser.add_argument("--all", action="store_true", help="all cells")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--logs", action="store_true", help="show the logs of the processes of a cell that does not hold")
    parser.add_argument("--attempts", type=at_least_once, default=2)
    parser.add_argument("--rate", type=rate_between(20), metavar="HZ", default=RATE_HZ, help="of the system")
    options = parser.parse_args()
    if options.list:
        print("\n".join(BY_NAME))
        return 0
    unknown = [name for name in options.cells if name not in BY_NAME]
    if unknown:
        parser.error(f"unknown cells {unknown}; --list shows them")
    if reason := not_permitted():
        print(f"skipped, networks cannot be made here: {reason}")
        return 0
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # what was made is removed then too
    ask_for_priority()
    started = time.monotonic()
    cells = EVERYTHING if options.all else [BY_NAME[name] for name in options.cells]
    failed = 0
    print("| " + " | ".join(HEADER) + " |\n|" + "---|" * len(HEADER), flush=True)
    for cell in cells:
        outcome, attempts = attempt(cell, options.rate, options.attempts)
        failed += bool(outcome.broken)
        print("| " + " | ".join(map(str, row(cell, outcome, attempts))) + " |", flush=True)
        if options.logs:
            for name, text in outcome.logs.items():
                print(f"--- {name}\n{text}", file=sys.stderr)
    print(f"\n{len(cells)} cells, {failed} do not hold, {time.monotonic() - started:.0f} s; made by `python3 -m integration_tests.networks.run_cell {' '.join(sys.argv[1:])}`")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
