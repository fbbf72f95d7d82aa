#!/usr/bin/env python3
"""The latency measurement's JSON as markdown. Alone: table.py RESULTS.json writes the table to stdout."""
import json
import pathlib
import statistics
import sys

QUANTILES = ("p50", "p90", "p99", "p99.9", "max")
WHO = {"ours": "ours", "floor": "floor", "floor_that_waits": "floor that waits", "lanes": "lanes composed", "all_but_sensor": "all but the sensor composed"}


def median(values):
    values = [value for value in values if value is not None]
    return statistics.median(values) if values else None


def number(value, digits=0):
    return "-" if value is None else f"{value:.{digits}f}"


def hop(report, name, quantile):
    found = report["hops"].get(name)
    return found[quantile] if found else None


NO_FLOOR = 0.01  # share of its frames; a floor that loses more is overrun, and what it is a floor of as well


def lost(report):
    """Frames that were sent and that no voter gave out, at the end of the run too."""
    return max(0, report["expected"] - report["never_sent"] - report["frames"])


def rows(header, body):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return lines + ["| " + " | ".join(row) + " |" for row in body] + [""]


def name_of(case):
    parts = [case["transport"], f"{case['rate_hz']} Hz"]
    for key in ("lanes", "axes", "units"):
        if key in case:
            parts.append(f"{case[key]} {key if case[key] != 1 else key.rstrip('s')}")
    if case.get("own_domains"):
        parts.append("a domain each (latency of the first)")
    if case.get("spin"):
        parts.append("spinning")
    return ", ".join(parts)


def over_rounds(result, who, value):
    return median([value(entry[who]) for entry in result["rounds"] if who in entry])


def ratio(result, floor, quantile="p50", who="ours"):
    """Ours to a floor of the same round; the median of the rounds."""
    return ratio_of(result, who, floor, lambda report: hop(report, "sensor_to_voted", quantile))


def ratio_of(result, above, below, value):
    """A figure of one graph to that of another of the same round; the median of the rounds."""
    ratios = []
    for entry in result["rounds"]:
        if above not in entry or below not in entry:
            continue
        a, b = value(entry[above]), value(entry[below])
        if a and b:
            ratios.append(a / b)
    return median(ratios)


def usage(report, key, combine):
    values = [process[key] for process in report["processes"].values()]
    return combine(values) if values else None


def of_pings(result, path, quantile):
    return median([entry[path].get(quantile) for entry in result["rounds"]])


def ping_ratio(result, quantile):
    return median([entry["bus"][quantile] / entry["vendor"][quantile] for entry in result["rounds"] if "p50" in entry["bus"] and "p50" in entry["vendor"]])


def ping_section(results):
    lines = ["## One hop", "", "Half a round trip of one SensorFrame between two processes at 1 kHz, four paths in turns of 20, medians of the rounds: p50 / p99 [us].", ""]
    body = []
    for result in results:
        cells = [f"{number(of_pings(result, path, 'p50'))} / {number(of_pings(result, path, 'p99'))}" for path in ("bus", "vendor", "futex", "udp socket")]
        name = f"{result['dds']}, {result['transport']}" + (", spinning" if result["spin"] else "")
        body.append([name, *cells, number(ping_ratio(result, "p50"), 3), number(ping_ratio(result, "p99"), 2), number(of_pings(result, "bus", "lost"))])
    return lines + rows(["path", "bus", "vendor's API", "futex", "UDP socket", "bus / vendor p50", "p99", "lost"], body)


def pipeline_rows(results):
    body = []
    for result in results:
        for who, title in WHO.items():
            if not any(who in entry for entry in result["rounds"]):
                continue
            value = lambda quantile: number(over_rounds(result, who, lambda r: hop(r, "sensor_to_voted", quantile)))  # noqa: E731
            counts = [number(over_rounds(result, who, count)) for count in (lost, lambda r: r["duplicates"], lambda r: r["late"])]
            ratios = [number(ratio(result, floor, who=who), 2) if who not in ("floor", "floor_that_waits") else "" for floor in ("floor", "floor_that_waits")]
            body.append([
                name_of(result["case"]), title, *map(value, QUANTILES), *counts,
                number(over_rounds(result, who, lambda r: usage(r, "cpu_percent", sum))),
                number(over_rounds(result, who, lambda r: usage(r, "rss_mib", max)), 1), *ratios,
            ])
    return rows(["case", "graph", *QUANTILES, "lost", "duplicate", "late", "CPU [%]", "largest RSS [MiB]", "p50 / floor", "p50 / floor that waits"], body)


