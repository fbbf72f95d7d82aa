"""The imports of the tree run in the stated direction, and a planted violation of each rule is noticed."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

from integration_tests.imports import check_imports

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def check(root):
    return subprocess.run([sys.executable, HERE / "check_imports.py", root], capture_output=True, text=True, timeout=60)


class Imports(unittest.TestCase):
    def test_run_in_the_stated_direction(self):
        result = check(ROOT)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_are_drawn_in_the_architecture(self):
        page = (ROOT / "ARCHITECTURE.md").read_text()
        self.assertIn("flowchart BT", page)
        self.assertEqual(page, check_imports.with_picture(ROOT), "stale picture: check_imports.py . --write")

    def planted(self, path, line):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "services").mkdir()
            file = root / path
            file.parent.mkdir(parents=True)
            file.write_text(line + "\n")
            return check(root)

    def test_notice_planted_violations(self):
        for path, line in [
            ("common/geometry/src/a.cpp", '#include "quorient/fdi/detector.hpp"'),
            ("common/fdi/src/a.cpp", "#include <chrono>"),
            ("common/recording/src/a.cpp", "#include <Eigen/Core>"),
            ("common/runtime/src/a.cpp", "#include <dds/dds.h>"),
            ("common/bus/cyclonedds/src/a.cpp", "#include <fastdds/dds/log/Log.hpp>"),
            ("common/newroom/src/a.cpp", "#include <vector>"),
            ("services/quorient/cli/a.cpp", '#include "verbs/verbs.hpp"'),
            ("services/quorient/report/a.cpp", '#include "launch/screen.hpp"'),
            ("common/fdi/src/single_frame/a.cpp", '#include "verdict/verdict_machine.hpp"'),
            ("common/fdi/README.md", "as services/quorient does"),
        ]:
            with self.subTest(path=path, line=line):
                self.assertEqual(self.planted(path, line).returncode, 1)

    def test_leave_what_is_allowed_alone(self):
        for path, line in [
            ("common/fdi/src/a.cpp", '#include "quorient/geometry/triads.hpp"'),
            ("common/bus/cyclonedds/src/a.cpp", "#include <dds/dds.h>"),
            ("common/fdi/test/a.cpp", "#include <chrono>"),
            ("services/quorient/verbs/a.cpp", '#include "replay/offline.hpp"'),
        ]:
            with self.subTest(path=path, line=line):
                result = self.planted(path, line)
                self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    unittest.main()
