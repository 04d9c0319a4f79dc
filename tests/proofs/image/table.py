#!/usr/bin/python3
"""Put together the tables of sweep: which instruction of which function each line is, and the places that do harm.

usage: table.py IMAGE TABLE... [--out FILE] [--sums PAGE] [--places PAGE] [--most SHARE]
       table.py OUT [--sums PAGE] [--places PAGE] [--most SHARE]

Prints the sums of each window, and the places that did harm (Markdown). OUT is what --out wrote, FILE.tsv or FILE.tsv.xz: its
pages are made anew without the image.
--out FILE: all lines, with function, source line and instruction. --sums PAGE, --places PAGE: puts the one or the other also
into this page, between `<!-- IMAGE -->` and `<!-- end -->`. --most SHARE: exit status 1 if more of 1000 disturbances did harm.
Exit status 1 also if a place that did harm has no cause in causes.tsv, and if the TABLEs are not all shards of one sweep.
"""
import argparse
import collections
import lzma
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
VERDICTS = ("same", "safe", "detected", "harmful")
HEAD = ["window", "index", "pc", "function", "source", "instruction", "disturbances", *VERDICTS, "harm"]
Line = collections.namedtuple("Line", "window index pc faults counts harms")
Place = collections.namedtuple("Place", "function source instruction")


def output_of(program, image, asked=None, options=()):
    """The lines that a program of the toolchain prints about the image."""
    ran = subprocess.run([f"arm-none-eabi-{program}", *options, image], input=asked, capture_output=True, text=True)
    if ran.returncode != 0:
        sys.exit(f"table: {program} cannot read {image}")
    return ran.stdout.splitlines()


def places_in(image, addresses):
    """Function (the innermost of inlined ones), source line and instruction of each address."""
    pathlib.Path(image).open("rb").close()
    texts = {}
    for line in output_of("objdump", image, options=["-d", "--no-show-raw-insn"]):
        match = re.match(r"^ *([0-9a-f]+):\t(.*)", line)
        if match:
            texts[int(match[1], 16)] = " ".join(match[2].split("@")[0].split())
    said = output_of("addr2line", image, "".join(f"{address:x}\n" for address in addresses), ["-f", "-e"])
    found = {}
    for i, address in enumerate(addresses):
        path, _, line = said[2 * i + 1].split(" ")[0].rpartition(":")
        source = "" if path.startswith("?") else f"{pathlib.Path(path).name}:{line}"
        found[address] = Place(said[2 * i].split(".")[0], source, texts.get(address, ""))
    return found


def read(table, places=None):
    """The lines of a table. If it has functions, source lines and instructions, they are put into places."""
    with (lzma.open if str(table).endswith(".xz") else open)(table, "rt", encoding="utf-8") as text:
        for number, line in enumerate(text, 1):
            fields = line.rstrip("\n").split("\t")
            if line.startswith("#") or fields == HEAD:
                continue
            try:
                window, index, pc, *place, faults, same, safe, detected, harmful, harms = fields
                read_line = Line(window, int(index), int(pc, 16), int(faults),
                                 [int(count) for count in (same, safe, detected, harmful)], harms)
                if len(place) != (0 if places is None else 3) or \
                        not re.fullmatch(r"(\w+(\.\d+)?=\w+( |$))*", harms) or len(harms.split()) != int(harmful):
                    raise ValueError
            except ValueError:
                sys.exit(f"table: {table}:{number}: no line of such a table")
            if places is not None:
                places[read_line.pc] = Place(*place)
            yield read_line


def check_heads(tables):
    """Each shard once, of one image, with one choice of disturbances: the first lines that sweep writes."""
    sweeps, shards = set(), []
    for table in tables:
        with open(table, encoding="utf-8") as text:
            head = re.fullmatch(r"# image (\w+), shard (\d+)/(\d+), (\w+ \d+)\n", text.readline())
        if not head:
            sys.exit(f"table: {table}: is no table of sweep")
        sweeps.add((head[1], head[3], head[4]))
        shards.append(int(head[2]))
    if len(sweeps) > 1:
        sys.exit("table: the tables are of several sweeps: another image, number of shards, or choice of disturbances")
    count = int(sweeps.pop()[1])
    wrong = [shard for shard in range(1, count + 1) if shards.count(shard) != 1]
    if wrong or len(shards) != count:
        sys.exit(f"table: shard {wrong[0] if wrong else max(shards)} of {count} is missing or given twice")


def sums_of(lines):
    """For each window, and for all: instructions, their disturbances, those that were done by verdict."""
    sums = collections.defaultdict(lambda: [0] * 6)
    for line in lines:
        for name in (line.window, "all"):
            for i, number in enumerate([1, line.faults, *line.counts]):
                sums[name][i] += number
    return sums


def page_of_sums(sums):
    yield "| window | instructions | disturbances of them | done | same | safe | detected | harmful |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, (count, faults, *verdicts) in sorted(sums.items(), key=lambda item: item[0] == "all"):
        done = sum(verdicts)
        shares = [f"{number:,} ({100 * number / max(done, 1):.2f} %)" for number in verdicts]
        yield f"| {name} | {count:,} | {faults:,} | {done:,} | {' | '.join(shares)} |"


def ranges_of(numbers):
    """`0 to 3 12 13`: three and more that follow each other are a range."""
    runs = []
    for number in sorted(numbers):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return " ".join(f"{run[0]} to {run[-1]}" if len(run) > 2 else " ".join(map(str, run)) for run in runs)


