#!/usr/bin/env python3
"""Writes a program's manual page, compressed, from its own --help and that of its verbs: manual_page.py PROGRAM OUTPUT.gz

manual_page.py QUORIENT OUTPUT.gz system-file: the page of the system file, from `quorient check --key all`
"""
import gzip
import pathlib
import re
import subprocess
import sys


def helped(program, *verbs):
    """What --help prints, by the program's name in place of where it was built."""
    result = subprocess.run([program.name, *verbs, "--help"], executable=program, capture_output=True, text=True, check=True, timeout=30)
    return result.stdout.strip()


def version(program):
    words = subprocess.run([program, "--version"], capture_output=True, text=True, check=True, timeout=30).stdout.split()
    return words[-1]


def escaped(text):
    """As roff prints it unchanged."""
    lines = text.replace("\\", "\\e").replace("-", "\\-").splitlines()
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in lines)


def verbs_of(text):
    listed = re.search(r"^Subcommands:\n((?:  .*\n?)+)", text, re.MULTILINE)
    return re.findall(r"^  (\w+) ", listed[1], re.MULTILINE) if listed else []


def page(program):
    text = helped(program)
    what = text.splitlines()[0].rstrip(".").removeprefix("Quorient: ")
    parts = [f'.TH {program.name.upper()} 1 "" "quorient {version(program)}" "User Commands"', ".SH NAME",
             f"{escaped(program.name)} \\- {escaped(what[0].lower() + what[1:])}", ".SH DESCRIPTION", ".nf", escaped(text), ".fi"]
    for verb in verbs_of(text):
        parts += [f".SH {verb.upper()}", ".nf", escaped(helped(program, verb)), ".fi"]
    parts += [".SH SEE ALSO", "/usr/share/quorient holds example system files."]
    return "\n".join(parts) + "\n"


def system_file_page(program):
    keys = subprocess.run([program, "check", "--key", "all"], capture_output=True, text=True, check=True, timeout=30).stdout
    return "\n".join([f'.TH QUORIENT\\-SYSTEM 5 "" "quorient {version(program)}" "File Formats"', ".SH NAME",
                      "quorient\\-system \\- the system file of quorient", ".SH DESCRIPTION", ".nf", escaped(keys.strip()), ".fi", ".SH SEE ALSO",
                      "quorient(1). /usr/share/quorient holds example system files."]) + "\n"


def main():
    program, output = map(pathlib.Path, sys.argv[1:3])
    of_system_file = sys.argv[3:] == ["system-file"]
    # Without name and time, so that the same program gives the same file.
    with open(output, "wb") as file, gzip.GzipFile(filename="", mode="wb", compresslevel=9, fileobj=file, mtime=0) as packed:
        packed.write((system_file_page if of_system_file else page)(program.resolve()).encode())


if __name__ == "__main__":
    main()
