#!/usr/bin/env python3
"""Writes TYPES.md, the wire contract field by field, from the IDL, the codes and samples that `quorient echo` printed.

usage: contract.py            exit 1 and one line per disagreement between IDL, README.md, TYPES.md and the samples
       contract.py --write [--samples FOLDER]
                              rewrites TYPES.md; FOLDER holds one file per topic, e.g. frame.txt, as printed by
                              `quorient echo frame --count 1`; without it the samples of the present TYPES.md stay
"""
import argparse
import json
import pathlib
import re
import sys
from dataclasses import dataclass

HERE = pathlib.Path(__file__).resolve().parent
IDL = HERE / "quorient_msgs.idl"
README = HERE / "README.md"
TYPES = HERE / "TYPES.md"
CODES = HERE.parent / "common/messages/include/quorient/messages/codes.hpp"

SIZES = {"double": 8, "long long": 8, "unsigned long long": 8, "unsigned long": 4, "octet": 1, "char": 1}
LIMITS = {"octet": (0, 2**8), "unsigned long": (0, 2**32), "unsigned long long": (0, 2**64), "long long": (-(2**63), 2**63)}


@dataclass
class Field:
    name: str
    type: str
    dimensions: tuple
    key: bool
    comment: str

    @property
    def size(self):
        count = 1
        for dimension in self.dimensions:
            count *= dimension
        return SIZES[self.type] * count

    @property
    def shown_type(self):
        return self.type + "".join(f"[{dimension}]" for dimension in self.dimensions)


@dataclass
class Struct:
    name: str
    about: str
    fields: list


def parse_idl(text):
    """@returns the structs in order. Reads the plain subset of the language that the contract allows itself, and nothing else."""
    structs, about, fields = [], [], None
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if line.startswith("//") and fields is None:
            about.append(line[2:].strip())
        elif found := re.fullmatch(r"@final struct (\w+) \{", line):
            fields = []
            structs.append(Struct(found.group(1), " ".join(about), fields))
        elif line == "};":
            about, fields = [], None
        elif fields is not None and line:
            found = re.fullmatch(r"(@key )?([a-z ]+?) (\w+)((?:\[\d+\])*);(?:  // (.*))?", line)
            if not found or found.group(2) not in SIZES:
                raise SystemExit(f"{IDL.name}:{number}: not a plain member: {line}")
            dimensions = tuple(int(d) for d in re.findall(r"\d+", found.group(4)))
            fields.append(Field(found.group(3), found.group(2), dimensions, bool(found.group(1)), found.group(5) or ""))
        elif not line:
            about = []
    return structs


def parse_codes(text):
    """@returns {enum: [(name, value)]} of codes.hpp."""
    codes = {}
    for name, body in re.findall(r"enum class (\w+) : std::uint8_t \{(.*?)\};", text, re.S):
        codes[name] = [(word, int(value)) for word, value in re.findall(r"(\w+) = (\d+)", re.sub(r"//.*", "", body))]
    return codes


def parse_topics(readme):
    """@returns {topic: type} of the README's table."""
    return dict(re.findall(r"^\| `(quorient/\w+)` \| (\w+) \|", readme, re.M))


def parse_samples(types):
    return dict(re.findall(r"^\$ quorient echo (\w+) --count 1\n(.*?)^---\n", types, re.S | re.M))


def layout_problems(struct):
    """A plain type has no hidden padding: every member at a multiple of its size, the whole a multiple of the largest."""
    place = 0
    for field in struct.fields:
        if place % SIZES[field.type]:
            yield f"{struct.name}.{field.name}: at {place}, not a multiple of {SIZES[field.type]}: hidden padding"
        place += field.size
    if place % max(SIZES[field.type] for field in struct.fields):
        yield f"{struct.name}: {place} bytes: hidden padding at the end"


def comment_problems(struct, codes):
    if not struct.about:
        yield f"{struct.name}: no comment says what it is"
    for field in struct.fields:
        where = f"{struct.name}.{field.name}"
        if not field.comment:
            yield f"{where}: no comment"
        elif (field.type == "double" or field.name.endswith("_ns")) and not field.comment.startswith("["):
            yield f"{where}: its comment does not begin with the unit in brackets"
        for word in re.findall(r"\b(?:[A-Z][a-z]+){2,}\b", field.comment):
            known = word in codes or word in ("ClusterDescription", "FaultVerdict", "FaultDiagnosis", "FaultCommand")
            if not known:
                yield f"{where}: names {word}, which is neither a code nor a type"


