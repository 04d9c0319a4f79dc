#!/usr/bin/python3
"""Other CAN tools with host_sim run. usage: with-vcan run_clients.py [--lanes N] [--quick] [NAME...]

Runs the tests of test_clients.py and test_python_can.py, several at a time, each on buses of its own: all of them, or
those that are not marked as long. HOST_SIM in the environment is the program. Prints what it ran on and what candump saw.
Fails when a test fails, a tool is missing, or fewer tests ran than there are to be.
"""
import argparse
import io
import json
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import time
import traceback
import unittest

EXPECTED_TESTS = 24
EXPECTED_QUICK_TESTS = 14
FILES = ("test_clients", "test_python_can")


def missing_tools():
    import clients
    missing = [tool for tool in clients.TOOLS if shutil.which(tool) is None]
    if subprocess.run(["/usr/bin/python3", "-c", "import importlib.util, sys; sys.exit(not importlib.util.find_spec('can'))"],
                      check=False).returncode != 0:
        missing.append("python3-can")
    return missing


def bring_programs():
    """Copy all programs that the tests start into memory."""
    import clients
    import in_memory
    into = in_memory.folder()
    if into:
        in_memory.bring([shutil.which(tool) for tool in clients.TOOLS] + [os.environ["HOST_SIM"]], into)
        clients.PROGRAM = os.path.join(into, os.path.basename(os.environ["HOST_SIM"]))


def names_of(file, quick):
    """The tests of a file, without importing it: python-can takes long. quick: those that are not @clients.long"""
    import ast
    tree = ast.parse((pathlib.Path(__file__).parent / (file + ".py")).read_text(encoding="utf-8"))
    return ["%s.%s.%s" % (file, case.name, test.name) for case in tree.body if isinstance(case, ast.ClassDef)
            for test in case.body if isinstance(test, ast.FunctionDef) and test.name.startswith("test_")
            and not (quick and "clients.long" in map(ast.unparse, test.decorator_list))]


def run_one(name):
    """(name, seconds, {bus: frames recorded by candump}, problem)"""
    begin = time.monotonic()
    try:
        case = unittest.defaultTestLoader.loadTestsFromName(name)
        result = unittest.TextTestRunner(stream=io.StringIO(), verbosity=0).run(case)
        wrong = "".join(text for _, text in result.failures + result.errors)
        if not wrong and (result.testsRun != 1 or result.skipped):
            wrong = "%d tests ran, %d skipped" % (result.testsRun, len(result.skipped))
        import clients
        tally = dict(clients.LAST_TALLY)
    except Exception:
        wrong, tally = traceback.format_exc(), {}
    return name, time.monotonic() - begin, tally, wrong


def lane(names, results):
    """A process of its own, which gets its tests through a pipe, one a line."""
    for name in names:
        results.write(json.dumps(run_one(name)) + "\n")
        results.flush()


def fork(names):
    """Run these in a process of their own. Gives its number and the end of a pipe with the results."""
    reading, writing = os.pipe()
    number = os.fork()
    if number == 0:
        os.close(reading)
        try:
            with os.fdopen(writing, "w") as results:
                lane(names, results)
        finally:
            sys.stdout.flush()
            os._exit(0)
    os.close(writing)
    return number, os.fdopen(reading)


class Queue:
    """Names, each of which one lane takes: a byte in a pipe is a number."""

    def __init__(self, names):
        self.names = names
        self.reading, writing = os.pipe()
        os.write(writing, bytes(range(len(names))))
        os.close(writing)

    def __iter__(self):
        while place := os.read(self.reading, 1):
            yield self.names[place[0]]


def choose(files, wanted, quick):
    """{file: names of its tests that are to run}, and how many there are"""
    names = {file: names_of(file, quick) for file in files}
    chosen = {file: [name for name in names[file] if not wanted or any(word in name for word in wanted)] for file in files}
    return chosen, sum(map(len, names.values()))


def run_all(chosen, files, lanes):
    chosen = dict(chosen)
    slow = [chosen.pop(file) for file in files[1:]]  # a lane of their own, from the start on: imports take long
    queue = Queue([name for names in chosen.values() for name in names])
    children = [fork(names) for names in slow if names] + [fork(queue) for _ in range(lanes)]
    results = []
    import selectors
    selector = selectors.DefaultSelector()
    for _, pipe in children:
        selector.register(pipe, selectors.EVENT_READ)
    while selector.get_map():
        for event, _ in selector.select():
            line = event.fileobj.readline()
            if line:
                results.append(json.loads(line))
                report(*results[-1])
            else:
                selector.unregister(event.fileobj)
    for number, _ in children:
        os.waitpid(number, 0)
    return results


def report(name, seconds, tally, wrong):
    seen = ", ".join("%d" % count for count in tally.values())
    print("%-6s %-76s %5.1f s  candump: %s" % ("FAILED" if wrong else "ok", name.split(".", 1)[1], seconds, seen), flush=True)
    if wrong:
        print(wrong, flush=True)


def reason(traceback_text):
    """The line of a traceback that names the exception, the last one."""
    named = [line for line in traceback_text.splitlines() if re.match(r"[\w.]*(Error|Exception|HeldUp|Expired)\b", line)]
    return (named or ["?"])[-1][:500]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--lanes", type=int, default=2)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("names", nargs="*")
    args = parser.parse_args()
    if not os.access(os.environ.get("HOST_SIM", ""), os.X_OK):
        sys.exit("run_clients: HOST_SIM in the environment must be a program")
    missing = missing_tools()
    if missing:
        sys.exit("run_clients: missing: %s; 'scripts/install-deps vcan' installs them" % ", ".join(missing))
    begin = time.monotonic()
    bring_programs()
    chosen, there_are = choose(FILES, args.names, args.quick)
    results = run_all(chosen, FILES, args.lanes)
    wrongs = {name: wrong for name, _, _, wrong in results if wrong}
    failed = list(wrongs)
    print("\nkernel: %s %s" % (platform.release(), platform.machine()))
    print(subprocess.run(["ip", "-d", "link", "show", "type", "vcan"], stdout=subprocess.PIPE, check=True,
                         text=True).stdout.rstrip())
    frames = [count for _, _, tally, _ in results for count in tally.values()]
    print("candump saw %d frames on %d buses; the buses of the tests are made like these and removed again" %
          (sum(frames), len(frames)))
    times = os.times()
    print("%.0f s by the clock in here, %.0f s of a processor" % (time.monotonic() - begin, sum(times[:4])))
    expected = sum(map(len, chosen.values()))
    there_should = EXPECTED_QUICK_TESTS if args.quick else EXPECTED_TESTS
    if there_are < there_should or len(results) < expected:
        failed.append("run_clients")
        print("FAILED: %d of %d tests ran, and there are %d, not %d" % (len(results), expected, there_are, there_should))
    for name, wrong in wrongs.items():  # once more: the last lines are what one sees
        print("FAILED %s: %s" % (name, reason(wrong)))
    print("%d Tests %d Failures 0 Ignored" % (max(len(results), len(failed)), len(failed)))
    sys.exit(1 if failed or not results else 0)


if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).parent))
    main()
