"""Size and cost of a recording at 200 Hz, and what kill -9 leaves of one: `python3 -m integration_tests.records.measure`. Prints a table.

The loss by a kill is the time from the last sample in the file to the signal, for kills at several phases of a chunk.
"""
import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

from integration_tests.harness.processes import BIN, CONFIGURATIONS

DEMO = CONFIGURATIONS / "demo.yaml"
DOMAIN = 61
SECONDS = 30
KILLS_AFTER_S = (2.1, 2.4, 2.7, 3.0, 3.3)


def command(verb, *arguments):
    return [str(BIN / "quorient"), verb, *map(str, arguments)]


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def record(folder):
    """@returns size [bytes], cost [processor seconds per second] and the last line of a recording of SECONDS."""
    file = folder / "flight.mcap"
    process = subprocess.Popen(command("record", file, "--domain", DOMAIN, "--duration", SECONDS), stderr=subprocess.PIPE, text=True)
    time.sleep(SECONDS - 2)  # the time that is measured
    cost = cpu_seconds(process.pid) / (SECONDS - 2)
    _, told = process.communicate(timeout=30)
    return file.stat().st_size, cost, told.strip()


def kill(folder, number, after_s):
    """@returns the frames that replay reads, and how many never reached the file."""
    killed, witness = folder / f"killed_{number}.mcap", folder / f"witness_{number}.csv"
    processes = [subprocess.Popen(command("record", file, "--domain", DOMAIN), stderr=subprocess.DEVNULL) for file in (killed, witness)]
    time.sleep(after_s)
    for process in processes:
        process.kill()
        process.wait()
    report = json.loads(subprocess.run(command("replay", killed, "--system", DEMO, "--json"), capture_output=True, text=True, check=True).stdout)
    return report["frames"], len(witness.read_text().splitlines()) - 1


def main():
    with tempfile.TemporaryDirectory(prefix="quorient-measure-") as name:
        folder = pathlib.Path(name)
        environment = dict(os.environ, QUORIENT_RUN_DIR=name)
        launched = subprocess.Popen(
            command("launch", DEMO, "--domain", DOMAIN, "--json", "--set", "source.duration_s=120", "--set", "expect=null"),
            env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        try:
            time.sleep(2)  # the pipeline starts; what is measured does not depend on it
            size, cost, told = record(folder)
            frames = int(re.search(r": (\d+) frames", told).group(1))
            kills = [kill(folder, number, after_s) for number, after_s in enumerate(KILLS_AFTER_S)]
        finally:
            launched.terminate()
            launched.wait(timeout=30)
    seconds = frames / 200
    print("| what | |\n|---|---|")
    print(f"| told by `record` | {told.split(': ', 1)[1]} |")
    print(f"| size per minute | {size / seconds * 60 / 1e6:.1f} MB |")
    print(f"| write rate | {size / seconds / 1e3:.0f} kB/s |")
    print(f"| processor time of `record` | {100 * cost:.1f} % of one processor |")
    for (kept, witnessed), after_s in zip(kills, KILLS_AFTER_S):
        print(f"| kill -9 after {after_s} s | {kept} frames are read, a CSV killed with it has {witnessed} |")


if __name__ == "__main__":
    main()
