#!/usr/bin/env python3
"""How the rooms of two commits compare: lines, public headers, the largest file, members of the two classes that hold most state.

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


if __name__ == "__main__":
    main()