def words_of(disturbances):
    """`skip`, and of flips the bits: `skip, r3 bits 0 4`."""
    bits = collections.defaultdict(set)
    for disturbance in disturbances:
        register, _, bit = disturbance.partition(".")
        bits[register].update([int(bit)] if bit else [])
    return ", ".join(f"{register} bit{'s' if len(flipped) > 1 else ''} {ranges_of(flipped)}" if flipped else register
                     for register, flipped in sorted(bits.items(), key=lambda item: (item[0] != "skip", item[0])))


def read_causes():
    """The lines of causes.tsv. Each key is in the table of README.md."""
    known = re.findall(r"^\| (C\d+) \|", (HERE / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    causes = []
    for line in (HERE / "causes.tsv").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            function, harm, window, keys = (line.split("\t") + [""] * 4)[:4]
            unknown = set(keys.split()) - set(known)
            if unknown or not keys:
                sys.exit(f"table: causes.tsv: {function}, {harm}: README.md has no cause {' '.join(sorted(unknown)) or '-'}")
            causes.append((function, harm, window, keys.split()))
    return causes


def is_astray(place, disturbance):
    """A branch or a call that goes, or returns, to a wrong place."""
    is_branch = re.match(r"(b|bl|bx|blx|tbb|tbh|cbn?z|b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le))(\.[nw])? ", place.instruction)
    return bool(is_branch) and disturbance.partition(".")[0] in ("pc", "lr")


def causes_of(causes, place, harm, windows, disturbances):
    """The keys of a place in these windows; none if one of them has no line."""
    on_stack = re.match(r"(pop|push|(sub|add)(\.w)? sp,)|(ldmia|stmdb)(\.w)? sp!", place.instruction)
    name = "(stack)" if on_stack else place.function
    astray = [disturbance for disturbance in disturbances if is_astray(place, disturbance)]
    keys = {"C17"} if astray else set()
    for window in windows if len(astray) < len(disturbances) else ():
        fit = [line[3] for line in causes if line[0] == name and line[1] in (harm, "*") and line[2] in (window, "*")]
        if not fit:
            return []
        keys.update(fit[0])
    return sorted(keys, key=lambda key: int(key[1:]))


def page_of_places(lines, places, causes, missing):
    """One row for each instruction that did harm. What has no cause is added to missing."""
    found = collections.defaultdict(lambda: (set(), set()))
    for line in lines:
        for item in line.harms.split():
            disturbance, _, harm = item.partition("=")
            windows, disturbances = found[(line.pc, harm)]
            windows.add(line.window)
            disturbances.add(disturbance)
    yield "| function | source | instruction | disturbance | harm | windows | cause |"
    yield "|---|---|---|---|---|---|---|"
    for (pc, harm), (windows, disturbances) in sorted(found.items(), key=lambda item: (places[item[0][0]][:2], item[0])):
        place = places[pc]
        keys = causes_of(causes, place, harm, windows, disturbances)
        if not keys:
            missing.add(f"{place.function} ({harm})")
        yield (f"| `{place.function}` | {place.source} | `{place.instruction.split(' <')[0]}` | {words_of(disturbances)} | {harm} | "
               f"{', '.join(sorted(windows))} | {', '.join(keys)} |")


def put_into(page, name, text):
    """Between the marks of this image."""
    path = pathlib.Path(page)
    before, mark, rest = path.read_text(encoding="utf-8").partition(f"<!-- {name} -->\n")
    _, end, after = rest.partition("<!-- end -->\n")
    if not mark or not end:
        sys.exit(f"table: {page} has no marks of {name}")
    path.write_text(f"{before}{mark}\n{text}\n\n{end}{after}", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1][7:])
    parser.add_argument("image")
    parser.add_argument("tables", nargs="*")
    parser.add_argument("--out")
    parser.add_argument("--sums")
    parser.add_argument("--places")
    parser.add_argument("--most", type=float, default=1000)
    options = parser.parse_args()
    name = pathlib.Path(options.image).name.split(".")[0]
    places = {}
    if options.tables:
        check_heads(options.tables)
        lines = sorted(line for table in options.tables for line in read(table))
        places = places_in(options.image, sorted({line.pc for line in lines}))
    else:
        lines = list(read(options.image, places))
    if not lines:
        sys.exit("table: no lines")
    if options.out:
        with open(options.out, "w", encoding="utf-8") as out:
            out.write("\t".join(HEAD) + "\n")
            for window, index, pc, faults, counts, harms in lines:
                out.write("\t".join([window, str(index), f"{pc:x}", *places[pc], str(faults), *map(str, counts), harms]) + "\n")
    sums = sums_of(lines)
    verdicts = sums["all"][2:]
    done = sum(verdicts)
    share = 1000 * verdicts[3] / max(done, 1)
    missing = set()
    page = "\n".join(page_of_sums(sums))
    rows = "\n".join(page_of_places(lines, places, read_causes(), missing))
    print(f"{page}\n\n{rows}\n\n{done} disturbances: {verdicts[0]} same, {verdicts[1]} safe, {verdicts[2]} detected, "
          f"{verdicts[3]} harmful ({share:.2f} of 1000)", flush=True)
    if missing:
        sys.exit(f"table: causes.tsv has no cause of: {', '.join(sorted(missing))}")
    if options.sums:
        put_into(options.sums, name, page)
    if options.places:
        put_into(options.places, name, rows)
    if share > options.most:
        sys.exit(f"table: more than {options.most:g} of 1000 disturbances did harm")


try:
    main()
except (OSError, EOFError, UnicodeDecodeError, lzma.LZMAError) as error:
    sys.exit(f"table: {error}")
