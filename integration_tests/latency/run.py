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

from integration_tests.latency import table

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BIN = pathlib.Path(os.environ.get("QUORIENT_BIN", ROOT / "build/release/bin"))
PAGE_MIB = os.sysconf("SC_PAGE_SIZE") / 2**20
PING_PATIENCE_S = 60  # all rounds of one pair of processes; they take some seconds
START_PATIENCE_S = 15
UNITS_SECONDS = 6  # many processes start slowly
LADDER_SECONDS = 8  # the probe may miss two of them
LOOK_S = 0.5  # a look at nine processes takes 0.3 to 0.9 ms
CPUCLOCK_SCHED = 2  # CPU-time clock of a process: MAKE_PROCESS_CPUCLOCK of the kernel's posix-timers.h
DOMAINS = 16  # used in turns: the one before may still be saying goodbye
FLOORS = ("floor", "floor_that_waits")
PROGRAMS = ("quorient-latency-graph", "quorient-latency-probe", "quorient-latency-ping")

# Name -> the keys of the system file for sensor, lanes and voters in turn, and the floor's arguments.
TRANSPORTS = {
    "UDP, Cyclone DDS": ([{"dds": "cyclonedds"}], ["--dds", "cyclonedds"]),
    "UDP, Fast DDS": ([{"dds": "fastdds"}], ["--dds", "fastdds"]),
    "shared memory, Fast DDS": ([{"dds": "fastdds", "transport": "shm"}], ["--dds", "fastdds", "--shared-memory"]),
    "iceoryx, Cyclone DDS": ([{"dds": "cyclonedds", "transport": "iceoryx"}], ["--dds", "cyclonedds", "--shared-memory"]),
    "mixed": ([{"dds": "cyclonedds", "transport": "iceoryx"}, {"dds": "fastdds", "transport": "shm"}, {"dds": "cyclonedds"}], None),
}
LAYOUTS = {4: "cone-4", 6: "cone-6", 8: "octahedron-8", 24: "triads-8"}
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


def cpu_s(process):
    """CPU time of all threads of a process, by one call: reading /proc/PID/task takes milliseconds, which would delay the processes."""
    return time.clock_gettime(~process.pid << 3 | CPUCLOCK_SCHED)


class Usage:
    """CPU and memory of processes, sampled from time to time, and interpolated to any time between two samples."""

    def __init__(self, processes):
        self.processes = processes
        self.looks = []

    def look(self):
        found = {}
        for name, process in self.processes.items():
            try:
                with open(f"/proc/{process.pid}/statm") as pages:
                    found[name] = (cpu_s(process), int(pages.read().split()[1]) * PAGE_MIB)
            except (OSError, IndexError):  # it has ended
                continue
        self.looks.append((time.monotonic(), found))

    def between(self, begin_s, end_s):
        """@returns {process: ...} from the first look to the last one in this time; empty where there are not two."""
        looks = [look for look in self.looks if begin_s <= look[0] <= end_s]
        if len(looks) < 2:
            return {}
        (first_s, first), (last_s, last) = looks[0], looks[-1]
        return {
            name: {"cpu_percent": 100 * (cpu - first[name][0]) / (last_s - first_s), "rss_mib": rss}
            for name, (cpu, rss) in last.items() if name in first
        }


def system_file(directory, case, domain, unit, seconds):
    keys = TRANSPORTS[case["transport"]][0]
    at = lambda place: dict(keys[place % len(keys)])  # noqa: E731
    # A core for every process is more than this machine has: only a lane's own processes spin.
    common = {"stamps": True, "spin": case.get("spin", False)}
    axes = case.get("axes", 4)
    method = {"method": "vector"} if axes == 4 else {}  # the default of the layout
    system = {
        "name": "latency", "domain": domain, "interface": "lo", **common,
        "unit": {"id": unit, "layout": LAYOUTS[axes]},
        "sensor": at(0),
        "source": {
            "motion": {"kind": "coning", "k2": 0.084, "k3": 0.05}, "rate_hz": case["rate_hz"], "duration_s": seconds,
            "quantum_rad": 0.4848e-6, "quantize": "carry",
        },
        "lanes": [{"name": f"l{i}", "detector": method, **at(i)} for i in range(case.get("lanes", 3))],
        "voters": [{"name": f"voter-{i + 1}", **at(i)} for i in range(case.get("voters", 2))],
    }
    path = directory / f"system-{unit}.yaml"
    path.write_text(json.dumps(system))  # JSON is YAML
    return path


