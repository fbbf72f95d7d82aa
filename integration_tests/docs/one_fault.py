#!/usr/bin/env python3
"""Runs the default demo and prints what each process sent about the frames around the fault, as a Markdown table.

usage: QUORIENT_BIN=build/release/bin python3 -m integration_tests.docs.one_fault > integration_tests/results/one_fault.md
"""
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

from integration_tests.harness import exact_json

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ.get("QUORIENT_BIN", ROOT / "build/release/bin"))
SYSTEM = ROOT / "deploy/configurations/demo.yaml"
FAULT = 1600  # 8 s at 200 Hz
SHOWN = range(FAULT - 1, FAULT + 3)
TOPICS = ("frame", "verdict", "attitude", "voter_output")
RUN_S = 60

VERDICT = {1: "WARMING_UP", 2: "HEALTHY", 3: "SUSPECT", 4: "ISOLATED", 5: "AMBIGUOUS", 6: "BLIND"}
LEVEL = {1: "FULL", 2: "DEGRADED", 3: "SINGLE", 4: "COASTING", 5: "LOST"}
DETECTOR_OUT, INTEGRATOR_OUT, VOTER_OUT = 2, 4, 6  # places in stamp_ns


def record(folder):
    environment = dict(os.environ, QUORIENT_RUN_DIR=str(folder))
    files = [open(folder / topic, "w") for topic in TOPICS]
    listeners = [subprocess.Popen([BIN / "quorient", "echo", topic, "--timeout", str(RUN_S), "--json"], stdout=file, stderr=subprocess.DEVNULL)
                 for topic, file in zip(TOPICS, files)]
    try:
        command = [BIN / "quorient", "launch", SYSTEM, "--set", "stamps=true", "--set", "source.duration_s=10", "--json"]
        subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=RUN_S)
    finally:
        for listener in listeners:
            listener.terminate()
            listener.wait(timeout=10)
        for file in files:
            file.close()


def samples(folder, topic):
    with open(folder / topic) as file:
        found = [exact_json.loads(line) for line in file if line.startswith("{") and line.endswith("}\n")]
    return [sample for sample in found if sample["sequence_number"] in SHOWN]


def axes(mask):
    return ", ".join(str(axis) for axis in range(4) if mask >> axis & 1) or "none"


def rows(folder):
    sent = {frame["sequence_number"]: frame["stamp_ns"][0] for frame in samples(folder, "frame")}

    for sequence, stamp in sent.items():
        yield stamp, sequence, "sensor", "frame"
    for verdict in samples(folder, "verdict"):
        isolated = verdict["isolated_mask"]
        since = f", excluded from frame {min(frame for frame in verdict['excluded_from'] if frame is not None)}" if isolated else ""
        said = f"{VERDICT[verdict['state']]}, suspects: {axes(verdict['suspect_mask'])}, isolated: {axes(isolated)}{since}"
        yield verdict["stamp_ns"][DETECTOR_OUT], verdict["sequence_number"], f"detector {'abc'[verdict['detector'] - 1]}", said
    for attitude in samples(folder, "attitude"):
        said = (f"axes used: {axes(attitude['used_mask'])}, isolated: {axes(attitude['isolated_mask'])}, resets: {attitude['reset_counter']}, "
                f"verdict applied: {attitude['verdict_sequence']}")
        yield attitude["stamp_ns"][INTEGRATOR_OUT], attitude["sequence_number"], f"integrator {'abc'[attitude['lane'] - 1]}", said
    for output in samples(folder, "voter_output"):
        said = (f"{LEVEL[output['level']]}, primary: lane {'abc'[output['primary_lane'] - 1]}, {bin(output['vouching_mask']).count('1')} lanes vouch, "
                f"isolated: {axes(output['isolated_mask'])}, resets: {output['reset_counter']}")
        yield output["stamp_ns"][VOTER_OUT], output["sequence_number"], f"voter-{output['voter']}", said


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        record(folder)
        table = sorted(rows(folder))
    if not table:
        print("no samples: is the demo running elsewhere on this host?", file=sys.stderr)
        return 1
    start = next(stamp for stamp, sequence, source, _ in table if sequence == FAULT and source == "sensor")
    print(f"Made by `integration_tests/docs/one_fault.py`, {platform.machine()}, {os.cpu_count()} processors.")
    print("Times count from the moment at which the sensor sent frame 1600, the first one with the fault in it.\n")
    print("| ms | frame | process | sent |\n|---|---|---|---|")
    for stamp, sequence, source, said in table:
        print(f"| {(stamp - start) / 1e6:.2f} | {sequence} | {source} | {said} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
