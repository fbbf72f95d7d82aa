"""Measures the latency of real pipelines beside their floors, in turns, and writes JSON and a table.

    sudo nice -n -15 python3 -m integration_tests.latency.run            # everything, at most 20 minutes
    python3 -m integration_tests.latency.run --quick                     # everything once and short: does it work?
    python3 -m integration_tests.latency.run --only hops,transports --rounds 1 --seconds 1

Every ratio is of runs of one round, which stand beside each other in time; of the rounds the median counts."""
import argparse
import json
import os
import pathlib
import platform
import shutil
import socket
import subprocess
import sys
import tempfile
import time

from integration_tests.latency import graphs, table
from integration_tests.latency.graphs import BIN, LAYOUTS, TRANSPORTS
from integration_tests.latency.usage import Usage

HERE = pathlib.Path(__file__).resolve().parent
PING_PATIENCE_S = 60  # all rounds of one pair of processes; they take some seconds
START_PATIENCE_S = 15
UNITS_SECONDS = 6  # many processes start slowly
LADDER_SECONDS = 8  # the probe may miss two of them
LOOK_S = 0.5  # a look at nine processes takes 0.3 to 0.9 ms
DOMAINS = 16  # used in turns: the one before may still be saying goodbye
FLOORS = ("floor", "floor_that_waits")
PROGRAMS = ("quorient-latency-graph", "quorient-latency-probe", "quorient-latency-ping")
PINGS = (("cyclonedds", "udp"), ("fastdds", "udp"), ("fastdds", "shm"), ("cyclonedds", "iceoryx"))
SPINNING_PINGS = (("cyclonedds", "udp"), ("cyclonedds", "iceoryx"))


