#!/usr/bin/python3
"""The tests that show each requirement and each fault.

Rows: requirements of docs/requirements.md, protocol decisions of docs/protocol.md (tables, `| SUP-1 | ...`), and faults
of firmware/include/agv/fault_table.def. Tests say what they show:
  C            /* Shows: SUP-2, VCU_HEARTBEAT_LOST */   directly above the test function, or ZTEST(suite, test)
  Python, bats # Shows: SUP-2                           directly above the test
  scenario     shows: [SUP-2, VCU_HEARTBEAT_LOST]       top-level key

A proof (tests/proofs) says it on a line `# Shows: SUP-2`, or `# Shows: -` when it is about something else. Code says it
by naming the row in a comment. A requirement or a fault whose row in docs/requirements.md or docs/faults.md says "not built
yet" needs neither.

Prints row -> tests. Fails on a row without a test, a level of evidence that no test has, a tag that names no row, stands
above no test or within another comment, a scenario without a tag, a C test that its folder's CMakeLists.txt does not build,
and a proof without a tag.
The pages: docs/traceability.md (the tests of each row) and docs/evidence.md (evidence.py).
"""
import argparse
import pathlib
import re
import sys

import evidence
import tables

FAMILIES = ("SUP", "FSM", "TOP", "TIM", "INT", "LED", "HW")
NOT_BUILT = "not built yet"
BEGIN, END = "<!-- traceability: made by scripts/tools/traceability.py --markdown -->", "<!-- end of traceability -->"
BY_ROW = "<!-- evidence by row: made by scripts/tools/traceability.py --markdown -->"
CLAIMS = "<!-- claims: command and figure made by scripts/tools/traceability.py --markdown, the other columns by hand -->"
CODE = ("firmware/include/agv", "firmware/src", "hal/include/hal", "firmware/zephyr/src")
PROOF_TAG = re.compile(r"^# Shows: (?P<rows>.*)$", re.MULTILINE)
C_TAG = re.compile(
    r"/\*\s*Shows:(?P<rows>[^*]*)\*/\s*(?:TEST_(?:CASE|RANGE|MATRIX)\(.*\)\s*)*(?:void\s+(?P<test>\w+)\s*\(void\)|"
    r"(?:static\s+)?void\s+(?P<parametrised>\w+)\s*\(|ZTEST\(\w+, (?P<ztest>\w+)\))?")
SCRIPT_TAG = re.compile(r"^\s*# Shows:(?P<rows>.*)\n(?:\s*@(?!test).*\n)*\s*(?:def (?P<python>\w+)|@test \"(?P<bats>[^\"]+)\")?",
                        re.MULTILINE)
SCENARIO_TAG = re.compile(r"^shows:\s*\[(?P<rows>[^\]]*)\]", re.MULTILINE)
# Where the evidence of a folder comes from.
EVIDENCE = {"tests/ports/linux": ["vcan"], "tests/vcan": ["vcan"], "tests/ports/zephyr/reset": ["emulated target"],
            "tests/ports/zephyr": ["native_sim", "emulated target"]}


def numbered(path, family, problems):
    """Rows `| FAMILY-n |` or `| Pn |` of a table, which count from 1 without a gap."""
    separator = "" if family == "P" else "-"
    if not path.exists():
        problems.append(f"{path} is missing")
        return []
    text = path.read_text(encoding="utf-8")
    found = re.findall(rf"^\|\s*\**{family}{separator}(\d+)\**\s*\|", text, re.MULTILINE)
    numbers = [int(number) for number in found]
    if (not numbers and family != "HW") or numbers != list(range(1, len(numbers) + 1)):
        problems.append(f"{path}: the rows {family}{separator}1 and on must each occur once, in order: {numbers}")
    return [f"{family}{separator}{number}" for number in numbers]


def read_rows(root, problems):
    rows = []
    for family in FAMILIES:
        rows += numbered(root / "docs/requirements.md", family, problems)
    rows += numbered(root / "docs/protocol.md", "P", problems)
    return rows + [fault.name for fault in tables.faults(root)]


