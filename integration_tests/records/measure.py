"""Size and cost of a recording at 200 Hz, what both readers find in it, and what kill -9 leaves of one. Prints a table.

    python3 -m integration_tests.records.measure [SECONDS]

The loss by a kill is the time from the last sample in the file to the signal, for kills at several phases of a chunk.
"""
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

from integration_tests.harness.node_packages import run_script
from integration_tests.harness.processes import BIN, CONFIGURATIONS

CHECK = pathlib.Path(__file__).with_name("check_record.mjs")
DEMO = CONFIGURATIONS / "demo.yaml"
DOMAIN = 61
CHUNK = 0x06  # opcode of a chunk
SECONDS = int(sys.argv[1]) if len(sys.argv) > 1 else 20
AROUND_S = 60  # the pipeline's start, and the kills
KILLS_AFTER_S = (2.1, 2.4, 2.7, 3.0, 3.3)


def command(verb, *arguments):
    return [str(BIN / "quorient"), verb, *map(str, arguments)]


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def record(folder):
    """@returns size [bytes], cost [processor seconds per second] and the last lines of a recording of SECONDS, and of a CSV beside it."""
    file = folder / "flight.mcap"
    process, twin = [
        subprocess.Popen(command("record", name, "--domain", DOMAIN, "--duration", SECONDS), stderr=subprocess.PIPE, text=True) for name in (file, folder / "flight.csv")
    ]
    time.sleep(SECONDS - 2)  # the time that is measured
    cost, twin_cost = [cpu_seconds(one.pid) / (SECONDS - 2) for one in (process, twin)]
    text, twin_text = [one.communicate(timeout=30)[1].strip().split(": ", 1)[1] for one in (process, twin)]
    return file.stat().st_size, (cost, twin_cost), (text, twin_text)


def last_time_ns(file):
    """When the last sample of the last whole chunk was received, by the headers of the chunks."""
    content, at, last = file.read_bytes(), len(b"\x89MCAP0\r\n"), 0
    while at + 9 <= len(content):
        opcode, length = struct.unpack_from("<BQ", content, at)
        if at + 9 + length > len(content):
            break
        if opcode == CHUNK:
            _, last = struct.unpack_from("<QQ", content, at + 9)
        at += 9 + length
    return last


def replay(file):
    return json.loads(subprocess.run(command("replay", file, "--system", DEMO, "--set", "expect=null", "--json"), capture_output=True, text=True, check=True).stdout)


def read_by_others(folder, file):
    """By Foxglove's libraries: the messages of each topic, the bytes of all, and how many messages differ when these libraries encode them again."""
    found = json.loads(run_script(CHECK, folder, file, folder / "frames.csv", timeout=1800))
    counts = {topic: facts["messages"] for topic, facts in found["topics"].items() if facts["messages"]}
    if not found["ended"] or found["indexed"] != counts:
        raise AssertionError(f"forwards {counts}, by the index {found['indexed']}")
    return counts, sum(facts["bytes"] for facts in found["topics"].values()), sum(facts["differ"] for facts in found["topics"].values())


def kill(folder, number, after_s):
    """@returns the frames that replay reads, and how long before the kill the last sample was received [s]."""
    file = folder / f"killed_{number}.mcap"
    process = subprocess.Popen(command("record", file, "--domain", DOMAIN), stderr=subprocess.DEVNULL)
    while not file.exists():  # it is made with the first sample
        time.sleep(0.01)
    time.sleep(after_s)
    killed_ns = time.time_ns()
    process.kill()
    process.wait()
    return replay(file)["frames"], (killed_ns - last_time_ns(file)) / 1e9


def main():
    with tempfile.TemporaryDirectory(prefix="quorient-measure-") as name:
        folder = pathlib.Path(name)
        environment = dict(os.environ, QUORIENT_RUN_DIR=name)
        launched = subprocess.Popen(
            command("launch", DEMO, "--domain", DOMAIN, "--json", "--set", f"source.duration_s={SECONDS + AROUND_S}", "--set", "expect=null"),
            env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        try:
            time.sleep(2)  # the pipeline starts; what is measured does not depend on it
            size, costs, texts = record(folder)
            frames = int(re.match(r"(\d+) frames", texts[0]).group(1))
            kills = [kill(folder, number, after_s) for number, after_s in enumerate(KILLS_AFTER_S)]
        finally:
            launched.terminate()
            launched.wait(timeout=30)
        replayed = replay(folder / "flight.mcap")
        counts, content, differ = read_by_others(folder, folder / "flight.mcap")
    seconds = frames / 200
    print("| what | |\n|---|---|")
    print(f"| reported by `record` | {texts[0]} |")
    print(f"| reported by `record` of a CSV beside it | {texts[1]} |")
    print(f"| size | {size / 1e6:.1f} MB |")
    print(f"| frames that `quorient replay` reads | {replayed['frames']} |")
    print(f"| the same by `@mcap/core`, forwards and by the index | {counts['quorient/frame']} frames, {sum(counts.values())} messages in all |")
    print(f"| of these {content / 1e6:.1f} MB, decoded and encoded again by Foxglove's libraries | {differ} messages have other bytes |")
    print(f"| size per minute | {size / seconds * 60 / 1e6:.1f} MB |")
    print(f"| write rate | {size / seconds / 1e3:.0f} kB/s |")
    print(f"| processor time of `record` | {100 * costs[0]:.1f} % of one processor; of a CSV {100 * costs[1]:.1f} % |")
    for (kept, lost_s), after_s in zip(kills, KILLS_AFTER_S):
        print(f"| kill -9 after {after_s} s | {kept} frames are read; the last {lost_s:.2f} s are missing |")


if __name__ == "__main__":
    main()
