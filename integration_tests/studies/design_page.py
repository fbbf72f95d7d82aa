"""The designer's results as a page: the study's tables and picture, and the 24-gyro array of the recordings grown and shrunk.

usage: QUORIENT_BIN=build/release/bin python3 -m integration_tests.studies.design_page > integration_tests/studies/results/array_design.md
"""
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time

from integration_tests.harness import exact_json
from integration_tests.harness.processes import BIN, DATA

RESULTS = pathlib.Path(__file__).resolve().parent / "results"
LOG = DATA / "mimu4444_carlsson/exp_1/data.bin"


def run(program, *arguments):
    """@returns what it printed, and the seconds that it took."""
    begin = time.monotonic()
    done = subprocess.run([BIN / program, *map(str, arguments)], stdout=subprocess.PIPE, text=True, check=True, timeout=900)
    return done.stdout, time.monotonic() - begin


def print_study():
    text, seconds = run("quorient-studies", "design", "--seed", 1, "--plot", RESULTS / "design.svg", "--force")
    print("# Which array to build: what the designer finds\n")
    print(f"Made by `python3 -m integration_tests.studies.design_page`, {platform.machine()}, {os.cpu_count()} processors. The tables and the picture come from "
          f"`quorient-studies design --seed 1 --plot design.svg` ({seconds:.0f} s). Times in the tables are those of one search on all processors, "
          "beside whatever else ran.\n")
    print(text)
    print("![Surviving ten years against the number of axes](design.svg)\n")


def print_removals(cluster):
    arguments = ("design", "--keep", cluster, "--remove", "--fault", "instrument")
    removals = exact_json.loads(run("quorient", *arguments, "--json")[0])["removals"]
    print("`quorient design --keep cluster.yaml --remove --fault instrument`: which of the eight may go, the cheapest first, with the noise that was calibrated [rad].\n")
    print("| instrument removed | trace | condition | worst trace after 1 |\n|---|---|---|---|")
    for removal in removals:
        print(f"| {removal['instrument']} | {removal['trace']:.5e} | {removal['condition']:.5f} | {removal['worst_after'][0]['trace']:.5e} |")


def print_growth(cluster):
    arguments = ("design", "--keep", cluster, "--without", "21,22,23", "--axes", 2, "--starts", 2, "--designs", 1, "--failures", 1)
    text, seconds = run("quorient", *arguments, "--json")
    found = exact_json.loads(text)
    design, bound = found["designs"][0], found["bound"]
    print(f"\n`quorient design --keep cluster.yaml --without 21,22,23 --axes 2 --starts 2 --designs 1 --failures 1` ({seconds:.0f} s): "
          "the last instrument is gone, two single axes come.\n")
    print("| axis | x | y | z |\n|---|---|---|---|")
    for number, axis in enumerate(design["axes"][-2:], len(design["axes"]) - 2):
        print(f"| {number} | " + " | ".join(f"{value:.8f}" for value in axis) + " |")
    print(f"\nThe trace is then {design['trace']:.5f} (bound {bound['trace']:.5f}), the worst one after a failure "
          f"{design['worst_after'][0]['trace']:.5f} (bound {bound['worst_after'][0]['trace']:.5f}).")


def print_recorded_array():
    print("## The 24-gyro array of the recordings\n")
    if not LOG.exists():
        print(f"{LOG} is not there: this part was left out.", file=sys.stderr)
        return
    with tempfile.TemporaryDirectory() as folder:
        cluster = pathlib.Path(folder) / "cluster.yaml"
        run("quorient", "calibrate", LOG, "--out", cluster)
        print("`quorient calibrate exp_1/data.bin --out cluster.yaml` measures its axes: eight instruments at right angles.\n")
        print_removals(cluster)
        print_growth(cluster)


if __name__ == "__main__":
    print_study()
    print_recorded_array()
