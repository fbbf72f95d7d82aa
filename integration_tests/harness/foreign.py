"""Foreign nodes for the tests: builds them from the installed IDL alone, starts them, reads what they print."""
import functools
import os
import pathlib
import signal
import subprocess

from integration_tests.harness import exact_json
from integration_tests.harness.processes import BIN, ProcessTest

INTEROP = pathlib.Path(__file__).resolve().parent.parent / "interop"
BUILD = pathlib.Path(os.environ.get("QUORIENT_BUILD", BIN.parent))
# Kept between runs, so that only what changed is built again.
WORK = BUILD / "integration_tests/interop"
BUILD_TIMEOUT_S = 240


def run(*command, timeout=BUILD_TIMEOUT_S):
    result = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=timeout)
    assert result.returncode == 0, f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}"
    return result.stdout


@functools.cache
def installed_idl():
    """The folder that a user gets with the package: the IDL and the examples."""
    prefix = WORK / "installed"
    run("cmake", "--install", BUILD, "--component", "quorient-dev", "--prefix", prefix)
    return prefix / "share/quorient/idl"


@functools.cache
def build(source, program):
    """Builds a project outside our tree with the installed IDL. @returns the program."""
    folder = WORK / program
    run("cmake", "-S", source, "-B", folder, f"-DQUORIENT_IDL={installed_idl() / 'quorient_msgs.idl'}")
    run("cmake", "--build", folder)
    return folder / program


def example(program):
    return build(installed_idl() / "examples" / program, program)


# A Debian release, in whose root foreign nodes are built and run, in a system of this machine's own release.
NODES_RELEASE = os.environ.get("QUORIENT_NODES_RELEASE")


@functools.cache
def built_elsewhere(source, program):
    """@param source  folder of a project of its own, from the root of ours  @returns the command that starts its program."""
    in_root = (INTEROP.parent.parent / "deploy/release-root", "--host-network", NODES_RELEASE)
    idl = "/quorient/idl/quorient_msgs.idl"
    run(*in_root, "sh", "-c", f"cmake -S {source} -B build/{program} -DQUORIENT_IDL={idl} && cmake --build build/{program}")
    return (*in_root, f"build/{program}/{program}")


def consumer(program):
    """@returns the command that starts the example of that name."""
    return built_elsewhere(f"idl/examples/{program}", program) if NODES_RELEASE else (example(program),)


def node(program):
    """@returns the command that starts a node of integration_tests/interop."""
    return built_elsewhere(f"integration_tests/interop/{program}", program) if NODES_RELEASE else (build(INTEROP / program, program),)


class InteropTest(ProcessTest):
    """A domain of its own. Output of long-running programs goes to files, so that none of them blocks on a full pipe."""

    first_domain = int(os.environ.get("QUORIENT_INTEROP_DOMAIN", 120 + os.getpid() * 7 % 90))
    domains = int(os.environ.get("QUORIENT_INTEROP_DOMAINS", 20))
    used = 0

    def setUp(self):
        super().setUp()
        self.domain = self.first_domain + InteropTest.used % self.domains
        InteropTest.used += 1

    def start_logged(self, name, *command):
        """@returns the process and the file that its output goes to."""
        log = self.run_directory / f"{name}.out"
        with log.open("w") as output:
            process = subprocess.Popen(list(map(str, command)), env=self.environment, stdout=output, stderr=subprocess.STDOUT)
        self.processes.append(process)
        return process, log

    def start_services(self, configuration, *arguments, sensor=False):
        """The processes of a system file of three lanes and two voters. @returns {name: (process, log)}."""
        voters = [("quorient-voter", f"voter-{i}") for i in (1, 2)]
        lanes = [(f"quorient-{kind}", f"{kind}-{lane}") for lane in "abc" for kind in ("attitude", "fdi")]
        return {
            name: self.start_logged(name, BIN / program, configuration, "--name", name, "--domain", self.domain, *arguments)
            for program, name in voters + lanes + [("quorient-sensor", "sensor")] * sensor
        }

    def echo(self, topic, count, *arguments, timeout=10):
        result = self.run_program(
            "quorient", "echo", topic, "--count", count, "--json", "--timeout", timeout, "--domain", self.domain, *arguments, timeout=timeout + 20
        )
        return [exact_json.loads(line) for line in result.stdout.splitlines()]

    def all_alive(self, services):
        for name, (process, log) in services.items():
            if process.poll() is not None:
                self.fail(f"{name} ended with {process.returncode}:\n{log.read_text(errors='replace')[-2000:]}")

    def kill(self, process):
        """@param process  id of a service of this test's own pipeline."""
        os.kill(process, signal.SIGKILL)
