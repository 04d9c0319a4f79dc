"""The man pages: no warning of groff or man, all options, the exit statuses of the manual."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import hostsim


class Pages(hostsim.Case):
    def setUp(self):
        super().setUp()
        self.pages = {"host_sim.1": self.run_good("man").stdout}
        self.pages.update({f"host_sim-{command}.1": self.run_good("man", command).stdout for command in self.commands()})
        for name, text in self.pages.items():
            self.write(name, text)

    def formatted(self, *command):
        """What a formatter makes of a page, in one line; it must not warn."""
        done = subprocess.run(command, cwd=self.folder, check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              env={**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "200", "MAN_KEEP_FORMATTING": ""})
        self.assertEqual(done.stderr.decode(), "", command)
        return re.sub(r"\s+", " ", re.sub(r".\x08|\x1b\[[0-9;]*m", "", done.stdout.decode()))

    def test_groff_has_no_warning(self):
        for name in self.pages:
            self.formatted("groff", "-man", "-ww", "-Tutf8", name)

    def test_man_has_no_warning_and_shows_every_option_and_example(self):
        for name in self.pages:
            with self.subTest(name):
                text = self.formatted("man", "--warnings", "-l", name)
                command = name[len("host_sim-"):-len(".1")]
                if not command:
                    continue
                help_text, examples = self.run_good("help", command).stdout.split("\nExamples:\n")
                for option in re.findall(r"^  (--[a-z-]+)", help_text, re.MULTILINE):
                    self.assertIn(f" {option} ", text)
                for does in re.findall(r"^      (\S.*)", examples, re.MULTILINE):
                    self.assertIn(does, text)

    def test_files_are_named_where_the_package_puts_them(self):
        self.assertIn("host_sim replay /usr/share/agv\\-supervisor/examples/ai\\-stops.log",
                      self.pages["host_sim-replay.1"].replace("\\fB", ""))
        for name, text in self.pages.items():
            self.assertNotIn(str(pathlib.Path(hostsim.PROGRAM).parent), text, name)


if __name__ == "__main__":
    if not (shutil.which("man") and shutil.which("groff")):
        print("SKIPPED: there is no man or groff: the man pages were not formatted. scripts/install-deps test installs them.")
        sys.exit(77)
    unittest.main(verbosity=2)
