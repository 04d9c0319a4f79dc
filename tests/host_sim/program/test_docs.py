"""The manual's commands, run as they are typed there: each must print what stands behind it.

A console block is a list of commands after `$ ` and what they print, standard error included; a line `...` stands for
any lines, `...` at the end of a line for any rest of it. Building is left out, the program is there.
"""
import os
import pathlib
import re
import shutil
import subprocess
import unittest

import hostsim

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
PAGES = ("docs/host-sim.md", "docs/report.md", "docs/survey.md", "docs/why.md", "docs/monitor.md", "README.md")
LEFT_OUT = ("cmake ", "export PATH=")


def commands(page):
    """(command, expected lines) of every console block of a page."""
    for block in re.findall(r"^```console\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        found = []
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
        yield found


def pattern(lines):
    parts = []
    for line in lines:
        if line == "...":
            parts.append(r"(?:.*\n)*?")
        elif line.endswith("..."):
            parts.append(re.escape(line[:-3]) + r".*\n")
        else:
            parts.append(re.escape(line) + r"\n")
    return "".join(parts)


class Manual(unittest.TestCase):
    def test_every_command_prints_what_the_manual_says(self):
        environment = dict(os.environ, TZ="UTC", PATH=os.path.dirname(hostsim.PROGRAM) + os.pathsep + os.environ["PATH"])
        bash = shutil.which("bash")
        count = 0
        for page in PAGES:
            for block in commands((REPOSITORY / page).read_text(encoding="utf-8")):
                status = 0
                for command, expected in block:
                    if command.startswith(LEFT_OUT):
                        continue
                    command = command.replace("./scripts/demo", "host_sim demo")  # which is what it builds and runs
                    done = subprocess.run([bash, "-c", command.replace("$?", str(status))], cwd=REPOSITORY,
                                          env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                          timeout=60, check=False, text=True)
                    status = done.returncode
                    self.assertRegex(done.stdout, r"\A(?:%s)\Z" % pattern(expected), command)
                    count += 1
        self.assertGreater(count, 10)


if __name__ == "__main__":
    unittest.main()
