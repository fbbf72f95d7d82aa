"""Foxglove's own libraries for tests, from npm: package.json beside this file names them.

They are installed once, into build/node. $QUORIENT_NODE_PACKAGES names another folder, where they may lie already. Where they cannot be had, the
tests that need them are skipped with the reason.
"""
import functools
import json
import os
import pathlib
import shutil
import subprocess
import unittest

from integration_tests.harness.processes import ROOT

LIST = pathlib.Path(__file__).with_name("package.json")
FOLDER = pathlib.Path(os.environ.get("QUORIENT_NODE_PACKAGES", ROOT / "build/node"))
MODULES = FOLDER / "node_modules"


def node_modules():
    """@returns the folder for $NODE_PATH. Raises SkipTest with the reason where a package is missing and cannot be installed."""
    if reason := why_missing():
        raise unittest.SkipTest(reason)
    return MODULES


def missing():
    return [name for name in json.loads(LIST.read_text())["dependencies"] if not (MODULES / name / "package.json").is_file()]


@functools.cache
def why_missing():
    """The reason why the packages cannot be used, or None."""
    if not shutil.which("node"):
        return "node is not installed"
    if not missing():
        return None
    if not shutil.which("npm"):
        return "npm is not installed"
    FOLDER.mkdir(parents=True, exist_ok=True)
    shutil.copy(LIST, FOLDER)
    command = ["npm", "install", "--no-audit", "--no-fund", "--fetch-retries=0", "--prefix", FOLDER]
    try:
        ended = subprocess.run(command, capture_output=True, text=True, timeout=90)
    except subprocess.TimeoutExpired:
        return "npm gave no packages within 90 s"
    if not missing():
        return None
    return f"npm gave no {', '.join(missing())}: {(ended.stderr.strip() or 'no reason given').splitlines()[0]}"


def run_script(script, folder, *arguments, timeout=120):
    """Runs a script of Node and its neighbours in `folder`, where the packages are found. @returns what it printed."""
    modules = folder / "node_modules"
    if not modules.exists():
        modules.symlink_to(node_modules())
    for file in script.parent.glob("*.mjs"):
        shutil.copy(file, folder)
    ended = subprocess.run(["node", folder / script.name, *map(str, arguments)], capture_output=True, text=True, timeout=timeout)
    if ended.returncode != 0:
        raise AssertionError(ended.stderr)
    return ended.stdout