HOPS = ("sensor_to_detector", "detector", "detector_to_integrator", "integrator", "integrator_to_voter", "voter", "sensor_to_verdict", "sensor_to_attitude", "sensor_to_voted")


def hop_rows(results):
    body = []
    for result in results:
        for name in HOPS:
            values = [over_rounds(result, "ours", lambda r, q=q: hop(r, name, q)) for q in QUANTILES]
            floor = over_rounds(result, "floor", lambda r: hop(r, name, "p50"))
            body.append([name_of(result["case"]) if name == HOPS[0] else "", name.replace("_", " "), *(number(value, 1) for value in values), number(floor, 1)])
    return rows(["case", "hop", *QUANTILES, "floor's p50"], body)


def process_rows(result):
    names = next(entry["ours"]["processes"] for entry in result["rounds"] if "ours" in entry)
    body = []
    for name in names:
        of = lambda who, key: number(over_rounds(result, who, lambda r: r["processes"].get(name, {}).get(key)), 1)  # noqa: E731
        body.append([name, of("ours", "cpu_percent"), of("ours", "rss_mib"), of("floor", "cpu_percent"), of("floor", "rss_mib")])
    return rows(["process", "CPU [%]", "RSS [MiB]", "floor's CPU [%]", "floor's RSS [MiB]"], body)


def transports_section(results):
    lines = [
        "## Pipelines by transport", "",
        "Sensor stamp to voted [us]: one sensor, three lanes, two voters, one probe. *Floor*: the same graph with empty algorithms on the vendor's API; its voters "
        "give out what any two lanes have answered. *Floor that waits*: the same, but a voter waits for its primary lane and a second one, an integrator for the "
        "frame and the verdict, as ours do.", "",
    ]
    lines += pipeline_rows(results) + ["### Hop by hop, ours [us]", ""] + hop_rows(results)
    for result in results:
        lines += [f"### Processes: {name_of(result['case'])}", ""] + process_rows(result)
    return lines


def sustained_section(results):
    lines = ["## Sustained", ""]
    for result in results:
        report = result["report"]
        lines += [
            f"{result['seconds']:.0f} s at {result['case']['rate_hz']} Hz, {result['case']['transport']}, three lanes, two voters: {lost(report)} of {report['expected']} "
            f"frames lost, {report['never_sent']} never sent (the machine kept the publisher waiting for more than four intervals), {report['late']} late, "
            f"p50 {number(hop(report, 'sensor_to_voted', 'p50'))} us, p99 {number(hop(report, 'sensor_to_voted', 'p99'))} us.", "",
        ]
        body = [
            [str(step["rate_hz"]), str(step["report"]["expected"]), str(lost(step["report"])), str(step["report"]["never_sent"]),
             number(hop(step["report"], "sensor_to_voted", "p50")), number(usage(step["report"], "cpu_percent", sum))] for step in result["ladder"]
        ]
        lines += rows(["rate [Hz]", "frames", "lost", "never sent", "p50 [us]", "CPU [%]"], body)
        held = [step["rate_hz"] for step in result["ladder"] if lost(step["report"]) + step["report"]["never_sent"] == 0]
        held += [result["case"]["rate_hz"]] if lost(report) + report["never_sent"] == 0 else []
        lines += [f"Highest rate at which every frame was sent and none lost: {max(held)} Hz." if held else "No frame lost: at none of these rates.", ""]
    return lines


def growth_section(results):
    return ["## Growth", "", "Sensor stamp to voted [us].", ""] + pipeline_rows(results) + hop_rows(results)


def composed_section(results):
    return ["## Composed", "", "Several services in one process (`compose` of the system file). *Ours*: a process for each.", ""] + pipeline_rows(results)


def spinning_section(results):
    return ["## Blocking and spinning", "", "One lane, one voter: four processes and the probe; spinning, the four never sleep.", ""] + pipeline_rows(results)


def find(results, **wanted):
    return next((result for result in results if all(result["case"].get(key) == value for key, value in wanted.items())), None)


def verdict(value, limit, digits=2):
    if value is None:
        return ["not measured", ""]
    return [number(value, digits), "met" if value <= limit else "**not met**"]


def ping_goals(results):
    for result in results:
        if result["spin"]:
            continue
        name = f"bus hop / vendor hop, {result['dds']}, {result['transport']}"
        yield [f"{name}: p50 <= 1.05", *verdict(ping_ratio(result, "p50"), 1.05, 3)]
        yield [f"{name}: p99 <= 1.2", *verdict(ping_ratio(result, "p99"), 1.2)]


MARGINS = {"p50": 1.15, "p99": 1.25}


