#!/usr/bin/env python3
"""Runs the fuzz targets under libFuzzer from the corpora in the tree and prints a table of what they did and found.

Build first: cmake -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DQUORIENT_LIBFUZZER=ON
             -DQUORIENT_SANITIZE=address,fuzzer-no-link ..., then ninja fuzz_frames fuzz_votes fuzz_imus fuzz_decode
             fuzz_dataflash fuzz_ulog fuzz_csv fuzz_mcap fuzz_sqlite fuzz_logs fuzz_times fuzz_seeds
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

CORPUS = pathlib.Path(__file__).resolve().parent / "corpus"
LOGS = ("dataflash", "ulog", "csv", "mcap", "sqlite", "logs", "times")  # their corpora are made by fuzz_seeds
TARGETS = ("frames", "votes", "imus", "decode") + LOGS
LONGEST_RUN = {"frames": 2048, "votes": 2048, "imus": 2048} | dict.fromkeys(("decode",) + LOGS, 4096)
LONGEST_KEPT = {"frames": 200, "votes": 200, "imus": 1000, "decode": 4096}  # bytes; keeps the corpora small


def unpack(build, target, folder):
    """One file per line of the corpus, which is hexadecimal; or what the tests' writers make."""
    if target in LOGS:
        subprocess.run([build / "bin" / "fuzz_seeds", target, folder], check=True)
        return
    for number, line in enumerate((CORPUS / f"{target}.txt").read_text().split()):
        (folder / f"{number:04}").write_bytes(bytes.fromhex(line))


def keep(program, target, folder):
    """Writes a few short inputs that reach every edge that the short ones in the folder reach."""
    with tempfile.TemporaryDirectory() as merged, tempfile.TemporaryDirectory() as fewest:
        for how, into, source in ("-merge=1", merged, str(folder)), ("-set_cover_merge=1", fewest, merged):
            subprocess.run([program, how, "-use_counters=0", f"-max_len={LONGEST_KEPT[target]}", into, source],
                           check=True, stderr=subprocess.DEVNULL)
        inputs = sorted((path.read_bytes() for path in pathlib.Path(fewest).iterdir()), key=lambda data: (len(data), data))
    (CORPUS / f"{target}.txt").write_text("".join(data.hex() + "\n" for data in inputs))


def number(pattern, text):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else 0


def run(program, target, seconds, folder):
    """@returns the row of the table, and whether nothing was found."""
    findings = pathlib.Path(tempfile.mkdtemp(prefix=f"fuzz_{target}."))
    done = subprocess.run([program, f"-max_total_time={seconds}", "-print_final_stats=1", f"-max_len={LONGEST_RUN[target]}",
                           f"-artifact_prefix={findings}/", str(folder)], stderr=subprocess.PIPE, text=True, errors="replace")
    text = done.stderr
    artifacts = sorted(path.name for path in findings.iterdir())
    sound = done.returncode == 0 and not artifacts
    if sound:
        findings.rmdir()
    else:
        print(f"{target}: exit code {done.returncode}, see {findings}\n{text[-4000:]}", file=sys.stderr)
    row = (target, number(r"number_of_executed_units: (\d+)", text), number(r"average_exec_per_sec: +(\d+)", text),
           number(r"cov: (\d+)", text), number(r"\((\d+) inline 8-bit counters", text), number(r"ft: (\d+)", text),
           number(r"peak_rss_mb: +(\d+)", text), "nothing" if sound else " ".join(artifacts) or "see above")
    return row, sound


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="the build folder with bin/fuzz_...")
    parser.add_argument("targets", nargs="*", default=TARGETS, help=f"of {', '.join(TARGETS)}; default all")
    parser.add_argument("--seconds", type=int, default=60, help="for each target (default 60)")
    parser.add_argument("--keep", action="store_true", help="write the corpora anew with what reaches more")
    arguments = parser.parse_args()
    print("| target | executions | per second | edges reached | of | features | peak memory, MiB | found |\n|---|---|---|---|---|---|---|---|")
    all_sound = True
    for target in arguments.targets:
        program = str(arguments.build / "bin" / f"fuzz_{target}")
        with tempfile.TemporaryDirectory() as folder:
            unpack(arguments.build, target, pathlib.Path(folder))
            row, sound = run(program, target, arguments.seconds, folder)
            if arguments.keep and target not in LOGS:
                keep(program, target, folder)
        print("| " + " | ".join(str(cell) for cell in row) + " |", flush=True)
        all_sound = all_sound and sound
    sys.exit(0 if all_sound else 1)


if __name__ == "__main__":
    main()
