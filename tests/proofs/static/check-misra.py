#!/usr/bin/python3
"""cppcheck with its MISRA C:2012 addon over the core: nothing is found but the listed deviations.

A deviation stands in tests/proofs/static/deviations with its reason: a rule and a place, or for an advisory rule `everywhere`. One
that is not needed any more fails as well. The addon prints numbers of rules; their text is MISRA's.
usage: check-misra.py [--list]      --list: everything that is found, for the file
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts/tools"))
import reasons  # noqa: E402  (its folder is known only now)

FINDING = re.compile(r"([^:]*):(\d+): ([^:]+): (.*)")
DEVIATION = re.compile(r"(\S+) (?:(everywhere)|([^ :]+): (\S.*))")
# Rules that MISRA C:2012 calls advisory, of those that the addon knows.
ADVISORY = """2.3 2.4 2.5 2.6 2.7 4.2 5.9 8.7 8.9 8.11 8.13 10.5 11.4 11.5 12.1 12.3 12.4 13.3 13.4 15.1 15.4 15.5 17.5 17.8
    18.4 18.5 19.2 20.1 20.5 20.10 21.12""".split()


def fail(message):
    print(f"check-misra: {message}", file=sys.stderr)
    sys.exit(1)


def read_deviations():
    """(rule, file, text) of every deviation, file and text empty for `everywhere`."""
    path = ROOT / "tests/proofs/static/deviations"
    for rule, everywhere, file, text in reasons.read(path, DEVIATION, "RULE FILE: SOURCE LINE"):
        if everywhere and rule not in ADVISORY:
            fail(f"{path}: {rule} is not advisory: each place needs its reason")
        yield rule, file or "", text or ""


def findings():
    """(rule or check, file, line number, text of the line) of everything that cppcheck says."""
    with tempfile.TemporaryDirectory() as scratch:
        command = ["cppcheck", "--std=c11", "--platform=arm32-wchar_t4", "--addon=misra", "--enable=all", "--inconclusive",
                   "--suppress=missingIncludeSystem", "--suppress=unusedFunction", "--quiet", "--error-exitcode=0",
                   f"--cppcheck-build-dir={scratch}", "--template={file}:{line}: {id}: {message}", "-Ifirmware/include",
                   "-Ihal/include", "-Ifirmware/src", "firmware/src"]
        done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        fail(done.stdout + done.stderr)
    for line in sorted(set(done.stderr.splitlines())):
        match = FINDING.fullmatch(line)
        if not match:
            fail(f"cppcheck says: {line}")
        file, number, check, message = match.groups()
        source = ROOT / file
        text = source.read_text(encoding="utf-8").splitlines()[int(number) - 1].strip() if source.is_file() else message
        yield check.removeprefix("misra-c2012-"), file, int(number), text


def main():
    parser = argparse.ArgumentParser(description="MISRA C:2012 and cppcheck over the core")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    found = list(findings())
    if arguments.list:
        for rule, file, _, text in found:
            print(f"{rule} {file}: {text}")
        return
    deviations = list(read_deviations())
    bad = [f"{file}:{number}: {rule}: {text}" for rule, file, number, text in found
           if (rule, "", "") not in deviations and (rule, file, text) not in deviations]
    needed = {(rule, file, text) for rule, file, _, text in found} | {(rule, "", "") for rule, *_ in found}
    bad += [f"this deviation is not needed: {' '.join(place)}" for place in deviations if place not in needed]
    if bad:
        fail("\n".join(bad))
    rules = sum(not file for _, file, _ in deviations)
    print(f"MISRA C:2012 and cppcheck: deviations from {rules} advisory rules everywhere, and in {len(deviations) - rules} single places")


main()
