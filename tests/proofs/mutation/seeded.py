#!/usr/bin/python3
"""Seeded faults of mutate: what it must not count as killed, and what it must report."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SCRATCH = ROOT / "build/mutation"
# agv_missing_name is called by test_names alone
BY_ONE_TEST = "return:NULL", "missing_names[index]"
HARMLESS = """SUP-2 liveness.c
- const bool recent = age_ms <= (2u * agv_message_cycle_ms(message));
+ const bool recent = age_ms <= (agv_message_cycle_ms(message) * 2u);
"""


def mutate(*arguments):
    done = subprocess.run([HERE / "mutate.py", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


def find(file, suffix, text):
    """The mutant with this end of its id on the line that holds the text."""
    (path,) = (ROOT / "firmware/src").rglob(file)
    lines = path.read_text(encoding="ascii").splitlines()
    for key in mutate("list", file)[1].split():
        if key.endswith(suffix) and text in lines[int(key.split(":")[1]) - 1]:
            return key
    raise SystemExit(f"seeded: there is no mutant {suffix} at '{text}' in {file}")


def verdict(key, *options):
    return mutate("try", key, *options)[1].split("\n")[-2].split("'  ")[-1].split()[0]


def without_its_test(_):
    """A mutant that one test kills survives without that test."""
    key = find("names.c", *BY_ONE_TEST)
    return verdict(key) == "killed" and verdict(key, "--without", "test_names") == "survived"


def merged(folder, survives):
    """What merge says of results in which all other mutants are killed."""
    results = folder / "results.jsonl"
    with open(results, "w", encoding="utf-8") as out:
        for number, key in enumerate(mutate("list")[1].split()):
            out.write(json.dumps({"id": key, "verdict": "survived" if survives(number) else "killed", "by": ""}) + "\n")
    empty = folder / "equivalents"
    empty.touch()
    return mutate("merge", str(results), "--equivalents", str(empty))


def too_few(folder):
    """One of 25 is not killed: passes; one of 16: does not."""
    good, _ = merged(folder, lambda number: number % 25 == 0)
    status, said = merged(folder, lambda number: number % 16 == 0)
    return good == 0 and status != 0 and "are killed by an assertion, 95.0 % are asked for" in said


def harmless_row(folder):
    (folder / "rows").write_text(HARMLESS, encoding="ascii")
    status, said = mutate("rows", "SUP-2", "--rows", str(folder / "rows"))
    return status != 0 and "SUP-2: liveness.c" in said and "no test that names the row fails" in said


SEEDED = (without_its_test, too_few, harmless_row)


def main():
    SCRATCH.mkdir(parents=True, exist_ok=True)
    caught = 0
    for fault in SEEDED:
        folder = pathlib.Path(tempfile.mkdtemp(prefix="seeded-", dir=SCRATCH))
        found = fault(folder)
        shutil.rmtree(folder)
        caught += found
        print(f"{fault.__name__.replace('_', ' '):24} {'caught' if found else 'NOT CAUGHT'}", flush=True)
    print(f"{caught} of {len(SEEDED)} seeded faults caught")
    return 0 if caught == len(SEEDED) else 1


sys.exit(main())
