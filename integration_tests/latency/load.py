"""What the pipeline promises on a machine that is busy with other work: the demo beside a load that leaves a share of each processor.

    sudo python3 -m integration_tests.latency.load                    # all rows, about six minutes; the table goes to standard output
    python3 -m integration_tests.latency.load --free 0.25 --rates 200
    python3 -m integration_tests.latency.load --free 1 --rates 1000 --vendors "Fast DDS" --processors 0    # one processor does not carry that

The load is stress-ng's (a Debian package), at the priority of this program. `launch` reads all topics and judges the run, `quorient-latency-probe` reads the ages."""
import argparse
import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile

from integration_tests.harness import exact_json
from integration_tests.harness.processes import BIN, CONFIGURATIONS

FAULTY_AXIS = 1
LEVEL_CHANGED = 33  # EventCode
FAULT_S = 5
PATIENCE_S = 40  # beyond the duration: starts and ends beside a load are slow
BEGIN = 0.2  # of each run does not count for the ages

VENDORS = {"both vendors": [], "Fast DDS": ["dds=fastdds", "lanes.b.dds=fastdds", "voters.voter-2.dds=fastdds"],
           "Cyclone DDS": ["dds=cyclonedds", "lanes.b.dds=cyclonedds", "voters.voter-2.dds=cyclonedds"]}


@contextlib.contextmanager
def load(free):
    """Leaves so much of each processor."""
    if free >= 1:
        yield
        return
    cores = len(os.sched_getaffinity(0))
    stress = subprocess.Popen(["stress-ng", "--quiet", "--cpu", str(cores), "--cpu-load", str(round(100 * (1 - free)))])
    try:
        yield
    finally:
        stress.terminate()
        stress.wait()


def settings(assignments):
    return [word for assignment in assignments for word in ("--set", assignment)]


def run(vendors, rate_hz, free, options):
    """@returns the summary of launch, the probe's report and the events."""
    domain = str(options.domain)
    with tempfile.TemporaryDirectory(prefix="quorient-load-") as directory, load(free):
        environment = dict(os.environ, QUORIENT_RUN_DIR=directory)

        def start(*command):
            return subprocess.Popen(list(map(str, command)), env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

        probe = start(BIN / "quorient-latency-probe", "--domain", domain, "--skip", int(BEGIN * options.seconds * rate_hz), "--interval", 1 / rate_hz)
        events = start(BIN / "quorient", "echo", "event", "--json", "--domain", domain)
        launch = start(BIN / "quorient", "launch", CONFIGURATIONS / "demo.yaml", "--domain", domain, "--json", *settings([
            f"source.rate_hz={rate_hz}", f"source.duration_s={options.seconds}", "stamps=true", "expect=null",
            f"source.faults=['axis={FAULTY_AXIS},kind=bias,value=0.05,start={FAULT_S}']", *VENDORS[vendors],
            *([f"priority={options.priority}"] if options.priority else [])]))
        try:
            summary = exact_json.loads(launch.communicate(timeout=options.seconds + PATIENCE_S)[0])
        finally:
            outputs = []
            for process in (launch, events, probe):
                if process.poll() is None:
                    process.terminate()
                try:
                    outputs.append(process.communicate(timeout=10)[0])
                except subprocess.TimeoutExpired:
                    process.kill()
                    outputs.append(process.communicate()[0])
    return summary, json.loads(outputs[2]), [exact_json.loads(line) for line in outputs[1].splitlines() if line.endswith("}")]


HEADER = ("demo on", "rate [Hz]", "free of each processor", "age p50 [ms]", "age p99 [ms]", "age max [ms]", "frames sent", "not voted", "level changes",
          "lanes that isolated the fault", "sound axes isolated", "largest error [rad]")


def row(vendors, rate_hz, free, summary, probe, events):
    age = probe["hops"]["sensor_to_voted"] or {}
    isolated = [lane["isolated"] for lane in summary["lanes"].values()]
    worst = summary["voted"]["attitude"]["max_error_rad"]
    return (vendors, rate_hz, free, *(f"{age[q] / 1000:.1f}" if age else "–" for q in ("p50", "p99", "max")), summary["frames"], summary["voted"]["missing"],
            sum(event["code"] == LEVEL_CHANGED for event in events), sum(FAULTY_AXIS in axes for axes in isolated),
            sum(axis != FAULTY_AXIS for axes in isolated for axis in axes), "–" if worst is None else f"{worst:.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--free", type=float, nargs="+", default=[1, 0.5, 0.25, 0.1])
    parser.add_argument("--rates", type=int, nargs="+", default=[200, 1000])
    parser.add_argument("--vendors", nargs="+", choices=VENDORS, default=["both vendors"])
    parser.add_argument("--seconds", type=float, default=15, help="of frames in each run")
    parser.add_argument("--processors", type=int, nargs="+", help="only these, for everything here; all if not stated")
    parser.add_argument("--priority", type=int, help="the system file's `priority`; the load has none")
    parser.add_argument("--domain", type=int, default=58)
    options = parser.parse_args()
    if min(options.free) < 1 and not shutil.which("stress-ng"):
        parser.error("there is no stress-ng to make a load: install Debian's package stress-ng, or state --free 1")
    if options.processors:
        os.sched_setaffinity(0, options.processors)
    print("| " + " | ".join(HEADER) + " |\n|" + "---|" * len(HEADER), flush=True)
    wrong = False
    for vendors in options.vendors:
        for rate_hz in options.rates:
            for free in options.free:
                try:
                    outcome = run(vendors, rate_hz, free, options)
                except (subprocess.TimeoutExpired, ValueError, KeyError) as problem:
                    print(f"| {vendors} | {rate_hz} | {free} | did not end: {problem!r}" + " |" * (len(HEADER) - 3), flush=True)
                    continue
                cells = row(vendors, rate_hz, free, *outcome)
                wrong = wrong or cells[-2] > 0
                print("| " + " | ".join(map(str, cells)) + " |", flush=True)
    print(f"\nMade by `python3 -m integration_tests.latency.load {' '.join(sys.argv[1:])}`.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
