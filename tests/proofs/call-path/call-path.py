#!/usr/bin/python3
"""How far a reader of the core has to follow one call of it.

Compiles the core without optimisation and with -finstrument-functions, runs tests/proofs/call-path/call_path.c on it, and counts for a
healthy status frame (363h in ACTIVE), a tick on which nothing is due, and a frame that trips:
  calls      functions of the core that are entered, the entry point among them
  changes    how often a function is entered that lies in another source file than the one entered before
  levels     depth of the deepest call, the entry point is level 1
  functions  different ones among the calls, and in how many files they lie

usage: call-path [--root ROOT] [--tree NAME]     ROOT: the project, or an older version of it, whose core is measured
--tree prints the calls of one of the three, indented, each with its file. --max NAME=CALLS/CHANGES/LEVELS fails above that.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
SUPPORT = ROOT / "tests/support"
DRIVER = [ROOT / "tests/proofs/call-path/call_path.c", SUPPORT / "null_hal.c", SUPPORT / "traffic.c"]


def fail(message):
    print(f"call-path: {message}", file=sys.stderr)
    sys.exit(1)


def run(*command):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{command[0]}: {done.stderr or done.stdout}")
    return done.stdout


def build(root, folder):
    """The program, with the core of this version in it."""
    includes = [f"-I{root / name}" for name in ("firmware/include", "firmware/src", "hal/include")]
    sources = [path for path in sorted((root / "firmware/src").rglob("*.c")) if path.name != "names.c"]
    if not sources:
        fail(f"there is no core in {root}")
    options = ["-std=c11", "-O0", "-g", "-w", "-no-pie", *includes]
    for number, source in enumerate(sources):
        run("gcc", *options, "-finstrument-functions", "-c", source, "-o", folder / f"{number}.o")
    program = folder / "call_path"
    run("gcc", *options, f"-I{SUPPORT}", *DRIVER, *sorted(folder.glob("*.o")), "-o", program)
    return program


def places(program, addresses):
    """Address -> (function, file)."""
    lines = run("addr2line", "-f", "-e", program, *addresses).splitlines()
    return {address: (lines[2 * i], pathlib.Path(lines[2 * i + 1].split(":")[0]).name) for i, address in enumerate(addresses)}


def traces(program):
    """Name -> list of addresses entered, None for a return."""
    found = {}
    for line in run(program).splitlines():
        if line.startswith("> "):
            found[name].append(line[2:])
        elif line == "<":
            found[name].append(None)
        else:
            name = line
            found[name] = []
    return found


def measure(trace, place):
    """(calls, changes of file, levels, functions, files) of one call."""
    entered = [place[address] for address in trace if address]
    changes = sum(before[1] != after[1] for before, after in zip(entered, entered[1:]))
    depth = levels = 0
    for address in trace:
        depth += 1 if address else -1
        levels = max(levels, depth)
    return len(entered), changes, levels, len(set(entered)), len({file for _, file in entered})


def print_tree(trace, place):
    depth = 0
    for address in trace:
        if address is None:
            depth -= 1
        else:
            function, file = place[address]
            print(f"{'  ' * depth}{function}  ({file})")
            depth += 1


def main():
    parser = argparse.ArgumentParser(description="calls, changes of file and levels of one call of the core")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    parser.add_argument("--tree", metavar="NAME", help="status frame, tick, or trip")
    parser.add_argument("--max", metavar="NAME=CALLS/CHANGES/LEVELS", action="append", default=[])
    arguments = parser.parse_args()
    limits = dict(limit.split("=") for limit in arguments.max)
    with tempfile.TemporaryDirectory() as folder:
        program = build(arguments.root.resolve(), pathlib.Path(folder))
        found = traces(program)
        place = places(program, sorted({address for trace in found.values() for address in trace if address}))
    if not set(limits) <= set(found) or (arguments.tree and arguments.tree not in found):
        fail(f"known are {', '.join(found)}")
    if arguments.tree:
        print_tree(found[arguments.tree], place)
        return
    above = []
    for name, trace in found.items():
        figures = measure(trace, place)
        print(f"{name:14} {figures[0]:4} calls, {figures[1]:4} changes of file, {figures[2]:3} levels; "
              f"{figures[3]:3} functions in {figures[4]} files")
        highest = tuple(map(int, limits[name].split("/"))) if name in limits else figures
        if any(figure > most for figure, most in zip(figures, highest)):
            above.append(f"{name}: above {limits[name]}")
    if above:
        fail("; ".join(above))


main()
