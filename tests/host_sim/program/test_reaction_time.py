"""Derived reaction times: frame lengths as worked out by hand, the page against the code, a planted mistake."""
import json
import pathlib
import subprocess
import unittest

import hostsim

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCRIPT = ROOT / "scripts/tools/reaction-time.py"
PAGE = ROOT / "docs/reaction-time.md"


class ReactionTime(hostsim.Case):
    def test_the_lengths_of_the_simulated_bus_are_these(self):
        # 44 bits and 8 a byte, the most stuff bits of 34 + 8 n: (34 + 8 n - 1) / 4. Written out, from 0 to 8 bytes.
        tables = json.loads(self.run_good("campaign", "--tables").stdout)
        self.assertEqual(tables["standard_bits"], [52, 62, 72, 82, 92, 102, 112, 122, 132])
        self.assertEqual(tables["extended_bits"], [77, 87, 97, 107, 117, 127, 137, 147, 157])
        self.assertEqual(tables["interframe_bits"], 3)

    def check(self, *arguments):
        return subprocess.run([SCRIPT, "--host-sim", hostsim.PROGRAM, "--check", *arguments], cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def test_the_page_is_what_the_code_says(self):
        done = self.check()
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_wrong_figure_is_noticed(self):
        page = PAGE.read_text(encoding="utf-8")
        row = next(line for line in page.splitlines() if line.startswith("| `VCU_HEARTBEAT_LOST`"))
        figures = row.split(" | ")[2]
        derived, measured = figures.split(" / ")
        wrong = page.replace(row, row.replace(figures, f"{float(derived) - 1:.1f} / {measured}", 1))
        done = self.check("--page", self.write("page.md", wrong))
        self.assertEqual(done.returncode, 1)
        self.assertIn("out of date", done.stderr)


if __name__ == "__main__":
    unittest.main()
