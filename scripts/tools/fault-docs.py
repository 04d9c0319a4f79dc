#!/usr/bin/python3
"""The table of faults in docs/faults.md: what firmware/include/agv/fault_table.def says, and two columns of text.

Rewrites the table between its markers: rank, name, class, LED code and kind come from fault_table.def; "raised when" and
"counts in" are kept by hand, in the table itself, and stay with their fault. A fault that is new gets empty ones, to be
filled in.

--check: changes nothing; fails when the table is out of date, when a fault has no text, and when docs/faults.md or
docs/requirements.md name a fault that there is not.
"""
import argparse
import pathlib
import re
import sys

import tables
from tables import Problem

BEGIN = "<!-- fault table: made by scripts/tools/fault-docs.py, but for the two columns on the right -->"
END = "<!-- end of fault table -->"
HEADING = "| rank | fault | class | may be | kind | LED | also | raised when | counts in |"
NAMING = ("docs/faults.md", "docs/requirements.md")
# `LIKE_THIS`, `LIKE_THIS_*`: faults; what begins with one of these is a name of the C code
NAMED = re.compile(r"`([A-Z][A-Z0-9]*(?:_[A-Z0-9]+)+)(_\*)?`")
OTHERS = ("AGV_", "HAL_", "CONFIG_")


def made_cells(rank, name, fault_class, led, flags, event):
    other = "warn" if fault_class == "TRIP" else "trip"
    kind = "unresettable" if "UNRESETTABLE" in flags else "transient" if event else "condition"
    also = [word for flag, word in (("FROM_AI", "AI"), ("OF_EPS", "EPS")) if flag in flags]
    return [str(rank), f"`{name}`", fault_class.lower(), "-" if "FIXED" in flags else other, kind,
            f"{led:02}" if led else "-", ", ".join(also) or "-"]


def read_texts(table):
    """Fault -> its two text cells in the page."""
    texts = {}
    for line in table.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == HEADING.count("|") - 1 and cells[1].startswith("`"):
            texts[cells[1].strip("`")] = cells[-2:]
    return texts


def make_table(faults, texts):
    gone = sorted(set(texts) - {name for name, *_ in faults})
    if gone:
        raise Problem(f"docs/faults.md has a text for {', '.join(gone)}, which is not a fault: rename or remove the row")
    lines = [HEADING, "|" + "---|" * (HEADING.count("|") - 1)]
    for rank, fault in enumerate(faults):
        lines.append("| " + " | ".join(made_cells(rank, *fault) + texts.get(fault[0], ["", ""])) + " |")
    return "\n".join(lines)


def check_names(root, faults):
    """Every fault that a page names must be in the table."""
    names = [name for name, *_ in faults]
    for document in NAMING:
        for name, star in NAMED.findall((root / document).read_text(encoding="utf-8")):
            known = name in names if not star else any(other.startswith(name + "_") for other in names)
            if not known and not name.startswith(OTHERS):
                raise Problem(f"{document} names {name}{star}, which is not a fault")


def main():
    parser = argparse.ArgumentParser(description="the table of faults in docs/faults.md")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--check", action="store_true", help="change nothing, fail when the table is out of date or wrong")
    arguments = parser.parse_args()
    document = arguments.root / "docs/faults.md"
    faults = tables.faults(arguments.root)
    text = document.read_text(encoding="utf-8")
    texts = read_texts(tables.section("docs/faults.md", text, BEGIN, END)[1])
    wanted = tables.with_section("docs/faults.md", text, BEGIN, END, make_table(faults, texts))
    if not arguments.check:
        document.write_text(wanted, encoding="utf-8")
    elif wanted != text:
        raise Problem("docs/faults.md is out of date: run scripts/tools/fault-docs.py, then fill in the empty columns")
    empty = [name for name, *_ in faults if "" in texts.get(name, ["", ""])]
    if empty:
        raise Problem(f"docs/faults.md has no text for {', '.join(empty)}")
    if arguments.check:
        check_names(arguments.root, faults)
    print(f"{len(faults)} faults")


try:
    main()
except (Problem, OSError) as problem:
    print(f"fault-docs: {problem}", file=sys.stderr)
    sys.exit(1)
