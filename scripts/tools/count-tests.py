#!/usr/bin/python3
"""Count the tests of a ctest run. usage: ctest -V ... >LOG; count-tests LOG

Every Unity test function counts as one, every other ctest test as one. Prints `passed failed`. An
ignored function, a test that ctest did not run, and a program that fails without naming a function count as failed.
"""
import re
import sys

UNITY = re.compile(r"^(\d+): (\d+) Tests (\d+) Failures (\d+) Ignored")
RESULT = re.compile(r"^\s*\d+/\d+ Test\s+#(\d+): (\S+) \.*\s*(?:\*\*\*)?(\S.*?)\s+[\d.]+ sec")


def count(lines):
    functions, passed, failed = {}, 0, 0
    for line in lines:
        unity = UNITY.match(line)
        if unity:
            functions[unity.group(1)] = tuple(int(number) for number in unity.groups()[1:])
        result = RESULT.match(line)
        if not result:
            continue
        tests, failures, ignored = functions.get(result.group(1), (0, 0, 0))
        if result.group(3) == "Passed":
            passed += max(tests, 1)
        else:
            passed += tests - failures - ignored
            failed += max(failures + ignored, 1)
    return passed, failed


def main():
    with open(sys.argv[1], encoding="utf-8", errors="replace") as log:
        print(*count(log))


main()