def our_commands(file, case, prefix=""):
    names = [("quorient-voter", f"voter-{i + 1}") for i in range(case.get("voters", 2))]
    for i in range(case.get("lanes", 3)):
        names += [("quorient-attitude", f"attitude-l{i}"), ("quorient-fdi", f"fdi-l{i}")]
    return {prefix + name: [BIN / program, file, "--name", name] for program, name in [*names, ("quorient-sensor", "sensor")]}


def lanes_composed(file, case):
    """Detector and integrator of each lane in one process."""
    commands = our_commands(file, case)
    for i in range(case.get("lanes", 3)):
        names = [f"fdi-l{i}", f"attitude-l{i}"]
        for name in names:
            del commands[name]
        commands = {"+".join(names): [BIN / "quorient-run", file, *names], **commands}
    return commands


def all_but_sensor_composed(file, case):
    commands = our_commands(file, case)
    names = [name for name in commands if name != "sensor"]
    return {"all but the sensor": [BIN / "quorient-run", file, *names], "sensor": commands["sensor"]}


def floor_commands(case, domain, seconds):
    base = [BIN / "quorient-latency-graph"]
    lanes, voters = case.get("lanes", 3), case.get("voters", 2)
    common = [*TRANSPORTS[case["transport"]][1], "--domain", domain, "--lanes", lanes, "--voters", voters]
    common += ["--spin"] if case.get("spin") else []
    commands = {f"voter-{i + 1}": [*base, "voter", "--number", i + 1, *common] for i in range(voters)}
    for i in range(lanes):
        commands[f"attitude-l{i}"] = [*base, "integrator", "--number", i, *common]
        commands[f"fdi-l{i}"] = [*base, "detector", "--number", i, *common]
    commands["sensor"] = [*base, "sensor", *common, "--rate", case["rate_hz"], "--duration", seconds]
    return commands


def probe_command(case, domain, skip):
    reads_by = TRANSPORTS[case["transport"]][0][0]
    return [BIN / "quorient-latency-probe", "--dds", reads_by["dds"], "--transport", reads_by.get("transport", "udp"), "--domain", domain, "--skip", skip,
            "--interval", 1 / case["rate_hz"]]


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
        probe = start(probe_command(case, domain, skip), stdout=subprocess.PIPE, text=True)
        processes = {name: start(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for name, command in commands.items()}
        sensors = [process for name, process in processes.items() if name.endswith("sensor")]
        units = case.get("units", 1)
        heard = 1 if case.get("own_domains") else units  # by the probe, in its domain
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
        whole = int(round(seconds * case["rate_hz"])) * heard
        report["expected"] = whole - skip * heard - report["before_the_probe"]
        report["never_sent"] = whole - report["sent"] if report["sent"] else 0
        return report

    def ours(self, case, seconds):
        commands = {}
        for unit in range(1, case.get("units", 1) + 1):
            domain = self.next_domain(unit - 1) if case.get("own_domains") else self.domain
            file = system_file(self.directory, case, domain, unit, seconds)
            commands.update(our_commands(file, case, f"{unit}/" if case.get("units", 1) > 1 else ""))
        return self.run(commands, self.domain, case, seconds)

    def lanes(self, case, seconds):
        return self.run(lanes_composed(system_file(self.directory, case, self.domain, 1, seconds), case), self.domain, case, seconds)

    def all_but_sensor(self, case, seconds):
        return self.run(all_but_sensor_composed(system_file(self.directory, case, self.domain, 1, seconds), case), self.domain, case, seconds)

    def floor(self, case, seconds):
        return self.run(floor_commands(case, self.domain, seconds), self.domain, case, seconds)

    def floor_that_waits(self, case, seconds):
        commands = {name: [*command, "--waits"] for name, command in floor_commands(case, self.domain, seconds).items()}
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
                tell(case, turn, result["rounds"][-1])
        return [result for result in results if any("ours" in entry for entry in result["rounds"])]


def tell(case, turn, entry):
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
        "date": time.strftime("%Y-%m-%d", time.gmtime()),
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