def parts_of(value, dimensions):
    """@returns the elements of a nested list of these dimensions; None where it has others."""
    if not dimensions:
        return None if isinstance(value, list) else [value]
    if not isinstance(value, list) or len(value) != dimensions[0]:
        return None
    parts = [parts_of(item, dimensions[1:]) for item in value]
    return None if None in parts else [part for list_ in parts for part in list_]


def value_matches(value, field):
    if field.type == "char":
        return isinstance(value, str) and len(value) <= field.dimensions[-1]
    if field.type == "double":
        return value is None or isinstance(value, (int, float))
    if value is None:
        return field.type == "unsigned long long"  # the largest sequence number, "never"
    low, high = LIMITS[field.type]
    return isinstance(value, int) and low <= value < high


def without_word(text):
    """`4 (ISOLATED)` -> `4`: a code is printed with its word."""
    return re.sub(r"^(\d+) \(.+\)$", r"\1", text)


def sample_problems(topic, struct, sample):
    shown = [line.split(": ", 1) for line in sample.splitlines()]
    names = [name for name, _ in shown]
    expected = [field.name for field in struct.fields if field.name != "padding"]
    if names != expected:
        yield f"sample of {topic}: fields {names}, the IDL has {expected}"
        return
    fields = {field.name: field for field in struct.fields}
    for name, text in shown:
        field = fields[name]
        parts = parts_of(json.loads(without_word(text)), field.dimensions[:-1] if field.type == "char" else field.dimensions)
        if parts is None or not all(value_matches(part, field) for part in parts):
            yield f"sample of {topic}: {name} is {text}, the IDL has {field.shown_type}"


def types_page(structs, codes, topics, samples):
    page = [
        "# The wire contract, field by field",
        "",
        "Generated by `idl/contract.py --write` from `quorient_msgs.idl` and `codes.hpp`; a test fails where they disagree. Units are in",
        "brackets, `[a; b]` for gyros and accelerometers; body frame B, reference frame R. Octets and integers without a unit are counts, ids,",
        "masks or codes. Each sample is what `quorient echo` printed; padding is left out there.",
    ]
    for topic, name in topics.items():
        struct = next(struct for struct in structs if struct.name == name)
        short = topic.split("/")[1]
        page += ["", f"## `{topic}`: {name}", "", struct.about, "", "| field | type | unit, frame, meaning |", "|---|---|---|"]
        for field in struct.fields:
            page.append(f"| {'**' + field.name + '** (key)' if field.key else field.name} | {field.shown_type} | {field.comment} |")
        page += ["", f"{sum(field.size for field in struct.fields)} bytes, in memory and in CDR.", "", "```"]
        page += [f"$ quorient echo {short} --count 1", samples.get(short, "").rstrip("\n"), "---", "```"]
    page += ["", "## Codes", "", "| code | values |", "|---|---|"]
    for name, values in codes.items():
        page.append(f"| {name} | " + ", ".join(f"{value} {word.upper()}" for word, value in values) + " |")
    return "\n".join(page) + "\n"


def problems():
    structs, codes = parse_idl(IDL.read_text()), parse_codes(CODES.read_text())
    topics, written = parse_topics(README.read_text()), TYPES.read_text()
    samples = parse_samples(written)
    for struct in structs:
        yield from layout_problems(struct)
        yield from comment_problems(struct, codes)
        if struct.name not in topics.values():
            yield f"{README.name}: no topic of {struct.name}"
    by_name = {struct.name: struct for struct in structs}
    for topic, name in topics.items():
        if name not in by_name:
            yield f"{README.name}: {topic} has type {name}, which the IDL has not"
            continue
        sample = samples.get(topic.split("/")[1])
        if not sample:
            yield f"{TYPES.name}: no sample of {topic}"
        else:
            yield from sample_problems(topic, by_name[name], sample)
    if set(topics.values()) <= set(by_name) and written != types_page(structs, codes, topics, samples):
        yield f"{TYPES.name} is not what the IDL and the codes say: run idl/contract.py --write"


def write(samples_folder):
    samples = parse_samples(TYPES.read_text()) if TYPES.exists() else {}
    if samples_folder:
        for file in sorted(samples_folder.glob("*.txt")):
            samples[file.stem] = file.read_text().removesuffix("---\n")
    TYPES.write_text(types_page(parse_idl(IDL.read_text()), parse_codes(CODES.read_text()), parse_topics(README.read_text()), samples))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--samples", type=pathlib.Path)
    options = parser.parse_args()
    if options.write:
        write(options.samples)
    found = list(problems())
    print("\n".join(found), file=sys.stderr, end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
