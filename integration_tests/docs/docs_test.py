#!/usr/bin/env python3
"""The documents are sound, and a planted fault of each kind is noticed."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
REFERENCES = "# References\n\n## Paper 001\n\nSomebody, somewhere.\n"


def check(root):
    return subprocess.run([sys.executable, HERE / "check_docs.py", root], capture_output=True, text=True, timeout=120)


class Documents(unittest.TestCase):
    def test_are_sound(self):
        result = check(ROOT)
        self.assertEqual(result.returncode, 0, result.stdout)

    def planted(self, path, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, content in (("docs/references.md", REFERENCES), (path, text)):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(content)
            return check(root)

    def test_notice_planted_faults(self):
        for path, text in [
            ("README.md", "See [the other page](docs/nowhere.md).\n"),
            ("README.md", "See [a heading](docs/references.md#paper-009).\n"),
            ("README.md", "A sentence of " + "very " * 33 + "many words.\n"),
            ("docs/page.md", "- a point without an end\n" * 10),
            ("tools/README.md", "A sentence of " + "very " * 33 + "many words.\n"),
            ("docs/page.md", "As paper 007 says.\n"),
            ("tools/a.hpp", "/// A method. [paper 009]\n"),
            ("tools/a.hpp", "/// Of a method that nobody calls the result is not kept.\n"),
            ("tools/a.hpp", "int frames = 0;  ///< of the window\n"),
            ("services/a.hpp", "int frames = 0;  ///< of the window\n"),
            ("tools/a.hpp", "/// The closed form is in methods.md.\n"),
            ("tools/README.md", "As cli.md says.\n"),
        ]:
            with self.subTest(path=path, text=text):
                self.assertEqual(self.planted(path, text).returncode, 1)

    def test_leave_what_is_allowed_alone(self):
        for path, text in [
            ("README.md", "See [paper 001](docs/references.md#paper-001), [the web](https://example.org) and [below](#below).\n\n## Below\n"),
            ("README.md", "| a table may hold " + "many " * 40 + "words |\n"),
            ("README.md", "```\n" + "code " * 40 + "\n```\n"),
            ("tools/notes.md", "A sentence of " + "very " * 33 + "many words.\n"),
            ("build/release/a.hpp", "/// Of nothing that is ours: a build made it.\n"),
            ("tools/a.hpp", "/// The sum\n/// of all frames. [paper 001, eq 3]\n"),
        ]:
            with self.subTest(path=path, text=text):
                result = self.planted(path, text)
                self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    unittest.main()