def lost_by_floor(result):
    """@returns the share of its frames where the floor is overrun, and so no floor; otherwise None."""
    share = over_rounds(result, "floor", lambda r: lost(r) / max(r["expected"], 1))
    return share if share is not None and share > NO_FLOOR else None


def pipeline_goals(results):
    for result in results:
        for quantile, limit in MARGINS.items() if "floor" in result["rounds"][0] else ():
            row = [f"sensor -> voted / floor, {quantile}, {name_of(result['case'])}: <= {limit}", *verdict(ratio(result, "floor", quantile), limit)]
            row[1] += f" (to the floor that waits: {number(ratio(result, 'floor_that_waits', quantile), 2)})"
            if share := lost_by_floor(result):
                row[2] = f"no floor: it loses {100 * share:.0f} % of its frames"
            yield row
    for rate in (200, 1000):
        pair = [find(results, transport=f"{how}, Cyclone DDS", rate_hz=rate) for how in ("iceoryx", "UDP")]
        if all(pair):
            both = [[hop(entry["ours"], "sensor_to_voted", "p50") if "ours" in entry else None for entry in result["rounds"]] for result in pair]
            ratios = median([a / b for a, b in zip(*both) if a and b])
            yield [f"iceoryx / Cyclone DDS by UDP, p50, {rate} Hz: < 1", *verdict(ratios, 1)]


COMPOSED_GOALS = {"lanes": (0.8, 0.75), "all_but_sensor": (0.45, 0.45)}


def composed_goals(results):
    for result in results:
        for who, (latency, processor) in COMPOSED_GOALS.items():
            name = f"{WHO[who]}, {name_of(result['case'])}"
            yield [f"{name}: p50 / floor <= {latency}", *verdict(ratio(result, "floor", who=who), latency)]
            used = ratio_of(result, who, "ours", lambda report: usage(report, "cpu_percent", sum))
            yield [f"{name}: CPU / ours with a process for each <= {processor}", *verdict(used, processor)]


def growth_goals(results):
    result = find(results, axes=24)
    if result:
        compute = over_rounds(result, "ours", lambda r: hop(r, "detector", "p50") + hop(r, "integrator", "p50"))
        way = over_rounds(result, "ours", lambda r: hop(r, "sensor_to_attitude", "p50"))
        yield [f"detector + integrator ({number(compute, 1)} us) / their hops (sensor to attitude, {number(way)} us), p50, 24 axes: <= 0.05", *verdict(compute / way, 0.05, 3)]


def sustained_goals(results):
    for result in results:
        name = f"frames lost in {result['seconds']:.0f} s at {result['case']['rate_hz']} Hz, {result['case']['transport']}: 0"
        yield [name, *verdict(lost(result["report"]), 0, 0)]


def goals_section(results):
    body = []
    for name, goals in (("hops", ping_goals), ("transports", pipeline_goals), ("composed", composed_goals), ("growth", growth_goals), ("sustained", sustained_goals)):
        body += goals(results[name]) if name in results else []
    runs = [entry["ours"] for name in ("transports", "growth", "spinning") for result in results.get(name, []) for entry in result["rounds"] if "ours" in entry]
    if runs:
        body.append(["largest RSS of a service [MiB]: <= 48", *verdict(max(usage(run, "rss_mib", max) or 0 for run in runs), 48, 1)])
    return ["## Goals", ""] + rows(["goal", "here", ""], body)


SECTIONS = {"hops": ping_section, "transports": transports_section, "composed": composed_section, "sustained": sustained_section, "growth": growth_section, "spinning": spinning_section}


def markdown(results):
    machine = results["machine"]
    versions = ", ".join(f"{name} {value}" for name, value in machine["versions"].items())
    lines = [
        "# Latency", "", f"Made by `{machine['command']}` on {machine['date']}: {machine['processor']}, {machine['cores']} cores, Linux {machine['kernel']}, "
        f"{versions}; {machine['rounds']} rounds of {machine['seconds']} s each, nice {machine['nice']}, load {machine['load_before'][0]:.1f} at the start.", "",
        "What each number means: [README](../latency/README.md). Of rounds the median, of ratios the median of the rounds' ratios.", "",
    ]
    if results.get("skipped"):
        lines += ["**Left out, since the time was over:** " + "; ".join(results["skipped"]) + ".", ""]
    lines += goals_section(results)
    for name, section in SECTIONS.items():
        if name in results:
            lines += section(results[name])
    return "\n".join(lines)


if __name__ == "__main__":
    print(markdown(json.loads(pathlib.Path(sys.argv[1]).read_text())))
