"""The Debian release of this machine, and what its DDS libraries cannot do."""
import pathlib


def own_release():
    words = dict(line.split("=", 1) for line in pathlib.Path("/etc/os-release").read_text().splitlines() if "=" in line)
    return words.get("VERSION_CODENAME", "").strip('"')


# Why the vendors exchange nothing under security here; None where they do.
NO_SECURED_PAIRS = "under security Fast DDS 3 exchanges nothing with Cyclone DDS: KNOWN_ISSUES.md" if own_release() == "trixie" else None
SECURED_VENDORS = ("cyclonedds",) if NO_SECURED_PAIRS else ("cyclonedds", "fastdds")
