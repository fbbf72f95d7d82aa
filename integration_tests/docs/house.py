#!/usr/bin/env python3
"""How the rooms of two commits compare: lines, public headers, the largest file, members of the two classes that hold most state, and in how
many places each rule is written.

usage: python3 -m integration_tests.docs.house [BEFORE [AFTER]] > integration_tests/results/house.md
"""
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BEFORE = "cd3fac4"  # the commit that the review of the architecture read
CODE = (".cpp", ".hpp", ".c", ".h", ".py")
MEMBER = re.compile(r"^\s+[A-Za-z_:][\w:<>, *&]*\s\w+_(\{.*\}|\s=.*)?;", re.MULTILINE)
# The class with the most state of each room, then and now.
STATEFUL = {
    "the integrator's engine": ("common/attitude/src/engine.hpp", "common/attitude/include/quorient/attitude/integrator.hpp"),
    "the voter": ("common/voting/src/brain.hpp", "common/voting/include/quorient/voting/voter.hpp"),
}
LONG_FILE = 400
CODE_FOLDERS = ("common", "services", "integration_tests/studies")
FDI = ("common/fdi",)
# A rule, the places that wrote it at cd3fac4 as the review counted them (of names of messages the pattern finds two more), and what finds those that write it now.
RULES = (
    ("in a new epoch an exclusion counts from sequence 0", 5, r"!= never\) \w+\[axis\] = 0", CODE_FOLDERS),
    ("a publisher that restarts is silent for max(5 intervals, 100 ms)", 2, r"std::max\((silent_intervals|intervals \*)|least_grace_ns =", CODE_FOLDERS),
    ("vouched means FULL or DEGRADED", 2, r"VoteLevel::full \|\|", CODE_FOLDERS),
    ("frames are missing before this one", 7, r"sequence - (newest_|previous_|last_|latest_)(\.|->)sequence - 1|sequence - next_sequence_"
     r"|missing = last_->sequence \+ 1|0 : newest_\.sequence \+ 1|\(sequence - last_sequence\)|sequence - \(frame\.epoch == next_"
     r"|latest_->sequence - 1", CODE_FOLDERS),
    ("an axis is usable", 4, r"isfinite\((measurement\.)?increment(\[|\))", FDI),
    ("angle between attitudes", 3, r"2 \* std::a(cos|tan2\(q)", CODE_FOLDERS),
    ("words of codes", 2, r'VoteLevel::single, "', CODE_FOLDERS),
    ("text into a name of a message", 6, r"copy_n\(.*(Size|Size - 1|name\.size\(\).*)\), name\.begin", CODE_FOLDERS),
    ("corrected increment = (raw - bias x interval) / gain", 4, r"/ (\w+\.)*gain\[", CODE_FOLDERS),
    ("the terms of motion noise, as a struct", 4, r"double jitter_along_s = 0", CODE_FOLDERS),
    ("reading YAML with lines and columns", 2, r"YAML::Load(All|File)\(", CODE_FOLDERS),
    ("reading the worked cases of the tests", 3, r'/ "cases\.json"', ("common",)),
    ("main() of a service: command line, system file, bus, loop", 3, r"runtime::parse_options\(argc", CODE_FOLDERS),
    ("how often a service looks whether it is ready", 3, r"readiness_period_ns =", CODE_FOLDERS),
    ("what a lane made of a fault, as a struct", 3, r"struct Reaction \{", CODE_FOLDERS),
)


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=True).stdout


def files_of(commit):
    return [path for path in git("ls-tree", "-r", "--name-only", commit).splitlines() if path.endswith(CODE)]


def text_of(commit, path):
    return git("show", f"{commit}:{path}")


def room_of(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] in ("common", "services") and len(parts) > 2 else parts[0]


def is_test(path):
    return "/test/" in path or path.startswith("integration_tests/")


class Room:
    def __init__(self):
        self.source = self.test = self.public = self.longest = 0


def rooms_of(commit):
    rooms, long_files = collections.defaultdict(Room), []
    for path in files_of(commit):
        room, lines = rooms[room_of(path)], text_of(commit, path).count("\n")
        if is_test(path):
            room.test += lines
        else:
            room.source += lines
        room.public += "/include/" in path
        room.longest = max(room.longest, lines)
        if lines > LONG_FILE:
            long_files.append((lines, path))
    return rooms, sorted(long_files, reverse=True)


def members(commit, path):
    return len(MEMBER.findall(text_of(commit, path)))


def places(commit, pattern, folders):
    """How many lines outside the tests match. The worked cases stand in tests alone."""
    without_tests = () if "cases" in pattern else (":(exclude)*/test/*", ":(exclude)*_test.cpp")
    found = subprocess.run(["git", "-C", ROOT, "grep", "-cE", "-e", pattern, commit, "--", *folders, *without_tests], capture_output=True, text=True)
    return sum(int(line.rsplit(":", 1)[1]) for line in found.stdout.splitlines())


def print_copies(commit):
    print("\n## Copies of each rule, before and after\n\nBefore: as a review of cd3fac4 counted them by reading. After: lines outside the tests that "
          "`git grep -nE PATTERN -- FOLDERS` finds.\n\n| rule | before | after | pattern | folders |\n|---|---|---|---|---|")
    for rule, before, pattern, folders in RULES:
        shown = pattern.replace("|", "\\|")
        print(f"| {rule} | {before} | {places(commit, pattern, folders)} | `{shown}` | {' '.join(folders)} |")


def main():
    before = sys.argv[1] if len(sys.argv) > 1 else BEFORE
    after = sys.argv[2] if len(sys.argv) > 2 else "HEAD"
    print(f"# The rooms before and after\n\nMade by `python3 -m integration_tests.docs.house {before} > integration_tests/results/house.md` at "
          f"{git('rev-parse', '--short', after).strip()}.\nLines are those of C++, C and Python, with comments and blank lines. Each cell: before, after; \"-\" is no such room.\n")
    (old, _), (new, long_files) = rooms_of(before), rooms_of(after)
    print("| room | lines | test lines | public headers | longest file |\n|---|---|---|---|---|")

    def pair(name, figure):
        return ", ".join(str(getattr(rooms[name], figure)) if name in rooms else "-" for rooms in (old, new))

    for name in sorted(set(old) | set(new)):
        print(f"| `{name}` | " + " | ".join(pair(name, figure) for figure in ("source", "test", "public", "longest")) + " |")
    print("\n| data members of | before | after |\n|---|---|---|")
    for name, (then, now) in STATEFUL.items():
        print(f"| {name} | {members(before, then)} (`{then}`) | {members(after, now)} (`{now}`) |")
    print("\nWhat the two classes hold by pointer has members of its own, then as now.")
    print(f"\nFiles of more than {LONG_FILE} lines after: " + (", ".join(f"`{path}` ({lines})" for lines, path in long_files) or "none") + ".")
    print_copies(after)


if __name__ == "__main__":
    main()
