#!/usr/bin/env python3
"""Checks the direction of imports from the include lines: a room uses only the rooms it may.

usage: check_imports.py ROOT              exit 1 and one line per violation
       check_imports.py ROOT --picture    the rooms as a mermaid diagram
       check_imports.py ROOT --write      puts that diagram into ARCHITECTURE.md
"""
import pathlib
import re
import sys

# Room -> rooms whose headers it may include. `services` may use every room.
ALLOWED = {
    "messages": set(),
    "rotation": set(),
    "settings": set(),
    "configuration": {"settings"},
    "geometry": {"messages", "rotation"},
    "fdi": {"geometry", "messages", "rotation", "settings"},
    "design": {"fdi", "geometry", "messages"},
    "attitude": {"geometry", "messages", "rotation", "settings"},
    "voting": {"messages", "rotation", "settings"},
    "simulation": {"geometry", "messages", "settings"},
    "recording": {"messages"},
    "calibration": {"configuration", "fdi", "geometry", "messages", "recording", "rotation", "settings"},
    "diagnosis": {"fdi", "geometry", "messages", "recording", "rotation"},
    "bus": {"messages", "settings"},
    "security": {"bus", "messages"},
    "intake": {"messages"},
    "runtime": {"bus", "intake", "messages"},
    "system": {"attitude", "bus", "calibration", "configuration", "fdi", "geometry", "messages", "rotation", "runtime", "security", "settings", "simulation", "voting"},
    "evaluation": {"attitude", "bus", "geometry", "messages", "rotation", "system"},
}
EIGEN = {"rotation", "geometry", "fdi", "design", "attitude", "voting", "simulation", "calibration", "diagnosis", "system"}
# Rooms within rooms: folder -> folders beside it whose headers it may include.
INNER = {
    "services/quorient": {
        "cli": set(),
        "report": {"cli"},
        "launch": {"cli", "report"},
        "orders": {"cli"},
        "record": {"cli", "report"},
        "replay": {"cli", "report"},
        "vessel": {"cli"},
        "verbs": {"cli", "launch", "orders", "record", "replay", "report", "vessel"},
    },
    "common/fdi/src": {
        "single_frame": set(),
        "four_axes": {"single_frame"},
        "arrays": {"single_frame"},
        "field": {"arrays"},
        "skewed": {"field"},
        "observers": set(),
        "verdict": {"observers"},
    },
}
# What the algorithm rooms must not know: clocks, threads, files, loggers.
PURE = {"rotation", "settings", "geometry", "fdi", "design", "attitude", "voting", "diagnosis", "intake"}
IMPURE_HEADERS = re.compile(r"<(thread|mutex|condition_variable|future|chrono|fstream|filesystem|atomic|spdlog/.*)>")
VENDOR = {
    "fastdds": re.compile(r"<(fastdds|fastrtps|fastcdr)/"),
    "cyclonedds": re.compile(r"<dds/"),
    "iceoryx": re.compile(r"<iceoryx"),
}
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"][^>"]+[>"])')


def includes(path):
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found.group(1)


def problems(root):
    for path in sorted((root / "common").rglob("*.?pp")) + sorted((root / "services").rglob("*.?pp")):
        parts = path.relative_to(root).parts
        room = parts[1] if parts[0] == "common" else None
        test = "test" in parts or "bench" in parts
        for number, include in includes(path):
            where = f"{path.relative_to(root)}:{number}"
            used = re.match(r'"quorient/(\w+)/', include)
            if room and used and used.group(1) not in ALLOWED.get(room, set()) | {room} and not test:
                yield f"{where}: {room} must not import {used.group(1)}"
            if room and room not in EIGEN and include.startswith("<Eigen/") and not test:
                yield f"{where}: {room} must not see Eigen"
            if room in PURE and IMPURE_HEADERS.match(include) and not test:
                yield f"{where}: {room} must know no clock, thread, file or logger ({include})"
            for vendor, pattern in VENDOR.items():
                if pattern.match(include) and f"bus/{vendor}/" not in str(path.relative_to(root)):
                    yield f"{where}: {vendor}'s headers stay in common/bus/{vendor}"
        yield from inner_problems(root, path)
        if room and room not in ALLOWED:
            yield f"{path.relative_to(root)}: room {room} has no stated direction; add it to {pathlib.Path(__file__).name}"


def inner_problems(root, path):
    """Includes between the folders of one room that its order does not allow."""
    for house, allowed in INNER.items():
        place = path.relative_to(root).as_posix()
        inner = place.removeprefix(house + "/").split("/")[0] if place.startswith(house + "/") else None
        if inner not in allowed:
            continue
        for number, include in includes(path):
            used = re.match(r'"(\w+)/', include)
            if used and used.group(1) in allowed and used.group(1) not in allowed[inner] | {inner}:
                yield f"{place}:{number}: {house}/{inner} must not import {used.group(1)}"


def upward_references(root):
    """A room that explains itself by what stands above it cannot be understood alone."""
    for path in sorted((root / "common").rglob("README.md")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if "services/" in line:
                yield f"{path.relative_to(root)}:{number}: a room's README must not point up into services/"


def edges(root):
    """Room -> the rooms whose headers it really includes."""
    found = {room: set() for room in ALLOWED}
    for path in (root / "common").rglob("*.?pp"):
        room = path.relative_to(root).parts[1]
        if "test" in path.parts or "bench" in path.parts:
            continue
        for _, include in includes(path):
            used = re.match(r'"quorient/(\w+)/', include)
            if used and used.group(1) != room:
                found.setdefault(room, set()).add(used.group(1))
    return found


def reachable(direct, room):
    seen, waiting = set(), list(direct[room])
    while waiting:
        next_room = waiting.pop()
        if next_room not in seen:
            seen.add(next_room)
            waiting += direct.get(next_room, ())
    return seen


def picture(root):
    """@returns the rooms as a mermaid diagram; an arrow that follows from others is left out."""
    direct = edges(root)
    lines = ["```mermaid", "flowchart BT"]
    for room in ALLOWED:
        implied = set().union(*(reachable(direct, used) for used in direct[room]))
        lines += [f"    {room} --> {used}" for used in sorted(direct[room] - implied)]
    return "\n".join(lines + ["```"])


def with_picture(root):
    """@returns ARCHITECTURE.md with the picture of today's imports in its place."""
    page = (root / "ARCHITECTURE.md").read_text()
    return re.sub(r"```mermaid\nflowchart BT\n.*?```", lambda _: picture(root), page, count=1, flags=re.S)


def main():
    root = pathlib.Path(sys.argv[1])
    if "--picture" in sys.argv:
        print(picture(root))
        return 0
    if "--write" in sys.argv:
        (root / "ARCHITECTURE.md").write_text(with_picture(root))
        return 0
    found = list(problems(root)) + list(upward_references(root))
    print("\n".join(found))
    print(f"{len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
