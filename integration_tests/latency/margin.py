"""Several runs of run.py beside each other: how far ours lies above the floor at different hours.

    python3 -m integration_tests.latency.margin RUN.json RUN.json RUN.json      # of `run.py --only transports`; the table goes to standard output
"""
import json
import pathlib
import sys

from integration_tests.latency import graphs, table

CASES = [{"transport": name, "rate_hz": rate} for rate in (200, 1000) for name, (_, floor) in graphs.TRANSPORTS.items() if floor]


def held(values, limit):
    return "met" if all(value is not None and value <= limit for value in values) else "**not met**"


def row(found):
    """One pipeline of all runs: its ratios, and whether each run meets the bound."""
    cells = [table.name_of(found[0]["case"])]
    for quantile, limit in table.MARGINS.items():
        values = [table.ratio(result, "floor", quantile) for result in found]
        cells += [", ".join(table.number(value, 2) for value in values), held(values, limit)]
    cells.append(", ".join(table.number(table.ratio(result, "floor_that_waits"), 2) for result in found))
    return cells + ["in some run" if any(table.lost_by_floor(result) for result in found) else "no"]


def read(name):
    """A run's results; ends the program where they are none of `run.py --only transports`."""
    try:
        results = json.loads(pathlib.Path(name).read_text())
        cases = [result["case"] for result in results["transports"]]
    except (OSError, ValueError, KeyError, TypeError) as problem:
        sys.exit(f"{name}: {problem!r}; state the JSON of `run.py --only transports`")
    if missing := [table.name_of(case) for case in CASES if case not in cases]:
        sys.exit(f"{name}: no {'; '.join(missing)}; run it again with a larger --limit")
    return results


def main():
    runs = [read(name) for name in sys.argv[1:]]
    if not runs:
        sys.exit(__doc__)
    for run in runs:
        about = run["machine"]
        print(f"* {about['date']} {about['time_utc']} UTC: {about['rounds']} rounds of {about['seconds']} s, load {about['load_before'][0]:.1f} at the start")
    print()
    body = [row([table.find(run["transports"], **case) for run in runs]) for case in CASES]
    bounds = [text for quantile, limit in table.MARGINS.items() for text in (f"{quantile} / floor", f"<= {limit} in each run")]
    print("\n".join(table.rows(["pipeline", *bounds, "p50 / floor that waits", "floor overrun"], body)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
