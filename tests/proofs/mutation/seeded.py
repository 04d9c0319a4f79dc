#!/usr/bin/python3
"""Seeded fault of mutate: a mutant that one test kills must survive without that test."""
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
# agv_missing_name is called by test_names alone
FILE, SUFFIX, LINE = "names.c", "return:NULL", "missing_names[index]"


def mutate(*arguments):
    return subprocess.run([HERE / "mutate.py", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False).stdout


def find():
    """The mutant with this end of its id on the line that holds the text."""
    (path,) = (ROOT / "firmware/src").rglob(FILE)
    lines = path.read_text(encoding="ascii").splitlines()
    for key in mutate("list", FILE).split():
        if key.endswith(SUFFIX) and LINE in lines[int(key.split(":")[1]) - 1]:
            return key
    raise SystemExit(f"seeded: there is no mutant {SUFFIX} at '{LINE}' in {FILE}")


def verdict(*arguments):
    return mutate("try", *arguments).split("\n")[-2].split("'  ")[-1].split()[0]


def main():
    key = find()
    caught = verdict(key) == "killed" and verdict(key, "--without", "test_names") == "survived"
    print(f"{int(caught)} of 1 seeded faults caught")
    return 0 if caught else 1


sys.exit(main())
