"""Every topic from each of {Fast DDS, Cyclone DDS} x {Debian 12, Debian 13} to each, whichever end starts first, compared field by field.

    sudo unshare -n sh -c 'ip link set lo up; python3 -m integration_tests.releases.every_topic'

Both releases need the program, which is built by name:

    cmake --build --preset release --target quorient-every-topic
    deploy/release-root RELEASE cmake --build --preset release --target quorient-every-topic"""
import itertools
import os
import random
import subprocess
import sys
import time

from integration_tests.harness.debian import own_release
from integration_tests.harness.processes import BIN, ROOT
from integration_tests.releases.mixed_system import OTHER, caches

PROGRAM = "quorient-every-topic"
VENDORS = ("fastdds", "cyclonedds")
SECONDS = 30
AHEAD_S = 3  # by which the end that starts first is ahead: a command in the root begins a second later
DOMAIN = 60


def command(release, *arguments):
    words = [str(argument) for argument in arguments]
    if release == own_release():
        return [str(BIN / PROGRAM), *words]
    return [str(ROOT / "deploy/release-root"), "--host-network", release, f"build/release/bin/{PROGRAM}", *words]


def run(writing, reading, writer_first, domain, seed):
    """@returns whether the reader has received all that was written, and what it says."""
    ends = {"write": command(writing[0], writing[1], domain, seed, SECONDS, "--write"), "read": command(reading[0], reading[1], domain, seed, SECONDS)}
    processes = {}
    try:
        for name in ("write", "read") if writer_first else ("read", "write"):
            processes[name] = subprocess.Popen(ends[name], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, start_new_session=True)
            if len(processes) == 1:
                time.sleep(AHEAD_S)
        said, _ = processes["read"].communicate(timeout=2 * SECONDS)
        return processes["read"].returncode == 0, said.strip() or f"exit code {processes['read'].returncode}"
    finally:
        for process in processes.values():
            process.terminate()
        for process in processes.values():
            process.wait(2 * SECONDS)


def main():
    other = OTHER.get(own_release())
    if other is None or os.geteuid() != 0:
        sys.exit("needs root, and one of the releases " + ", ".join(OTHER))
    for program in (BIN / PROGRAM, caches() / other / "build/release/bin" / PROGRAM):
        if not program.exists():
            sys.exit(f"no {program}; the commands that build it:\n{__doc__}")
    seed = random.randrange(2**32)
    print(f"seed {seed}\n\n| writer | reader | first | received |\n|---|---|---|---|")
    failed = 0
    nodes = list(itertools.product(OTHER, VENDORS))
    cases = [(writing, reading, writer_first) for writing, reading in itertools.product(nodes, nodes) for writer_first in (True, False)]
    for place, (writing, reading, writer_first) in enumerate(cases):
        held, said = run(writing, reading, writer_first, DOMAIN + place, seed)
        failed += not held
        print(f"| {' '.join(writing)} | {' '.join(reading)} | {'writer' if writer_first else 'reader'} | {said} |", flush=True)
    print(f"\n{len(cases)} runs, {failed} of them without everything")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
