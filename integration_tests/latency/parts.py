"""What the processor does for each frame, by role and by part: the kernel, the vendor's library, the C and C++ libraries, our own code.

    sudo python3 -m integration_tests.latency.parts      # about three minutes; the table goes to standard output; needs Debian's linux-perf

Ours and both floors run in turns. Samples of perf's clock are counted, 8000 in each second of processor time."""
import argparse
import collections
import os
import re
import shutil
import statistics
import subprocess
import sys
import time

from integration_tests.latency import graphs, run, table

SAMPLES_PER_S = 8000
START_S = 3  # discovery, the first frames, and allocations
PARTS = ("kernel", "vendor", "C and C++", "own")
ROLES = {"fdi": "detector", "attitude": "integrator", "voter": "voter", "sensor": "sensor"}
WHOM = ("ours", "floor", "floor_that_waits")
LINE = re.compile(r"\s*(\d+)(?:/\d+)?\s.*\((.*)\)$")
VENDOR_LIBRARIES = ("ddsc", "fastrtps", "fastdds", "fastcdr", "foonathan", "iceoryx", "dds_security", "cyclonedds")


def part_of(object_name):
    name = os.path.basename(object_name)
    if "kernel" in name or name.startswith("[k"):
        return "kernel"
    if any(library in name for library in VENDOR_LIBRARIES):
        return "vendor"
    return "own" if name.startswith("quorient") else "C and C++"


def sampled(runner, who, case, seconds):
    """One run. @returns {role: {part: microseconds of processor time in each frame and process}}."""
    runner.domain = runner.next_domain(1)
    whole = START_S + seconds + 2
    if who == "ours":
        commands = graphs.our_commands(graphs.system_file(runner.directory, case, runner.domain, 1, whole), case)
    else:
        waits = ["--waits"] if who == "floor_that_waits" else []
        commands = {name: [*command, *waits] for name, command in graphs.floor_commands(case, runner.domain, whole).items()}
    environment = dict(os.environ, QUORIENT_RUN_DIR=str(runner.directory))
    quiet = {"env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    processes = {name: subprocess.Popen(list(map(str, command)), **quiet) for name, command in commands.items()}
    try:
        time.sleep(START_S)
        roles = {str(process.pid): ROLES[name.split("-")[0]] for name, process in processes.items()}
        data = runner.directory / "perf.data"
        subprocess.run(["perf", "record", "-q", "-e", "cpu-clock", "-F", str(SAMPLES_PER_S), "-o", data, "-p", ",".join(roles), "sleep", str(seconds)],
                       check=True, timeout=seconds + 20, stdout=subprocess.DEVNULL)
    finally:
        for process in processes.values():
            process.terminate()
        for process in processes.values():
            process.wait(timeout=10)
    text = subprocess.run(["perf", "script", "-i", data, "-F", "pid,ip,dso"], check=True, capture_output=True, text=True, timeout=60).stdout
    return by_role(text, roles, seconds * case["rate_hz"])


def by_role(text, roles, frames):
    """The lines of `perf script -F pid,ip,dso` as microseconds for each frame and process of a role."""
    counts = collections.defaultdict(collections.Counter)
    for line in text.splitlines():
        found = LINE.match(line)
        if found and found[1] in roles:
            counts[roles[found[1]]][part_of(found[2])] += 1
    processes = collections.Counter(roles.values())
    return {role: {part: 1e6 * counts[role][part] / SAMPLES_PER_S / frames / processes[role] for part in PARTS} for role in processes}


def median(rounds, role, part):
    return statistics.median(entry[role][part] for entry in rounds)


def report(case, rounds):
    body = []
    for role in ROLES.values():
        for who, entries in rounds.items():
            values = [median(entries, role, part) for part in PARTS]
            body.append([table.name_of(case) if role == "detector" and who == "ours" else "", role, table.WHO[who],
                         *(table.number(value, 1) for value in values), table.number(sum(values), 1)])
    return body


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=int, default=5)
    parser.add_argument("--rates", default=[200, 1000], type=run.rates)
    parser.add_argument("--transports", default="UDP, Cyclone DDS; iceoryx, Cyclone DDS", help="names of the table, with ; between")
    parser.add_argument("--domain", type=int, default=30)
    options = parser.parse_args()
    options.transports = options.transports.split("; ")
    known = [name for name, (_, floor) in graphs.TRANSPORTS.items() if floor]
    if unknown := set(options.transports) - set(known):
        parser.error(f"--transports {'; '.join(sorted(unknown))}: it knows {'; '.join(known)}")
    if not shutil.which("perf"):
        parser.error("there is no perf: install Debian's package linux-perf")
    options.limit = 30
    return options


def main():
    options = parse()
    runner = run.Runner(options)
    body = []
    with run.Roudi():
        for rate in options.rates:
            for transport in options.transports:
                case = {"transport": transport, "rate_hz": rate}
                rounds = {who: [] for who in WHOM}
                for _ in range(options.rounds):
                    for who in WHOM:
                        rounds[who].append(sampled(runner, who, case, options.seconds))
                body += report(case, rounds)
    print("\n".join(table.rows(["case", "process", "graph", *(f"{part} [us]" for part in PARTS), "sum [us]"], body)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
