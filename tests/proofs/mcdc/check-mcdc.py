#!/usr/bin/python3
"""Line, branch and MC/DC coverage of the core by clang 19: 100 %, less the listed exclusions.

Judges the profiles that the tests of the preset mcdc left (build/mcdc/profile, one a test program). An exclusion stands in
tests/proofs/mcdc/exclusions with its reason; one that is not needed any more fails as well, and so do more than 1 % of them.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = ROOT / "build/mcdc"
sys.path.insert(0, str(ROOT / "scripts/tools"))
import reasons  # noqa: E402  (its folder is known only now)

MAX_EXCLUDED = 0.01
KINDS = ("line", "branch", "condition")
PLURAL = {"line": "lines", "branch": "branches", "condition": "conditions"}
EXCLUSION = re.compile(r"(line|branch (?:true|false)|condition \d+) ([^ :]+): (\S.*)")


def fail(message):
    print(f"check-mcdc: {message}", file=sys.stderr)
    sys.exit(1)


def run(*command):
    done = subprocess.run([str(part) for part in command], check=False, capture_output=True, text=True)
    if done.returncode != 0 or done.stderr:
        fail(f"{command[0]}: {done.stderr.strip()}")
    return done.stdout


def export(without):
    """What llvm-cov says, as JSON and in lcov's format, of the sources of the core."""
    profiles = [path for path in sorted(BUILD.glob("profile/*.profraw")) if path.stem not in without]
    programs = [BUILD / "bin" / path.stem for path in profiles]
    if not profiles:
        fail(f"no profiles in {BUILD}/profile: ctest --preset mcdc")
    run("llvm-profdata-19", "merge", "-o", BUILD / "all.profdata", *profiles)
    objects = [programs[0]] + [f"--object={program}" for program in programs[1:]]
    sources = [ROOT / "firmware/src", ROOT / "firmware/include"]

    def of(form):
        return run("llvm-cov-19", "export", f"--format={form}", f"--instr-profile={BUILD}/all.profdata", *objects, *sources)
    return json.loads(of("text"))["data"][0], of("lcov")


def text_of(lines, region):
    """The source between two places, on one line."""
    first, left, last, right = region
    part = lines[first - 1:last]
    part[-1] = part[-1][:right - 1]
    part[0] = part[0][left - 1:]
    return " ".join(" ".join(part).split())


def judge_branches(file, lines):
    """(whether it was taken, what it is) of both outcomes of every branch."""
    taken = {}
    for branch in file["branches"]:
        place = tuple(branch[:4])
        before = taken.get(place, (0, 0))
        taken[place] = (before[0] + branch[4], before[1] + branch[5])
    for place, counts in taken.items():
        for count, outcome in zip(counts, ("true", "false")):
            yield count > 0, place[0], f"branch {outcome}", text_of(lines, place)


def judge_conditions(file, lines):
    """(whether its independence is shown, what it is) of every condition of a decision that has several."""
    shown = {}
    for record in file.get("mcdc_records", []):
        place, conditions = tuple(record[:4]), record[-1]
        shown[place] = [one or other for one, other in zip(shown.get(place, [False] * len(conditions)), conditions)]
    for place, conditions in shown.items():
        for number, condition in enumerate(conditions, 1):
            yield condition, place[0], f"condition {number}", text_of(lines, place)


def judge_lines(lcov, name, lines):
    """(whether it was run, what it is) of every line of code. A brace alone is none, whatever clang counts there."""
    record = lcov.split(f"SF:{name}\n", 1)[1].split("end_of_record", 1)[0]
    for number, count in re.findall(r"^DA:(\d+),(\d+)", record, re.MULTILINE):
        text = lines[int(number) - 1].strip()
        if text not in ("{", "}"):
            yield int(count) > 0, int(number), "line", text


def judge(report, lcov):
    """Counts by kind, the number of decisions, and (line, kind, file, text) of all that is not covered."""
    counts = dict.fromkeys(KINDS, 0)
    decisions = {"one": 0, "several": 0}
    missing = []
    for file in report["files"]:
        name = str(pathlib.Path(file["filename"]).relative_to(ROOT))
        lines = pathlib.Path(file["filename"]).read_text(encoding="utf-8").splitlines()
        several = {tuple(record[:4]): len(record[-1]) for record in file.get("mcdc_records", [])}
        places = {tuple(branch[:4]) for branch in file["branches"]}
        decisions["several"] += len(several)
        decisions["one"] += len(places) - sum(several.values())
        found = [*judge_lines(lcov, file["filename"], lines), *judge_branches(file, lines), *judge_conditions(file, lines)]
        for covered, number, kind, text in found:
            counts[kind.split()[0]] += 1
            if not covered:
                missing.append((number, kind, name, text))
    return counts, decisions, missing


def main():
    parser = argparse.ArgumentParser(description="line, branch and MC/DC coverage of the core")
    parser.add_argument("--without", nargs="*", default=[], help="test programs that do not count")
    arguments = parser.parse_args()
    exclusions = reasons.read(ROOT / "tests/proofs/mcdc/exclusions", EXCLUSION, "KIND FILE: TEXT")
    report, lcov = export(arguments.without)
    counts, decisions, missing = judge(report, lcov)

    known = {file["filename"] for file in report["files"]}
    bad = [f"{path.relative_to(ROOT)} is not in the report" for path in sorted(ROOT.glob("firmware/src/**/*.c"))
           if str(path) not in known]
    bad += [f"{name}:{number}: {kind} is not covered: {text}" for number, kind, name, text in missing
            if (kind, name, text) not in exclusions]
    left = {place[1:] for place in missing}
    bad += [f"this exclusion is not needed: {' '.join(place[:2])}: {place[2]}" for place in exclusions if place not in left]
    excluded = {kind: sum(place[0].split()[0] == kind for place in exclusions) for kind in KINDS}
    bad += [f"{excluded[kind]} {PLURAL[kind]} of {counts[kind]} are excluded: more than 1 %" for kind in KINDS
            if excluded[kind] > MAX_EXCLUDED * counts[kind]]
    if bad:
        fail("\n".join(bad))
    parts = [f"{counts[kind]} {PLURAL[kind]} ({excluded[kind]} excluded)" for kind in KINDS]
    print(f"100 % of {', '.join(parts)}, in {sum(decisions.values())} decisions, {decisions['several']} of several conditions")


main()
