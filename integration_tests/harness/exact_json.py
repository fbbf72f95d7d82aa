"""JSON as `quorient` prints it: whole numbers that a double cannot hold are strings there, and numbers again here."""
import json
import re

LARGEST_EXACT = 2**53
WHOLE = re.compile(r"-?[0-9]{16,20}")


def number(value):
    if isinstance(value, str) and WHOLE.fullmatch(value) and abs(int(value)) > LARGEST_EXACT:
        return int(value)
    if isinstance(value, list):
        return [number(item) for item in value]
    return value


def loads(text):
    return json.loads(text, object_hook=lambda fields: {key: number(value) for key, value in fields.items()})


def objects(log):
    """The objects in a file that takes both outputs of a running `echo --json`. What it prints for its user meanwhile and a line half written are no objects."""
    return [loads(line) for line in log.read_text().split("\n")[:-1] if line.startswith("{")]
