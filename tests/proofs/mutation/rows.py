"""The stored mutants: each breaks a row of the requirements, the protocol or the faults.

They are the seeded faults of the checker `row` in tests/proofs/seeded.tsv, each with the row as its name. A mutant counts when an
assertion fails in a test that names the row.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import bench

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import seed  # noqa: E402

ZEPHYR_TESTS = "tests/ports/zephyr/"  # a row that only they show is one of the application, not of the core
OTHER_FILES = "scripts/"  # a row that the sources alone cannot break: the check that holds it is broken instead


def read_shown(text):
    """What scripts/tools/traceability.py prints: row -> list of (test, file)."""
    shown = {}
    for line in text.splitlines():
        row, _, tests = line.partition(" ")
        found = re.findall(r"([^,(][^(]*) \(((?:tests|host_sim)/[^)]+)\)", tests)
        if found:
            shown[row] = [(name.strip(), place) for name, place in found]
    return shown


def try_source(at, path, text, shown):
    """Whether this text of a source is noticed, and by whom or why not."""
    if not at.build(pathlib.Path(path).name, text):
        return False, "it does not compile"
    named = {(name, place.rsplit("/", 1)[-1]) for name, place in shown}
    programs = {place.removesuffix(".c") for _, place in named}
    for test in sorted(at.plan["tests"], key=lambda test: test["seconds"]):
        if test["name"] not in programs:
            continue
        for failure in at.run(test, go_on=True).failures:
            file, _, name = failure.split(":")[:3]
            if (name.split("(")[0], file) in named:
                return True, f"{file}: {name}"
    return False, "no test that names the row fails"


def try_script(path, text, shown):
    """The same for a script and the tests of tests/checks, on a copy of what these need."""
    with tempfile.TemporaryDirectory(dir=bench.BUILD) as folder:
        for name in ("scripts", "tests/checks", "tests/support"):
            shutil.copytree(bench.ROOT / name, f"{folder}/{name}")
        pathlib.Path(folder, path).write_text(text, encoding="utf-8")
        for name, place in shown:
            if place.endswith(".bats"):
                out = subprocess.run(["bats", "--tap", "--filter", f"^{re.escape(name)}$", f"{folder}/{place}"],
                                     stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
                if re.search(rf"^not ok \d+ {re.escape(name)}$", out, re.MULTILINE):
                    return True, f"{place}: {name}"
    return False, "no test that names the row fails"


def check(at, shown, only=()):
    """Tries each; prints what was found. The exit status."""
    mutants = seed.of("row")
    rows = {mutant.name for mutant in mutants}
    of_core = [row for row, tests in shown.items() if any(not place.startswith(ZEPHYR_TESTS) for _, place in tests)]
    problems = [f"no mutant is stored for {row}" for row in of_core if row not in rows]
    problems += [f"seeded.tsv: {row} is no row, or no test shows it" for row in sorted(rows - shown.keys())]
    noticed = 0
    for mutant in mutants:
        row = mutant.name
        if row not in shown or (only and row not in only):
            continue
        (path, text), = mutant.changed().items()
        attempt = try_script(path, text, shown[row]) if path.startswith(OTHER_FILES) else try_source(at, path, text, shown[row])
        found, what = attempt
        noticed += found
        print(f"{row:28} {what}", flush=True)
        if not found:
            problems.append(f"{row}: {path}: {what}")
    for problem in problems:
        print(f"mutate: {problem}", flush=True)
    print(f"{len(of_core)} rows, {noticed} broken by a stored mutant and noticed by a test that names them, "
          f"{len(problems)} problems")
    return 1 if problems else 0
