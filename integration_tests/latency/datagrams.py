"""Counts what a pipeline and its floor send per frame, and the CPU time that it takes: in a network namespace of their own.

    sudo unshare -n python3 -m integration_tests.latency.datagrams [--rate 200]"""
import argparse
import os
import pathlib
import shutil
import subprocess
import tempfile
import time

from integration_tests.latency import graphs
from integration_tests.latency.usage import Usage

TRANSPORTS = ("UDP, Cyclone DDS", "UDP, Fast DDS")
START_S = 7  # Fast DDS announces itself ten times a second for five
COUNT_S = 2


def udp_counters():
    names, values = [line.split()[1:] for line in pathlib.Path("/proc/net/snmp").read_text().splitlines() if line.startswith("Udp:")]
    return dict(zip(names, map(int, values)))


def count(commands, rate_hz, environment):
    processes = {
        name: subprocess.Popen(list(map(str, command)), env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for name, command in commands.items()
    }
    try:
        time.sleep(START_S)
        before, usage, begin_s = udp_counters(), Usage(processes), time.monotonic()
        usage.look()
        time.sleep(COUNT_S)
        after = udp_counters()
        usage.look()
        used = usage.between(begin_s, time.monotonic())
    finally:
        for process in processes.values():
            process.terminate()
        for process in processes.values():
            process.wait()
    frames = COUNT_S * rate_hz
    cpu_us = sum(process["cpu_percent"] for process in used.values()) / 100 / rate_hz * 1e6
    return (after["OutDatagrams"] - before["OutDatagrams"]) / frames, (after["InDatagrams"] - before["InDatagrams"]) / frames, cpu_us


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rate", type=int, default=200)
    parser.add_argument("--domain", type=int, default=30)
    options = parser.parse_args()
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    directory = pathlib.Path(tempfile.mkdtemp(prefix="quorient-datagrams-"))
    environment = dict(os.environ, QUORIENT_RUN_DIR=str(directory))
    seconds = START_S + COUNT_S + 10
    print("| transport | graph | sent per frame | received per frame | CPU per frame [us] |\n|---|---|---|---|---|")
    for transport in TRANSPORTS:
        case = {"transport": transport, "rate_hz": options.rate}
        ours = graphs.our_commands(graphs.system_file(directory, case, options.domain, 1, seconds), case)
        for graph, commands in (("ours", ours), ("floor", graphs.floor_commands(case, options.domain, seconds))):
            sent, received, cpu_us = count(commands, options.rate, environment)
            print(f"| {transport}, {options.rate} Hz | {graph} | {sent:.1f} | {received:.1f} | {cpu_us:.0f} |", flush=True)
    shutil.rmtree(directory)


if __name__ == "__main__":
    main()
