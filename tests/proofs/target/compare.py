#!/usr/bin/python3
"""Whether the target's tests are the host's, and ended the same. usage: compare HOST_LOG TARGET_LOG, both of `ctest -V`"""
import re
import sys

FUNCTION = re.compile(r"^(\d+): \S*?([^/\s]+\.c):\d+:(.+?):(PASS|FAIL|IGNORE)\b")
PROGRAM = re.compile(r"^\s*\d+/\d+ Test\s+#(\d+): (\S+) \.*\s*(?:\*\*\*)?(\S.*?)\s+[\d.]+ sec")


def outcomes(path):
    """What became of each program, and of each test function of it, by its name."""
    programs, functions = {}, []
    with open(path, encoding="utf-8", errors="replace") as log:
        for line in log:
            function, program = FUNCTION.match(line), PROGRAM.match(line)
            if function:
                functions.append(function.groups())
            elif program:
                programs[program.group(1)] = (program.group(2), program.group(3))
    found = {(name, ""): result for name, result in programs.values()}
    for number, source, name, result in functions:
        found[(programs.get(number, (source, ""))[0], name)] = result
    return found


def main():
    host, target = outcomes(sys.argv[1]), outcomes(sys.argv[2])
    wrong = [f"{' '.join(name)}: on the host {host.get(name, 'not there')}, on the target {target.get(name, 'not there')}"
             for name in sorted(host.keys() | target.keys())
             if host.get(name) != target.get(name) or host.get(name) not in ("PASS", "Passed")]
    functions = sum(name != "" for _, name in target)
    if wrong or functions == 0:
        print("\n".join(wrong or ["no test function ran"]))
        return 1
    print(f"{functions} test functions of {len(target) - functions} programs: the same on the host and on the target")
    return 0


sys.exit(main())
