"""The pages of host_sim, typed as they stand: each command must print what stands behind it. Building is left out."""
import os
import pathlib
import unittest

import typed

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ("docs/host-sim.md", "docs/report.md", "docs/survey.md", "docs/why.md", "docs/monitor.md", "README.md")
LEFT_OUT = ("cmake ", "export PATH=")
INSTEAD = {"./scripts/demo": "host_sim demo"}  # which is what it builds and runs


class Manual(unittest.TestCase):
    def test_every_command_prints_what_the_manual_says(self):
        environment = {"TZ": "UTC", "PATH": os.path.dirname(os.environ["HOST_SIM"]) + os.pathsep + os.environ["PATH"]}
        for page in PAGES:
            with self.subTest(page):
                self.assertGreater(typed.follow(self, typed.steps(ROOT / page), ROOT, environment, LEFT_OUT, INSTEAD), 0)


if __name__ == "__main__":
    unittest.main()