class Roudi:
    """iceoryx's daemon for as long as the measurement lasts, unless one runs."""

    def __init__(self):
        self.process = None

    def __enter__(self):
        if not self.answers():
            pools = "".join(f"[[segment.mempool]]\nsize = {size}\ncount = {count}\n" for size, count in ((1024, 12000), (2688, 500), (16384, 64)))
            file = pathlib.Path(tempfile.mkstemp(suffix=".toml")[1])
            file.write_text("[general]\nversion = 1\n[[segment]]\n" + pools)
            self.process = subprocess.Popen(["iox-roudi", "-c", file], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            while not self.answers():
                time.sleep(0.02)
        return self

    def __exit__(self, *_):
        if self.process:
            self.process.terminate()
            self.process.wait()

    @staticmethod
    def answers():
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as probe:
            return probe.connect_ex("/tmp/roudi") == 0


class Runner:
    def __init__(self, options):
        self.options = options
        self.directory = pathlib.Path(tempfile.mkdtemp(prefix="quorient-latency-"))
        self.domain = options.domain
        self.deadline = time.monotonic() + 60 * options.limit
        self.skipped = []

    def out_of_time(self, what):
        """@returns whether this is to be left out; the results list it."""
        if time.monotonic() < self.deadline:
            return False
        self.skipped.append(what)
        return True

    def run(self, commands, domain, case, seconds):
        """One run until its sensors have ended. @returns the probe's report with the processes' usage."""
        environment = dict(os.environ, QUORIENT_RUN_DIR=str(self.directory))
        skip = int(0.2 * seconds * case["rate_hz"])  # caches, branch predictors and the last matches
        start = lambda command, **more: subprocess.Popen(list(map(str, command)), env=environment, **more)  # noqa: E731
        probe = start(graphs.probe_command(case, domain, skip), stdout=subprocess.PIPE, text=True)
        processes = {name: start(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for name, command in commands.items()}
        sensors = [process for name, process in processes.items() if name.endswith("sensor")]
        units = case.get("units", 1)
        seen_units = 1 if case.get("own_domains") else units  # by the probe, in its domain
        usage = Usage(processes)
        try:
            deadline = time.monotonic() + START_PATIENCE_S + seconds
            while any(sensor.poll() is None for sensor in sensors):
                if time.monotonic() > deadline:
                    raise subprocess.TimeoutExpired("the sensor", START_PATIENCE_S + seconds)
                usage.look()
                time.sleep(max(LOOK_S, seconds / 20))
            time.sleep(0.1)
        finally:
            for process in [*processes.values(), probe]:
                if process.poll() is None:
                    process.terminate()
            for process in [*processes.values(), probe]:
                try:
                    process.wait(timeout=5)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
        report = json.loads(probe.stdout.read())
        if "begin_s" not in report:
            ask_for_build("quorient-latency-probe is of an earlier build")
        report["processes"] = usage.between(report["begin_s"], report["end_s"])
        whole = int(round(seconds * case["rate_hz"])) * seen_units
        report["expected"] = whole - skip * seen_units - report["before_the_probe"]
        report["never_sent"] = whole - report["sent"] if report["sent"] else 0
        return report

    def ours(self, case, seconds):
        commands = {}
        for unit in range(1, case.get("units", 1) + 1):
            domain = self.next_domain(unit - 1) if case.get("own_domains") else self.domain
            file = graphs.system_file(self.directory, case, domain, unit, seconds)
            commands.update(graphs.our_commands(file, case, f"{unit}/" if case.get("units", 1) > 1 else ""))
        return self.run(commands, self.domain, case, seconds)

    def lanes(self, case, seconds):
        return self.run(graphs.lanes_composed(graphs.system_file(self.directory, case, self.domain, 1, seconds), case), self.domain, case, seconds)

    def all_but_sensor(self, case, seconds):
        return self.run(graphs.all_but_sensor_composed(graphs.system_file(self.directory, case, self.domain, 1, seconds), case), self.domain, case, seconds)

    def floor(self, case, seconds):
        return self.run(graphs.floor_commands(case, self.domain, seconds), self.domain, case, seconds)

    def floor_that_waits(self, case, seconds):
        commands = {name: [*command, "--waits"] for name, command in graphs.floor_commands(case, self.domain, seconds).items()}
        return self.run(commands, self.domain, case, seconds)

    def next_domain(self, steps):
        return self.options.domain + (self.domain - self.options.domain + steps) % DOMAINS

    def once(self, who, case, seconds):
        """A run that fails is reported, and the others continue."""
        self.domain = self.next_domain(1)
        try:
            return getattr(self, who)(case, seconds)
        except (OSError, ValueError, subprocess.SubprocessError) as error:
            print(f"{case} {who}: {error!r}", file=sys.stderr, flush=True)
            return None

    def in_turns(self, cases, rounds, floors=FLOORS, seconds=None, others=()):
        """All cases of a round beside each other, ours, the floors and the other graphs by turns."""
        results = [{"case": case, "rounds": []} for case in cases]
        for turn in range(rounds):
            for result in results:
                case = result["case"]
                if self.out_of_time(f"{table.name_of(case)}, round {turn + 1}"):
                    continue
                whom = ["ours", *(floors if TRANSPORTS[case["transport"]][1] and case.get("units", 1) == 1 else ()), *others]
                entry = {who: self.once(who, case, seconds or self.options.seconds) for who in [*whom[turn % len(whom):], *whom[:turn % len(whom)]]}
                result["rounds"].append({who: report for who, report in entry.items() if report})
                print_round(case, turn, result["rounds"][-1])
        return [result for result in results if any("ours" in entry for entry in result["rounds"])]


def print_round(case, turn, entry):
    def of(report):
        voted = report["hops"]["sensor_to_voted"]
        return f"p50 {voted['p50']:.0f} us, lost {table.lost(report)}" if voted else "nothing"

    parts = [f"{who} {of(report)}" for who, report in entry.items()]
    print(f"{table.name_of(case)}, round {turn + 1}: {'; '.join(parts)}", file=sys.stderr, flush=True)


def hops(runner):
    results = []
    for spin, paths in ((False, PINGS), (True, SPINNING_PINGS)):
        for vendor, transport in paths:
            command = [BIN / "quorient-latency-ping", "--dds", vendor, "--transport", transport, "--domain", runner.options.domain + DOMAINS,
                       "--rounds", max(3, runner.options.rounds), "--per-round", runner.options.pings, *(["--spin"] if spin else [])]
            try:
                done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=PING_PATIENCE_S)
            except subprocess.TimeoutExpired:
                print(f"{vendor} {transport}: no answer within {PING_PATIENCE_S} s, left out", file=sys.stderr, flush=True)
                continue
            if done.returncode:
                print(done.stderr, file=sys.stderr)
                continue
            results.append(json.loads(done.stdout))
            medians = {name: value["p50"] for name, value in results[-1]["rounds"][0].items() if "p50" in value}
            print(vendor, transport, "spinning" if spin else "blocking", medians, file=sys.stderr, flush=True)
    return results


def transports(runner):
    results = []
    for rate in runner.options.rates:
        results += runner.in_turns([{"transport": name, "rate_hz": rate} for name in TRANSPORTS], runner.options.rounds)
    return results


def composed(runner):
    results = []
    for rate in runner.options.rates:
        cases = [{"transport": name, "rate_hz": rate} for name, (_, floor) in TRANSPORTS.items() if floor]
        results += runner.in_turns(cases, runner.options.rounds, FLOORS[:1], others=("lanes", "all_but_sensor"))
    return results


def spinning(runner):
    """A core for every process is more than two cores have: that is what it shows there."""
    cases = [{"transport": "UDP, Cyclone DDS", "rate_hz": 1000, "lanes": 1, "voters": 1, "spin": spin} for spin in (False, True)]
    return runner.in_turns(cases, runner.options.rounds, FLOORS[:1])


def sustained(runner):
    """One minute at 1 kHz, then faster until frames are lost, or more than one in a hundred cannot be sent."""
    results = []
    for name in ("UDP, Cyclone DDS", "iceoryx, Cyclone DDS"):
        case = {"transport": name, "rate_hz": 1000}
        minute = runner.once("ours", case, runner.options.minute)
        if not minute:
            continue
        print(f"{name}: {table.lost(minute)} of {minute['expected']} lost in {runner.options.minute} s", file=sys.stderr, flush=True)
        ladder = []
        for rate in (1500, 2000, 3000, 4000, 6000):
            report = runner.once("ours", {**case, "rate_hz": rate}, min(LADDER_SECONDS, runner.options.minute))
            if not report:
                break
            ladder.append({"rate_hz": rate, "report": report})
            if table.lost(report) > 0 or report["never_sent"] > 0.01 * report["expected"]:
                break
        results.append({"case": case, "seconds": runner.options.minute, "report": minute, "ladder": ladder})
    return results


def growth(runner):
    base = {"transport": "UDP, Cyclone DDS", "rate_hz": 200}
    rounds = min(2, runner.options.rounds)
    results = runner.in_turns([{**base, "lanes": lanes} for lanes in (1, 3, 5, 7)], rounds, FLOORS[:1])
    results += runner.in_turns([{**base, "axes": axes} for axes in LAYOUTS], rounds, ())
    units = {**base, "lanes": 1, "voters": 1}
    counts = [{"units": 1}, {"units": 4}, {"units": 4, "own_domains": True}, {"units": 16}, {"units": 16, "own_domains": True}]
    results += runner.in_turns([{**units, **count} for count in counts], rounds, (), UNITS_SECONDS)
    return results


def version(*packages):
    """Of the package that is installed; releases of Debian name it differently."""
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", *packages], capture_output=True, text=True)
    return done.stdout or "not from a package"


def machine(options):
    model = next((line.split(":")[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")), "?")
    return {
        "processor": model, "cores": os.cpu_count(), "kernel": platform.release(), "load_before": os.getloadavg(), "nice": os.nice(0),
        "versions": {"Fast DDS": version("libfastrtps2.9", "libfastdds3.1"), "Cyclone DDS": version("cyclonedds-dev"), "iceoryx": version("iceoryx")},
        "rounds": options.rounds, "seconds": options.seconds, "command": " ".join(["python3 -m integration_tests.latency.run", *sys.argv[1:]]),
        "date": time.strftime("%Y-%m-%d", time.gmtime()), "time_utc": time.strftime("%H:%M", time.gmtime()),
    }


SECTIONS = {"hops": hops, "transports": transports, "composed": composed, "sustained": sustained, "growth": growth, "spinning": spinning}


def rates(text):
    found = [int(rate) for rate in text.split(",")]
    if min(found) <= 0:
        raise ValueError(text)
    return found


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default=",".join(SECTIONS), help="of " + ",".join(SECTIONS))
    parser.add_argument("--quick", action="store_true", help="one round of 1 s, 5 s in place of the minute")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=2.5, help="of frames in each run")
    parser.add_argument("--rates", default=[200, 1000], type=rates,
                        help="frames per second of the pipelines by transport, Hz: 200,1000")
    parser.add_argument("--minute", type=float, default=60, help="seconds of the long run at 1 kHz")
    parser.add_argument("--pings", type=int, default=1000, help="of each path in each round")
    parser.add_argument("--limit", type=float, default=20, help="minutes after which what is left is left out, and named")
    parser.add_argument("--domain", type=int, default=30, help="this one and the seventeen after it")
    parser.add_argument("--out", type=pathlib.Path, default=HERE.parent / "results/latency", help="NAME: writes NAME.json and NAME.md")
    options = parser.parse_args()
    if unknown := set(options.only.split(",")) - set(SECTIONS):
        parser.error(f"--only {', '.join(sorted(unknown))}: it knows {', '.join(SECTIONS)}")
    if options.quick:
        options.rounds, options.seconds, options.minute, options.pings = 1, 1, 5, 100
    return options


def ask_for_build(what):
    """The ordinary build leaves these programs out."""
    sys.exit(f"{BIN}: {what}; cmake --build {BIN.parent} --target {' '.join(PROGRAMS)}")


def main():
    options = parse()
    missing = [name for name in PROGRAMS if not (BIN / name).exists()]
    if missing:
        ask_for_build(f"no {', '.join(missing)}")
    results = {"machine": machine(options)}
    runner = Runner(options)
    options.out.parent.mkdir(parents=True, exist_ok=True)
    try:
        with Roudi():
            for name in options.only.split(","):
                if not runner.out_of_time(name):
                    results[name] = SECTIONS[name](runner)
    finally:
        shutil.rmtree(runner.directory, ignore_errors=True)
        results["skipped"] = runner.skipped
        options.out.with_suffix(".json").write_text(json.dumps(results, indent=1) + "\n")
        options.out.with_suffix(".md").write_text(table.markdown(results))
    return 0


if __name__ == "__main__":
    sys.exit(main())
