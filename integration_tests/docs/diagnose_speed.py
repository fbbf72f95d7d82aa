#!/usr/bin/env python3
"""Speed and memory of `quorient diagnose` as a whole on large logs, as rows of a table.

usage: python3 -m integration_tests.docs.diagnose_speed MEGABYTES FOLDER [KIND ...]     logs that are in the folder already are taken as they are
"""
import os
import pathlib
import subprocess
import sys
import time

from integration_tests.harness.processes import BIN

KINDS = ("dataflash", "ulog", "csv", "long-csv", "mcap")


def made(kind, megabytes, folder):
    """A log of three gyros at 1 kHz, written by the readers' own bench."""
    file = folder / f"{kind}_{megabytes}.log"
    if not file.exists():
        subprocess.run([BIN / "recording_log_speed", kind, str(megabytes), file], check=True, capture_output=True)
    return file


def measured(file):
    """Wall time and processor time [s], peak memory [MB] and the sentence of one diagnosis."""
    begin = time.monotonic()
    process = subprocess.Popen([BIN / "quorient", "diagnose", file], stdout=subprocess.PIPE, text=True)
    sentence = process.stdout.readline().strip()
    process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{file}: exit code {process.returncode}")
    return time.monotonic() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, sentence


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    megabytes, folder = int(sys.argv[1]), pathlib.Path(sys.argv[2])
    print("| log | MB | diagnose, s | MB/s | processor, s | MB per processor second | peak memory, MB | sentence |\n" + "|---" * 8 + "|")
    for kind in sys.argv[3:] or KINDS:
        file = made(kind, megabytes, folder)
        size = file.stat().st_size / (1 << 20)
        seconds, processor_s, memory, sentence = measured(file)
        speeds = f"{seconds:.1f} | {size / seconds:.0f} | {processor_s:.1f} | {size / processor_s:.0f}"
        print(f"| {kind} | {size:.0f} | {speeds} | {memory:.0f} | {sentence} |", flush=True)


if __name__ == "__main__":
    main()
