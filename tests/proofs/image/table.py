#!/usr/bin/python3
"""Put together the tables of sweep: which instruction of which function each line is, and the places that do harm.

usage: table.py IMAGE TABLE... [--out FILE] [--sums PAGE] [--places PAGE] [--most SHARE]

Prints the sums of each window, and the places that did harm (Markdown). --out FILE: all lines, with function, source line and
instruction. --sums PAGE, --places PAGE: puts the one or the other also into this page, between `<!-- IMAGE -->` and
`<!-- end -->`. --most SHARE: exit status 1 if more of 1000 disturbances did harm.
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
VERDICTS = ("same", "safe", "detected", "harmful")


def instructions(image):
    """The text of each instruction, by address."""
    texts = {}
    listing = subprocess.run(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", image], check=True, stdout=subprocess.PIPE,
                             text=True).stdout
    for line in listing.splitlines():
        match = re.match(r"^ *([0-9a-f]+):\t(.*)", line)
        if match:
            texts[int(match[1], 16)] = " ".join(match[2].split("@")[0].split())
    return texts


def sources(image, addresses):
    """Function (the innermost of inlined ones) and source line of each address."""
    asked = "".join(f"{address:x}\n" for address in addresses)
    said = subprocess.run(["arm-none-eabi-addr2line", "-f", "-e", image], input=asked, check=True, stdout=subprocess.PIPE,
                          text=True).stdout.splitlines()
    found = {}
    for i, address in enumerate(addresses):
        path, _, line = said[2 * i + 1].split(" ")[0].rpartition(":")
        shown = pathlib.Path(path).name
        found[address] = (said[2 * i].split(".")[0], "" if path.startswith("?") else f"{shown}:{line}")
    return found


def read(tables):
    """The lines of all tables."""
    for table in tables:
        for line in pathlib.Path(table).read_text(encoding="utf-8").splitlines():
            if not line.startswith("#"):
                window, index, pc, faults, *counts, harms = line.split("\t")
                yield window, int(index), int(pc, 16), int(faults), [int(count) for count in counts], harms


def sums_of(lines):
    """For each window, and for all: instructions, their disturbances, those that were done by verdict."""
    sums = collections.defaultdict(lambda: [0] * 6)
    for window, _, _, faults, counts, _ in lines:
        for name in (window, "all"):
            for i, number in enumerate([1, faults, *counts]):
                sums[name][i] += number
    return sums


def page_of_sums(sums):
    yield "| window | instructions | disturbances of them | done | same | safe | detected | harmful |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, (count, faults, *verdicts) in sorted(sums.items(), key=lambda item: item[0] == "all"):
        done = sum(verdicts)
        shares = [f"{number:,} ({100 * number / done:.2f} %)" for number in verdicts]
        yield f"| {name} | {count:,} | {faults:,} | {done:,} | {' | '.join(shares)} |"


def words_of(disturbances):
    """`skip`, and of flips the bits: `skip, r3 bits 0 4`."""
    bits = collections.defaultdict(set)
    for disturbance in disturbances:
        register, _, bit = disturbance.partition(".")
        bits[register].add(bit)
    words = []
    for register, flipped in sorted(bits.items(), key=lambda item: item[0] != "skip"):
        numbers = sorted(int(bit) for bit in flipped if bit)
        words.append(register if not numbers else f"{register} bit{'s' if len(numbers) > 1 else ''} "
                     + (f"{numbers[0]} to {numbers[-1]}" if len(numbers) > 4 else " ".join(map(str, numbers))))
    return ", ".join(words)


def page_of_places(lines, texts, places):
    """One row for each instruction that did harm."""
    found = collections.defaultdict(lambda: (set(), set()))
    for window, _, pc, _, _, harms in lines:
        for item in harms.split():
            disturbance, _, harm = item.partition("=")
            windows, disturbances = found[(pc, harm)]
            windows.add(window)
            disturbances.add(disturbance)
    yield "| function | source | instruction | disturbance | harm | windows |"
    yield "|---|---|---|---|---|---|"
    for (pc, harm), (windows, disturbances) in sorted(found.items(), key=lambda item: (places[item[0][0]], item[0])):
        function, source = places[pc]
        yield (f"| `{function}` | {source} | `{texts.get(pc, '').split(' <')[0]}` | {words_of(disturbances)} | {harm} | "
               f"{', '.join(sorted(windows))} |")


def put_into(page, image, text):
    """Between the marks of this image."""
    path = pathlib.Path(page)
    before, mark, rest = path.read_text(encoding="utf-8").partition(f"<!-- {pathlib.Path(image).name} -->\n")
    _, end, after = rest.partition("<!-- end -->\n")
    if not mark or not end:
        sys.exit(f"table: {page} has no marks")
    path.write_text(f"{before}{mark}\n{text}\n\n{end}{after}", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1][7:])
    parser.add_argument("image")
    parser.add_argument("tables", nargs="+")
    parser.add_argument("--out")
    parser.add_argument("--sums")
    parser.add_argument("--places")
    parser.add_argument("--most", type=float, default=1000)
    options = parser.parse_args()
    lines = sorted(read(options.tables))
    if not lines:
        sys.exit("table: no lines")
    texts = instructions(options.image)
    found_at = sources(options.image, sorted({line[2] for line in lines}))
    if options.out:
        with open(options.out, "w", encoding="utf-8") as out:
            out.write("window\tindex\tpc\tfunction\tsource\tinstruction\tdisturbances\t" + "\t".join(VERDICTS) + "\tharm\n")
            for window, index, pc, faults, counts, harms in lines:
                out.write("\t".join([window, str(index), f"{pc:x}", *found_at[pc], texts.get(pc, ""), str(faults),
                                     *map(str, counts), harms]) + "\n")
    sums = sums_of(lines)
    verdicts = sums["all"][2:]
    done = sum(verdicts)
    page = "\n".join(page_of_sums(sums))
    places = "\n".join(page_of_places(lines, texts, found_at))
    if options.sums:
        put_into(options.sums, options.image, page)
    if options.places:
        put_into(options.places, options.image, places)
    share = 1000 * verdicts[3] / done
    print(f"{page}\n\n{places}\n\n{done} disturbances: {verdicts[0]} same, {verdicts[1]} safe, {verdicts[2]} detected, "
          f"{verdicts[3]} harmful ({share:.2f} of 1000)")
    if share > options.most:
        sys.exit(f"table: more than {options.most} of 1000 did harm")


main()
