#!/usr/bin/python3
"""How far a reader of the core has to follow one call of it.

Runs call_path.c on the core, which is compiled without optimisation, and counts for a healthy status frame (363h in
ACTIVE), a tick on which nothing is due, and a frame that trips:
  calls      functions of the core that are entered, the entry point among them
  changes    how often a function is entered that lies in another source file than the one entered before
  levels     depth of the deepest call, the entry point is level 1
  functions  different ones among the calls, and in how many files they lie

usage: call-path.py [--tree NAME]     prints the calls of one of the three, indented, each with its file
"""
import argparse
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = ROOT / "build/host/bin/call_path"


def fail(message):
    print(f"call-path: {message}", file=sys.stderr)
    sys.exit(1)


def run(*command):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{command[0]}: {done.stderr or done.stdout}")
    return done.stdout


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
    parser.add_argument("--tree", metavar="NAME", help="status frame, tick, or trip")
    arguments = parser.parse_args()
    run("cmake", "--preset", "host", "-S", ROOT)
    run("cmake", "--build", ROOT / "build/host", "--target", "call_path")
    found = traces(PROGRAM)
    place = places(PROGRAM, sorted({address for trace in found.values() for address in trace if address}))
    if arguments.tree:
        if arguments.tree not in found:
            fail(f"known are {', '.join(found)}")
        print_tree(found[arguments.tree], place)
        return
    for name, trace in found.items():
        calls, changes, levels, functions, files = measure(trace, place)
        print(f"{name:14} {calls:4} calls, {changes:4} changes of file, {levels:3} levels; {functions:3} functions in {files} files")


main()
