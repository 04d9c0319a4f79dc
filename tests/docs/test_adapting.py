#!/usr/bin/python3 -B
"""docs/adapting.md, word for word: its settings, and whether its changes of the sources still apply.

Of the changed sources the core, and the tables that explain a fault, are compiled. With AGV_DOCS_BUILD=1 (tests/proofs/adapting/run)
all of them are built and run. AGV_ADAPTING_PAGE is another page.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import typed

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import tree  # noqa: E402

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


def compile_tables(case):
    """Static assertions say when the core no longer fits its memory, or a fault has no row."""
    sources = [*sorted(WORK.glob("firmware/src/*/*.c")), *(WORK / name for name in ("host_sim/why/why_table.c", "host_sim/report/sentence.c"))]
    case.assertGreater(len(sources), 20)
    folders = ("firmware/include", "firmware/src", "hal/include", "host_sim")
    done = subprocess.run([os.environ.get("CC", "cc"), "-std=c11", "-fsyntax-only", *(f"-I{WORK / folder}" for folder in folders), *sources],
                          stderr=subprocess.PIPE, check=False, text=True)
    case.assertEqual(0, done.returncode, done.stderr)


class Adapting(unittest.TestCase):
    def test_what_the_page_says(self):
        tree.copy_tree(ROOT, WORK)
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
        if not BUILDS:
            compile_tables(self)
        print(f"{count} commands of the page typed")


if __name__ == "__main__":
    unittest.main()
