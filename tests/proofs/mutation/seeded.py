#!/usr/bin/python3
"""Seeded faults of mutate: a mutant that one test kills must survive without that test, one that reads behind a table must be
found by a sanitizer, and a single survivor must fail the sum."""
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
FILE = "names.c"
# agv_missing_name is called by test_names alone
KILLED, BEHIND, LINE = "return:NULL", "relational:<=", "missing_names[index]"


def mutate(*arguments):
    return subprocess.run([HERE / "mutate.py", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False).stdout


def find(suffix):
    """The mutant with this end of its id on the line that holds the text."""
    (path,) = (ROOT / "firmware/src").rglob(FILE)
    lines = path.read_text(encoding="ascii").splitlines()
    for key in mutate("list", FILE).split():
        if key.endswith(suffix) and LINE in lines[int(key.split(":")[1]) - 1]:
            return key
    raise SystemExit(f"seeded: there is no mutant {suffix} at '{LINE}' in {FILE}")


def verdict(*arguments):
    return mutate("try", *arguments).split("\n")[-2].split("'  ")[-1].split()[0]


def merge(*survivors):
    """What merge says when all others are killed."""
    lines = (HERE / "equivalents").read_text(encoding="utf-8").splitlines()
    survivors = {*survivors, *(key for line in lines for key in line.split(" ")[0].split(","))}
    with tempfile.NamedTemporaryFile("w", suffix=".jsonl") as results:
        for key in mutate("list").split():
            results.write(json.dumps({"id": key, "verdict": "survived" if key in survivors else "killed"}) + "\n")
        results.flush()
        return mutate("merge", results.name)


def main():
    killed, behind = find(KILLED), find(BEHIND)
    caught = [verdict(killed) == "killed" and verdict(killed, "--without", "test_names") == "survived",
              verdict(behind) == "sanitizer",
              f"1 survived: {killed}\n" in merge(killed) and "1 survived: " not in merge()]
    print(f"{sum(caught)} of {len(caught)} seeded faults caught")
    return 0 if all(caught) else 1


sys.exit(main())
