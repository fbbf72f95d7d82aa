"""Private keys in an image, whatever layer or setting holds them."""
import re
import subprocess
import tarfile

KEY = re.compile(rb"-----BEGIN [A-Z ]*PRIVATE KEY-----(?:\s|\\n)+[A-Za-z0-9+/=]{40}")
# Libraries are not searched: those of TLS carry keys for their tests of themselves.
PROGRAM = b"\x7fELF"
TAR = slice(257, 262), b"ustar"  # where an archive says what it is


def private_keys_in(stream):
    """Yields the name of each file with one, in an archive and in the archives in it."""
    with tarfile.open(fileobj=stream, mode="r|") as archive:
        for member in archive:
            if not member.isfile():
                continue
            file = archive.extractfile(member)
            begin = file.peek(512)
            if begin[TAR[0]] == TAR[1]:
                yield from private_keys_in(file)
            elif not begin.startswith(PROGRAM) and KEY.search(file.read()):
                yield member.name


def private_keys_in_image(image):
    """Names of the files with one, in its layers and its settings."""
    with subprocess.Popen(["docker", "save", image], stdout=subprocess.PIPE) as saving:
        found = list(private_keys_in(saving.stdout))
    if saving.returncode:
        raise RuntimeError(f"docker save {image}: exit code {saving.returncode}")
    return found
