"""The two tables of docs/evidence.md, for traceability.py: what was shown how, and one line for each row.

Tables that are read:
  docs/evidence.md                      claim, way and what is not shown, by hand; [`name`] in the second column is a proof of
                                        tests/proofs, or a name of figures.tsv
  tests/proofs/figures.tsv              commands (with "; " between them), date, revision and figure of a name
                                        (scripts/verify --record)
  tests/proofs/seeded.tsv               the stored mutant of a row (checker `row`): the file that is changed
  tests/proofs/mutation/figures.tsv     mutants of a file (mutate.py merge --record), once they were all tried
  docs/hunt.md                          the rows that a hazard judges
  docs/faults.md                        the rows that a fault belongs to
  host_sim/campaign/campaign_rows.c     the faults that the atlas combines
"""
import collections
import re

Figure = collections.namedtuple("Figure", "command date revision text")

HEADING = "| claim | shown how | command | figure | not shown |"
NAME = re.compile(r"\[`([\w-]+)`\]")
FIGURES = "tests/proofs/figures.tsv"
TITLES = ("killed", "crashed", "timed out", "found by a sanitizer", "survived", "equivalent")


def read_table(root, place, columns, problems):
    """The lines of a file with tabs, by their first word."""
    found, path = {}, root / place
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    for number, line in enumerate(lines, 1):
        cells = line.split("\t")
        if line.startswith("#") or not line:
            continue
        if len(cells) != columns or "" in cells:
            problems.append(f"{place}:{number}: expected {columns} columns with a text in each")
        elif cells[0] in found:
            problems.append(f"{place}:{number}: {cells[0]} has a line already")
        else:
            found[cells[0]] = cells[1:]
    return found


def figure_cells(names, figures):
    """Command and figure of the names of one line."""
    commands, texts = [], []
    for name in names:
        figure = figures.get(name, Figure(f"scripts/verify {name}", "-", "-", "not recorded"))
        when = "" if figure.date == "-" else f" ({figure.date}, `{figure.revision}`)"
        commands += [f"`{command}`" for command in figure.command.split("; ")]
        texts.append((f"`{name}`: " if len(names) > 1 else "") + figure.text + when)
    return ["<br>".join(commands), "<br>".join(texts)]


def claims(root, begin, end, problems):
    """The table of the page, with its two middle columns made anew."""
    page = root / "docs/evidence.md"
    table = page.read_text(encoding="utf-8").split(begin)[-1].split(end)[0] if page.exists() else ""
    proofs = {path.parent.name for path in (root / "tests/proofs").glob("*/run")}
    figures = {name: Figure(*cells) for name, cells in read_table(root, FIGURES, 5, problems).items()}
    lines, seen = [HEADING, "|" + "---|" * (HEADING.count("|") - 1)], []
    for line in table.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|") or line.startswith(("| claim ", "|---")):
            continue
        if len(cells) != 5:
            problems.append(f"docs/evidence.md: not five columns: {line[:60]}")
            continue
        names = NAME.findall(cells[1])
        problems += [f"docs/evidence.md: {name} is neither a proof nor a line of {FIGURES}"
                     for name in names if name not in proofs | figures.keys()]
        if not names or "" in (cells[0], cells[4]):
            problems.append(f"docs/evidence.md: a line needs a claim, a [`proof`] and what is not shown: {line[:60]}")
        seen += names
        lines.append("| " + " | ".join([*cells[:2], *figure_cells(names, figures), cells[4]]) + " |")
    problems += [f"docs/evidence.md has {seen.count(name)} lines for the proof {name}, not one"
                 for name in sorted(proofs | figures.keys()) if seen.count(name) != 1]
    return "\n".join(lines)


def hazards(root, rows, problems):
    """Row -> hazards of the hunt that judge it."""
    judged = collections.defaultdict(list)
    text = (root / "docs/hunt.md").read_text(encoding="utf-8")
    for hazard, names in re.findall(r"^\| (H\d+) \| .* \| ([^|]*) \|$", text, re.MULTILINE):
        for name in map(str.strip, names.split(",")):
            if name not in rows:
                problems.append(f"docs/hunt.md: {hazard} judges {name}, which is not a row")
            judged[name].append(hazard)
    return judged


def mutants(root, rows, problems):
    """Row -> file of its stored mutant, and what became of the mutants of this file."""
    counts = read_table(root, "tests/proofs/mutation/figures.tsv", 1 + len(TITLES), problems)
    cells = {}
    for line in (root / "tests/proofs/seeded.tsv").read_text(encoding="utf-8").splitlines():
        checker, row, _, path = (line.split("\t") + 4 * [""])[:4]
        if checker != "row":
            continue
        if row not in rows:
            problems.append(f"tests/proofs/seeded.tsv: {row} is not a row")
        file = path.rsplit("/", 1)[-1]
        of = [f"{number} {title}" for number, title in zip(counts.get(file, []), TITLES) if number != "0"]
        cells[row] = f"`{file}`" + (f": {', '.join(of)}" if of else "")
    return cells


def atlas(root, rows):
    """Row -> how many of its faults the atlas combines."""
    table = (root / "host_sim/campaign/campaign_rows.c").read_text(encoding="utf-8")
    caused = set(re.findall(r"\bROW(?:_AFTER)?\(([A-Z]\w+)", table))
    of_row = collections.defaultdict(list)
    for line in (root / "docs/faults.md").read_text(encoding="utf-8").splitlines():
        fault = re.match(r"\| \d+ \| `(\w+)` \|", line)
        for row in sorted(set(re.findall(r"\b(?:[A-Z]+-\d+|P\d+)\b", line)) & rows if fault else ()):
            of_row[row].append(fault[1])
    cells = {}
    for row, faults in of_row.items():
        without = [f"`{fault}`" for fault in faults if fault not in caused]
        cells[row] = f"{len(faults) - len(without)} of {len(faults)}" + (f", not {', '.join(without)}" if without else "")
    return cells


def places(root):
    """Row -> page and heading."""
    found = {}
    for page, rows in (("requirements.md", r"[A-Z]+-\d+"), ("protocol.md", r"P\d+")):
        heading = ""
        for line in (root / "docs" / page).read_text(encoding="utf-8").splitlines():
            row = re.match(rf"\| \**({rows})\** \|", line)
            if line.startswith("## "):
                heading = re.sub(r"[^\w -]", "", line[3:].lower()).replace(" ", "-")
            elif row:
                found.setdefault(row[1], f"{page}#{heading}")
    return found
