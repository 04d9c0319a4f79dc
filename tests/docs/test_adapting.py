#!/usr/bin/python3 -B
"""docs/adapting.md, word for word: its settings, and whether its changes of the sources still apply.

With AGV_DOCS_BUILD=1 (tests/proofs/adapting/run) the changed sources are built and run, too. AGV_ADAPTING_PAGE is another page.
"""
import os
import pathlib
import shutil
import subprocess
import unittest

import typed

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = pathlib.Path(os.environ.get("AGV_ADAPTING_PAGE", ROOT / "docs/adapting.md"))
PROGRAM = pathlib.Path(os.environ["HOST_SIM"])
WORK = pathlib.Path(os.environ["AGV_DOCS_WORK"]) / "adapting"
BUILDS = bool(os.environ.get("AGV_DOCS_BUILD"))
LEFT_OUT = ("cmake --preset host ", "export PATH=")  # until the page changes sources, the program is this build's


def without_builds(steps):
    """What needs no program of the changed sources."""
    built = False
    for step in steps:
        built = built or (step[0] == "run" and step[1].startswith("cmake --build"))
        if not built or step[0] == "save" or step[1].startswith("git apply"):
            yield step


class Adapting(unittest.TestCase):
    def test_what_the_page_says(self):
        typed.copy_tree(ROOT, WORK)
        built = WORK / "build/host/bin"
        (built / "host_sim").unlink(missing_ok=True)
        environment = {"TZ": "UTC", "PATH": os.pathsep.join((str(built), str(PROGRAM.parent), os.environ["PATH"])),
                       "GIT_CEILING_DIRECTORIES": str(WORK.parent)}
        if shutil.which("ccache"):
            environment.update(CMAKE_C_COMPILER_LAUNCHER="ccache", CCACHE_BASEDIR=str(WORK), CCACHE_NOHASHDIR="1")
        steps = typed.steps(PAGE)
        if BUILDS:
            subprocess.run(["cmake", "--preset", "host"], cwd=WORK, env=dict(os.environ, **environment), check=True,
                           stdout=subprocess.DEVNULL)
        else:
            steps = without_builds(steps)
        count = typed.follow(self, steps, WORK, environment, LEFT_OUT)
        self.assertGreater(count, 10)
        print(f"{count} commands of the page typed")


if __name__ == "__main__":
    unittest.main()
