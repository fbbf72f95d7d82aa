#!/usr/bin/env python3
"""What `quorient diagnose` says of every public flight log in the shared data, as a page.

usage: python3 -m integration_tests.docs.diagnose_transcript > integration_tests/results/diagnose.md
"""
import subprocess
import sys

from integration_tests.harness.processes import BIN, DATA

FIELD = DATA / "field"
COMMANDS = (
    ("cats_drone_healthy.csv",),
    ("cats_drone_soft_axis_1.csv",),
    ("cats_drone_soft_axis_1.csv", "--reference", "cats_drone_healthy.csv"),
    ("cats_drone_soft_axis_2.csv",),
    ("cats_drop_counts_long.csv",),
    ("cats_drop_counts_long.csv", "--lsb-per-deg-s", "16.4"),
    ("cats_rocket_healthy_long.csv",),
    ("cats_rocket_pyro_long.csv",),
    ("ardupilot_3_imus_crash.bin",),
    ("ardupilot_2_imus_hole.bin",),
    ("ardupilot_46_instances.bin",),
    ("px4_3_imus.ulg",),
    tuple(f"rover_5_imus/imu{number}.csv" for number in range(1, 6)),
)
HEAD = """# What diagnose says of public flight logs

Made by `python3 -m integration_tests.docs.diagnose_transcript > integration_tests/results/diagnose.md`. Where the logs come from, and what is true of
them, is in the README of the data folder; names of files are those there.
"""


def main():
    if not FIELD.exists():
        sys.exit(f"no flight logs under {FIELD}")
    print(HEAD)
    for arguments in COMMANDS:
        ended = subprocess.run([BIN / "quorient", "diagnose", *arguments], cwd=FIELD, capture_output=True, text=True, timeout=120)
        print(f"```\n$ quorient diagnose {' '.join(arguments)}\n{(ended.stdout + ended.stderr).rstrip()}\n```\n")


if __name__ == "__main__":
    main()