def not_built(root):
    """Requirements and faults that their page says are not built yet."""
    text = (root / "docs/requirements.md").read_text(encoding="utf-8")
    if (root / "docs/faults.md").exists():
        text += (root / "docs/faults.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("|") and NOT_BUILT in line]
    return {match[1] for match in (re.match(r"\| (?:\d+ \| )?`?([A-Z]+-\d+|[A-Z_]+)`? \|", row) for row in rows) if match}


def tags_of(pattern, path, root, problems):
    """Every "Shows:" of a file; one that is part of another comment would be ignored."""
    text = path.read_text(encoding="utf-8")
    tags = list(pattern.finditer(text))
    if text.count("Shows:") != len(tags):
        problems.append(f"{path.relative_to(root)}: a 'Shows:' is not a comment of its own")
    return tags


def read_tags(root, problems):
    """(rows as text, name of the test, file) of every tag."""
    for path in sorted((root / "tests").rglob("*.c")):
        tags = tags_of(C_TAG, path, root, problems)
        lists = (path.parent.parent if path.parent.name == "src" else path.parent) / "CMakeLists.txt"
        if tags and not (lists.exists() and path.name in lists.read_text(encoding="utf-8")):
            problems.append(f"{path.relative_to(root)} is not built: {lists.relative_to(root)} does not name it")
        for tag in tags:
            test = tag["test"] or tag["parametrised"] or tag["ztest"]
            yield tag["rows"], test if test and test.startswith("test_") else None, path
    for path in sorted([*(root / "tests").rglob("*.py"), *(root / "tests").rglob("*.bats")]):
        for tag in tags_of(SCRIPT_TAG, path, root, problems):
            yield tag["rows"], tag["python"] or tag["bats"], path
    scenarios = {}
    for path in sorted((root / "host_sim/scenarios").glob("*/*.yaml")):
        other = scenarios.setdefault(path.stem, path)
        if other != path:
            problems.append(f"{path.relative_to(root)} has the name of {other.relative_to(root)}: demo --scenario takes a name")
        tag = SCENARIO_TAG.search(path.read_text(encoding="utf-8"))
        if tag:
            yield tag["rows"], path.stem, path
        else:
            problems.append(f"{path.relative_to(root)} does not say what it shows")


def trace(root, problems):
    """Row -> list of (test, file)."""
    shown = {row: [] for row in read_rows(root, problems)}
    for names, test, path in read_tags(root, problems):
        place = path.relative_to(root)
        if test is None:
            problems.append(f"{place}: a tag is not directly above a test: {names.strip()}")
        for name in filter(None, (name.strip() for name in names.replace("\n", " ").split(","))):
            if name not in shown:
                problems.append(f"{place}: {test} shows {name}, which is not a row")
            else:
                shown[name].append((test, place))
    waiting = not_built(root) if (root / "docs/requirements.md").exists() else set()
    for row, tests in shown.items():
        if not tests and row not in waiting:
            problems.append(f"no test shows {row}")
    return shown


def trace_proofs(root, rows, problems):
    """Row -> names of proofs."""
    proven = {row: [] for row in rows}
    for path in sorted((root / "tests/proofs").glob("*/run")):
        tag = PROOF_TAG.search(path.read_text(encoding="utf-8"))
        if not tag:
            problems.append(f"{path.relative_to(root)} does not say what it shows")
            continue
        for name in filter(lambda name: name not in ("", "-"), map(str.strip, tag["rows"].split(","))):
            if name not in proven:
                problems.append(f"{path.relative_to(root)} shows {name}, which is not a row")
            else:
                proven[name].append(path.parent.name)
    return proven


def trace_code(root, rows):
    """Row -> files of the core that name it."""
    named = {row: [] for row in rows}
    for folder in CODE:
        for path in sorted((root / folder).rglob("*.*")):
            for row in set(re.findall(r"\b(?:[A-Z]+-\d+|P\d+)\b", path.read_text(encoding="utf-8"))) & set(named):
                named[row].append(path)
    return named


def levels(root, problems):
    """The level of evidence of each requirement, as docs/requirements.md states it."""
    text = (root / "docs/requirements.md").read_text(encoding="utf-8")
    found = dict(re.findall(r"^\| ((?:%s)-\d+) \|.*\| ([^|]*) \|$" % "|".join(FAMILIES), text, re.MULTILINE))
    for row, level in found.items():
        if not level.startswith(("host", "vcan", "native_sim", "emulated target", "open")):
            problems.append(f"docs/requirements.md: {row} has no level of evidence: '{level}'")
    return found


def evidence_by_row(root, shown, problems):
    """A line for each requirement and protocol decision."""
    faults = {fault.name for fault in tables.faults(root)}
    level_of, waiting, rows = levels(root, problems), not_built(root), set(shown)
    code, proven, place_of = trace_code(root, shown), trace_proofs(root, shown, problems), evidence.places(root)
    others = [evidence.mutants(root, rows, problems), evidence.hazards(root, rows, problems), evidence.atlas(root, rows)]
    lines = ["| row | tests | proofs | mutants of the file | hunt | atlas | evidence | code |", "|---|---|---|---|---|---|---|---|"]
    for row in (row for row in shown if row not in faults):
        count = count_sources(shown[row])
        level = level_of.get(row, ", ".join(sorted(count)))
        for source in sorted({source for sources in EVIDENCE.values() for source in sources}):
            if source in level.split("; open")[0] and source not in count:
                problems.append(f"docs/requirements.md: {row} claims {source}, and no test there shows it")
        files = sorted({f"`{path.name}`" for path in code[row]})
        if not files and row in level_of and row not in waiting:
            problems.append(f"no code names {row}")
        tests = ", ".join(f"{number} {where}" for where, number in sorted(count.items()))
        cells = [f"[{row}]({place_of.get(row, 'requirements.md')})", tests or (NOT_BUILT if row in waiting else "**none**"),
                 ", ".join(f"`{name}`" for name in proven[row])]
        for cell in (other.get(row, "") for other in others):
            cells.append(cell if isinstance(cell, str) else ", ".join(cell))
        lines.append("| " + " | ".join(cell or "-" for cell in [*cells, level, ", ".join(files)]) + " |")
    return "\n".join(lines)


def count_sources(tests):
    """Where the tests run -> how many."""
    count = {}
    for _, place in tests:
        for source in sources_of(place):
            count[source] = count.get(source, 0) + 1
    return count


def sources_of(place):
    for folder, sources in EVIDENCE.items():
        if place.as_posix().startswith(folder + "/"):
            return sources
    return ["host"]


def markdown(shown, waiting):
    lines = ["| row | shown on | by |", "|---|---|---|"]
    for row, tests in shown.items():
        where = ", ".join(sorted({source for _, place in tests for source in sources_of(place)})) or "-"
        by_file = {}
        for test, place in tests:
            by_file.setdefault(place, []).append(test)
        cells = []
        for place, names in by_file.items():
            if place.suffix == ".yaml":
                cells.append(f"scenario `{place.stem}`")
            else:
                cells.append(f"`{place.stem}`: {', '.join(names)}")
        lines.append(f"| {row} | {where} | {'; '.join(cells) or (NOT_BUILT if row in waiting else '**nothing**')} |")
    return "\n".join(lines)


def bring_up_to_date(document, begin, section, write, problems):
    """Write a generated section, or compare it."""
    text = document.read_text(encoding="utf-8") if document.exists() else ""
    wanted = tables.with_section(document.name, text, begin, END, section)
    if write:
        document.write_text(wanted, encoding="utf-8")
    elif wanted != text:
        problems.append(f"docs/{document.name} is out of date: run scripts/tools/traceability.py --markdown")


def main():
    parser = argparse.ArgumentParser(description="row -> tests")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--markdown", action="store_true", help="rewrite the sections in traceability.md and evidence.md")
    parser.add_argument("--check", action="store_true", help="fail when they are not up to date")
    arguments = parser.parse_args()

    problems = []
    shown = trace(arguments.root, problems)
    for row, tests in shown.items():
        print(f"{row:28} {', '.join(f'{test} ({place})' for test, place in tests) or '-'}")

    docs = arguments.root / "docs"
    if (arguments.markdown or arguments.check) and (docs / "requirements.md").exists():
        section = markdown(shown, not_built(arguments.root))
        bring_up_to_date(docs / "traceability.md", BEGIN, section, arguments.markdown, problems)
        page = docs / "evidence.md"
        section = evidence.claims(arguments.root, CLAIMS, END, problems)
        bring_up_to_date(page, CLAIMS, section, arguments.markdown, problems)
        section = evidence_by_row(arguments.root, shown, problems)
        bring_up_to_date(page, BY_ROW, section, arguments.markdown, problems)
    sys.stdout.flush()
    for problem in problems:
        print(f"traceability: {problem}", file=sys.stderr)
    print(f"{len(shown)} rows, {sum(bool(tests) for tests in shown.values())} with a test, {len(problems)} problems")
    return 1 if problems else 0


sys.exit(main())
