#!/usr/bin/env python3
"""The programs that are installed have what Debian's hardening flags put into them; a program without those flags is recognised."""
import json
import os
import pathlib
import platform
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("QUORIENT_BUILD", ROOT / "build/release"))
COMPILER = os.environ.get("QUORIENT_COMPILER", "c++")
PROGRAMS = ("quorient", "quorient-sensor", "quorient-fdi", "quorient-attitude", "quorient-voter", "quorient-monitor", "quorient-run")
FLAGS = ("-fstack-protector-strong", "-fstack-clash-protection", "-D_FORTIFY_SOURCE=2", "-Wformat", "-Werror=format-security")
OPEN_FLAGS = ("-no-pie", "-fno-pie", "-fno-stack-protector", "-U_FORTIFY_SOURCE", "-Wl,-z,norelro,-z,lazy,-z,execstack", "-fcf-protection=none")
X86_64 = platform.machine() == "x86_64"
ENDBR64 = bytes.fromhex("f30f1efa")  # where an indirect branch may land
SOURCE = """
#include <cstdio>
#include <cstring>
int main(int count, char** words) { char name[64]; std::strcpy(name, words[count - 1]); std::puts(name); return 0; }
"""


def readelf(program, *options):
    return subprocess.run(["readelf", "-W", *options, str(program)], check=True, capture_output=True, text=True, timeout=60).stdout


def first_bytes(program, symbol):
    """The first bytes of a function; the segments of these programs begin where the file says."""
    place = re.search(rf"^\s*\d+: ([0-9a-f]+)\s+\d+ FUNC\s.*\s{symbol}$", readelf(program, "-s"), re.MULTILINE)
    for offset, address, size in re.findall(r"^\s*LOAD\s+(0x\w+) (0x\w+) 0x\w+ (0x\w+)", readelf(program, "-l"), re.MULTILINE):
        inside = int(place[1], 16) - int(address, 16)
        if 0 <= inside < int(size, 16):
            with open(program, "rb") as file:
                file.seek(int(offset, 16) + inside)
                return file.read(4)
    raise ValueError(f"{program}: {symbol} is in no segment")


def sources_of(file):
    """A file, or those that it stands for where several are compiled as one."""
    return re.findall(r'^#include "(.*)"', pathlib.Path(file).read_text(), re.MULTILINE) if "/Unity/" in file else [file]


def lacks(program):
    """Yields what a program lacks."""
    segments, dynamic, imports = readelf(program, "-l"), readelf(program, "-d"), readelf(program, "--dyn-syms")
    if not re.search(r"FLAGS_1.*PIE", dynamic):
        yield "a position that can vary"
    if "GNU_RELRO" not in segments:
        yield "read-only relocations"
    if not re.search(r"\(FLAGS(_1)?\).*NOW", dynamic):
        yield "binding at the start"
    if not re.search(r"GNU_STACK.* RW ", segments):
        yield "a stack that cannot be executed"
    if "__stack_chk_fail" not in imports:
        yield "guarded stacks"
    if not re.search(r"__(?!stack)\w+_chk@", imports):
        yield "checked copies"
    if X86_64 and first_bytes(program, "main") != ENDBR64:
        yield "marked targets of branches"


@unittest.skipUnless(shutil.which("readelf"), "binutils is not installed")
class Hardening(unittest.TestCase):
    @unittest.skipUnless((BUILD / "bin/quorient-voter").exists(), f"nothing is built in {BUILD}")
    def test_every_program_has_it(self):
        for program in PROGRAMS:
            self.assertEqual(list(lacks(BUILD / "bin" / program)), [], program)

    @unittest.skipUnless((BUILD / "compile_commands.json").exists(), f"{BUILD} is not configured")
    def test_every_source_that_is_installed_is_compiled_with_the_flags(self):
        commands = json.loads((BUILD / "compile_commands.json").read_text())
        compiled = [(source, entry["command"]) for entry in commands for source in sources_of(entry["file"])]
        installed = [one for one in compiled if re.search(r"/(common|services)/(?!.*/?(test|bench)/)", one[0])]
        self.assertGreater(len(installed), 200)
        for source, command in installed:
            self.assertEqual([flag for flag in FLAGS if flag not in command], [], source)

    def compiled_with(self, flags):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        source = pathlib.Path(folder, "program.cpp")
        source.write_text(SOURCE)
        subprocess.run([COMPILER, "-O2", *flags, str(source), "-o", f"{folder}/program"], check=True, timeout=100)
        return f"{folder}/program"

    def test_a_program_without_them_is_recognised(self):
        self.assertEqual(len(list(lacks(self.compiled_with(OPEN_FLAGS)))), 7 if X86_64 else 6)

    def test_a_program_with_them_lacks_nothing(self):
        more = ("-fcf-protection",) if X86_64 else ()
        self.assertEqual(list(lacks(self.compiled_with((*FLAGS, *more, "-fPIC", "-Wl,-z,relro,-z,now", "-pie")))), [])


if __name__ == "__main__":
    unittest.main()
