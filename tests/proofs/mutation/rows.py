"""The stored mutants: one line each that breaks a row of the requirements, the protocol or the faults.

In the file rows an entry is
    ROW FILE
    - the old line
    + the new one
where the old line stands once in FILE, a source of the core; how far it is indented does not matter. A change counts when an
assertion fails in a test that names the row. Run as a program, this says whether each old line stands once.
"""
import collections
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import bench

Change = collections.namedtuple("Change", "row file old new")
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


def read_changes(path, problems):
    changes = []
    lines = [line for line in path.read_text(encoding="ascii").splitlines() if line.strip() and not line.startswith("#")]
    for head, old, new in zip(lines[::3], lines[1::3], lines[2::3]):
        row, _, file = head.partition(" ")
        if not (old.startswith("- ") and new.startswith("+ ") and file):
            problems.append(f"rows: '{head}' is no entry")
            break
        changes.append(Change(row, file, old[2:].strip(), new[2:].strip()))
    if len(lines) % 3:
        problems.append("rows: an entry is not complete")
    return changes


def changed_text(text, change):
    """The file with the change; nothing when the old line does not stand in it once."""
    lines = text.splitlines(keepends=True)
    places = [number for number, line in enumerate(lines) if line.strip() == change.old]
    if len(places) != 1:
        return None
    lines[places[0]] = lines[places[0]].replace(change.old, change.new)
    return "".join(lines)


def try_source(at, change, shown):
    """Whether it is noticed, and by whom or why not."""
    text = changed_text(at.sources[change.file], change)
    if text is None:
        return False, "the old line does not stand in the file once"
    if not at.build(change.file, text):
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


def try_script(change, shown):
    """The same for a script and the tests of tests/checks, on a copy of what these need."""
    with tempfile.TemporaryDirectory(dir=bench.BUILD) as folder:
        for name in ("scripts", "tests/checks", "tests/support"):
            shutil.copytree(bench.ROOT / name, f"{folder}/{name}")
        text = changed_text((bench.ROOT / change.file).read_text(encoding="utf-8"), change)
        if text is None:
            return False, "the old line does not stand in the file once"
        with open(f"{folder}/{change.file}", "w", encoding="utf-8") as file:
            file.write(text)
        for name, place in shown:
            if place.endswith(".bats"):
                out = subprocess.run(["bats", "--tap", "--filter", f"^{re.escape(name)}$", f"{folder}/{place}"],
                                     stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
                if re.search(rf"^not ok \d+ {re.escape(name)}$", out, re.MULTILINE):
                    return True, f"{place}: {name}"
    return False, "no test that names the row fails"


def check(at, path, shown, only=()):
    """Tries each; prints what was found. The exit status."""
    problems = []
    changes = read_changes(path, problems)
    entries = {change.row for change in changes}
    of_core = [row for row, tests in shown.items() if any(not place.startswith(ZEPHYR_TESTS) for _, place in tests)]
    problems += [f"no change is kept for {row}" for row in of_core if row not in entries]
    problems += [f"rows: {row} is no row" for row in sorted(entries - shown.keys())]
    noticed = 0
    for change in changes:
        if change.row not in shown or (only and change.row not in only):
            continue
        if change.file.startswith(OTHER_FILES):
            found, what = try_script(change, shown[change.row])
        else:
            found, what = try_source(at, change, shown[change.row])
        noticed += found
        print(f"{change.row:28} {what}", flush=True)
        if not found:
            problems.append(f"{change.row}: {change.file}: '{change.new}': {what}")
    for problem in problems:
        print(f"mutate: {problem}", flush=True)
    print(f"{len(of_core)} rows, {noticed} broken by a stored mutant and noticed by a test that names them, "
          f"{len(problems)} problems")
    return 1 if problems else 0


def main():
    problems = []
    changes = read_changes(pathlib.Path(__file__).with_name("rows"), problems)
    core = {path.name: path for path in bench.core_files()}
    for change in changes:
        path = core.get(change.file, bench.ROOT / change.file)
        if changed_text(path.read_text(encoding="utf-8"), change) is None:
            problems.append(f"{change.row}: {change.file}: '{change.old}' does not stand in the file once")
    for problem in problems:
        print(f"rows: {problem}")
    print(f"{len(changes) - len(problems)} of {len(changes)} stored mutants can be applied")
    return 1 if problems or not changes else 0


if __name__ == "__main__":
    sys.exit(main())
