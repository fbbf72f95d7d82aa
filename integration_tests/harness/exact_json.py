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
