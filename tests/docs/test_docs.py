"""The pages of host_sim, typed as they stand: each command must print what stands behind it. Building is left out."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import typed

PROGRAM = os.environ["HOST_SIM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ("docs/host-sim.md", "docs/report.md", "docs/survey.md", "docs/why.md", "docs/monitor.md", "README.md")
LEFT_OUT = ("cmake ", "export PATH=")
INSTEAD = {"./scripts/demo": "host_sim demo"}  # which is what it builds and runs


class Manual(unittest.TestCase):
    def test_every_command_prints_what_the_manual_says(self):
        environment = {"TZ": "UTC", "PATH": os.path.dirname(PROGRAM) + os.pathsep + os.environ["PATH"]}
        for page in PAGES:
            with self.subTest(page):
                self.assertGreater(typed.follow(self, typed.steps(ROOT / page), ROOT, environment, LEFT_OUT, INSTEAD), 0)

    def test_the_tutorial_of_the_scenarios(self):
        """In a folder of its own, because it makes files."""
        page = ROOT / "docs/scenarios.md"
        first = re.search(r"^```sh\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[1]
        with tempfile.TemporaryDirectory(prefix="docs.") as name:
            folder = pathlib.Path(name)
            (folder / "build/host/bin").mkdir(parents=True)
            (folder / "build/host/bin/host_sim").symlink_to(PROGRAM)
            (folder / "host_sim").symlink_to(ROOT / "host_sim")
            subprocess.run(["sh", "-ec", first], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            self.assertEqual(typed.follow(self, typed.steps(page), folder, {}), 7)


if __name__ == "__main__":
    unittest.main()
