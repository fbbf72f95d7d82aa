"""The compose file of the secured system: each container sees its own keys alone, as read-only files, and nothing of the authority."""
import copy
import io
import os
import pathlib
import re
import shutil
import subprocess
import tarfile
import tempfile
import unittest

from integration_tests.containers import private_keys
from integration_tests.harness.processes import BIN, CONFIGURATIONS, ROOT

try:
    import yaml
except ImportError:
    yaml = None

COMPOSE_FILE = ROOT / "deploy/compose.secured.yaml"
SYSTEM_FILE = CONFIGURATIONS / "compose.secured.yaml"
KEYS = "/etc/quorient/keys"


def config(environment):
    command = ["docker-compose", "-f", str(COMPOSE_FILE), "config"]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)


def check(keys):
    command = [str(BIN / "quorient"), "check", str(SYSTEM_FILE), "--set", f"security.directory={keys}"]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def resolved(keys):
    """The file as docker-compose understands it."""
    done = config(os.environ | {"QUORIENT_KEYS": str(keys)})
    if done.returncode:
        raise RuntimeError(done.stderr)
    return yaml.safe_load(done.stdout)


def mounts_of(service):
    """{place in the container: (place on the host, mode)}. docker-compose 1.29 prints the short form, Compose v2 the long one."""
    mounts = {}
    for entry in service["volumes"]:
        if isinstance(entry, str):
            source, target, mode = entry.split(":")
        else:
            source, target, mode = entry["source"], entry["target"], "ro" if entry.get("read_only") else "rw"
        mounts[target] = (source, mode)
    return mounts


def flaws(composed, keys):
    """Yields a sentence for each promise that the file breaks."""
    for name, service in composed["services"].items():
        mounts = mounts_of(service)
        allowed = {"/etc/quorient/system.yaml": str(SYSTEM_FILE), f"{KEYS}/shared": f"{keys}/shared", f"{KEYS}/{name}": f"{keys}/{name}"}
        if {target: source for target, (source, _) in mounts.items()} != allowed:
            yield f"{name}: mounts {mounts}"
        if any(mode != "ro" for _, mode in mounts.values()):
            yield f"{name}: a mount can be written"
        if not service.get("read_only") or service.get("cap_drop") != ["ALL"] or service.get("user") != "10001:10001":
            yield f"{name}: it is not fenced"
        if "build" in service or "environment" in service:
            yield f"{name}: keys could get into an image or the environment"
        if service["command"][-2:] != ["--name", name]:
            yield f"{name}: it starts {service['command']}"


@unittest.skipUnless(yaml and shutil.which("docker-compose"), "docker-compose or Python's yaml is not installed")
class SecuredForm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.keys = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="quorient-secured-"))) / "keys"
        command = [str(BIN / "quorient"), "keys", str(SYSTEM_FILE), "--out", str(cls.keys)]
        subprocess.run(command, check=True, capture_output=True, timeout=60)
        cls.composed = resolved(cls.keys)

    def test_each_container_sees_its_own_keys_alone(self):
        self.assertEqual(list(flaws(self.composed, self.keys)), [])

    def test_notices_a_container_that_sees_more(self):
        for harm in (lambda voter: voter["volumes"].append(f"{self.keys}/sensor:{KEYS}/sensor:ro"),
                     lambda voter: voter["volumes"].append(f"{self.keys}/authority:{KEYS}/authority:ro"),
                     lambda voter: voter.update(volumes=[f"{self.keys}:{KEYS}:ro"]),
                     lambda voter: voter.update(volumes=[entry.replace(":ro", ":rw") for entry in voter["volumes"]]),
                     lambda voter: voter.update(read_only=False),
                     lambda voter: voter.update(environment={"KEY": "secret"})):
            composed = copy.deepcopy(self.composed)
            voter = composed["services"]["voter-1"]
            voter["volumes"] = [f"{source}:{target}:{mode}" for target, (source, mode) in mounts_of(voter).items()]
            harm(voter)
            self.assertEqual(len(list(flaws(composed, self.keys))), 1)

    def test_every_process_of_the_system_file_has_a_container_an_address_and_keys(self):
        made = {folder.name for folder in self.keys.iterdir()} - {"shared", "authority", "monitor", "operator"}
        self.assertEqual(set(self.composed["services"]), made)
        addresses = {service["networks"]["secured"]["ipv4_address"] for service in self.composed["services"].values()}
        peers = set(re.findall(r"^  - (198\.18\.30\.\d+)", SYSTEM_FILE.read_text(), re.MULTILINE))
        self.assertEqual(addresses, peers)

    def test_the_system_file_holds_with_these_keys_and_not_without(self):
        held = check(self.keys)
        self.assertEqual(held.returncode, 0, held.stderr)
        self.assertEqual(check(self.keys.parent / "nowhere").returncode, 2)

    def test_does_not_start_without_the_folder_of_the_keys(self):
        environment = {name: value for name, value in os.environ.items() if name != "QUORIENT_KEYS"}
        done = config(environment)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("QUORIENT_KEYS", done.stderr + done.stdout)


class PrivateKeys(unittest.TestCase):
    KEY = b"-----BEGIN PRIVATE KEY-----\n" + b"MIGHAgEAMBMGByqGSM49" * 3

    @staticmethod
    def archive(files):
        stream = io.BytesIO()
        with tarfile.open(fileobj=stream, mode="w") as archive:
            for name, content in files.items():
                member = tarfile.TarInfo(name)
                member.size = len(content)
                archive.addfile(member, io.BytesIO(content))
        return stream.getvalue()

    def found(self, **files):
        layer = self.archive({"usr/": b"", **files})
        return list(private_keys.private_keys_in(io.BytesIO(self.archive({"manifest.json": b"[]", "1/layer.tar": layer, **files}))))

    def test_are_found_in_layers_and_in_settings(self):
        self.assertEqual(self.found(key=self.KEY, other=bytes(5000)), ["key", "key"])
        self.assertEqual(self.found(settings=b'{"Env": "KEY=' + self.KEY.replace(b"\n", b"\\n").replace(b"PRIVATE", b"EC PRIVATE")), ["settings"] * 2)

    def test_are_not_certificates_nor_what_a_library_tests_itself_with(self):
        self.assertEqual(self.found(certificate=self.KEY.replace(b"PRIVATE KEY", b"CERTIFICATE"), library=b"\x7fELF" + self.KEY), [])


if __name__ == "__main__":
    unittest.main()
