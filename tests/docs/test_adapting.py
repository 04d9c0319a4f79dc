"""docs/adapting.md, word for word: its settings, and its message and its fault built and run in a copy of the sources.

Shows that a reader who follows the page gets what it prints.
"""
import os
import pathlib
import shutil
import subprocess
import unittest

import typed

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ["HOST_SIM"])
WORK = pathlib.Path(os.environ["AGV_DOCS_WORK"]) / "adapting"
LEFT_OUT = ("cmake --preset host ", "export PATH=")  # until the page changes sources, the program is this build's


class Adapting(unittest.TestCase):
    def test_what_the_page_says(self):
        typed.copy_tree(ROOT, WORK)
        built = WORK / "build/host/bin"
        (built / "host_sim").unlink(missing_ok=True)
        environment = {"TZ": "UTC", "PATH": os.pathsep.join((str(built), str(PROGRAM.parent), os.environ["PATH"])),
                       "GIT_CEILING_DIRECTORIES": str(WORK.parent)}
        if shutil.which("ccache"):
            environment.update(CMAKE_C_COMPILER_LAUNCHER="ccache", CCACHE_BASEDIR=str(WORK), CCACHE_NOHASHDIR="1")
        subprocess.run(["cmake", "--preset", "host"], cwd=WORK, env=dict(os.environ, **environment), check=True,
                       stdout=subprocess.DEVNULL)
        count = typed.run(self, ROOT / "docs/adapting.md", WORK, environment, LEFT_OUT)
        self.assertGreater(count, 15)


if __name__ == "__main__":
    unittest.main()
