#!/usr/bin/python3
"""Write the checksum of the program into a Zephyr image, after it was linked (HW-4).

usage: zephyr-checksum.py --objcopy OBJCOPY FOLDER

FOLDER has zephyr.elf; what the build made of it (zephyr.bin, zephyr.hex, zephyr.strip) is made anew. The table zephyr_image_sum of
hal/zephyr/src/zephyr_self_test.c receives the ranges of the program in flash and their CRC-32. The table itself, and gaps
between sections, which programmers fill as they like, belong to no range.
"""
import argparse
import pathlib
import struct
import subprocess
import sys
import zlib

from elftools.elf.elffile import ELFFile

TABLE = "zephyr_image_sum"
VECTORS = "_vector_start"
MAGIC = 0x53564741
RANGES_MAX = 16
HEAD = struct.Struct("<III")
RANGE = struct.Struct("<II")
PROGRAM = ("--gap-fill", "0xff", "--remove-section=.comment", "--remove-section=COMMON", "--remove-section=.eh_frame")
# What Zephyr's build makes of zephyr.elf, and how.
FORMS = {
    "zephyr.bin": ("--output-target=binary", *PROGRAM),
    "zephyr.hex": ("--output-target=ihex", *PROGRAM),
    "zephyr.strip": ("--strip-all",),
}


class Refused(Exception):
    """One line for the user."""


def places(elf, address, size):
    """The place in flash and in the file of an address of the running program; None if it is not loaded."""
    for segment in elf.iter_segments("PT_LOAD"):
        offset = address - segment["p_vaddr"]
        if 0 <= offset and offset + size <= segment["p_filesz"]:
            return offset + segment["p_paddr"], offset + segment["p_offset"]
    return None


def contents(elf):
    """(place in flash, bytes) of each section that is programmed."""
    found = []
    for section in elf.iter_sections():
        size = section["sh_size"]
        if section["sh_flags"] & 2 and section["sh_type"] != "SHT_NOBITS" and size:
            found_at = places(elf, section["sh_addr"], size)
            if found_at is not None:
                found.append((found_at[0], section.data()))
    return sorted(found)


def symbol(elf, name):
    symbols = elf.get_section_by_name(".symtab").get_symbol_by_name(name)
    if not symbols:
        raise Refused(f"the program has no {name}: is hal/zephyr/src/zephyr_self_test.c linked?")
    return symbols[0]


def cut(pieces, start, end):
    """The pieces without what lies in start..end."""
    for place, data in pieces:
        below = max(0, min(len(data), start - place))
        above = max(0, min(len(data), end - place))
        if below:
            yield place, data[:below]
        if above < len(data):
            yield place + above, data[above:]


def merge(pieces):
    merged = []
    for place, data in pieces:
        if merged and merged[-1][0] + len(merged[-1][1]) == place:
            merged[-1] = (merged[-1][0], merged[-1][1] + data)
        else:
            merged.append((place, data))
    return merged


def table_of(pieces):
    if len(pieces) > RANGES_MAX:
        raise Refused(f"the program has {len(pieces)} ranges in flash; zephyr_image_sum_t has room for {RANGES_MAX}")
    crc = 0
    for _, data in pieces:
        crc = zlib.crc32(data, crc)
    ranges = b"".join(RANGE.pack(place, len(data)) for place, data in pieces)
    return HEAD.pack(MAGIC, len(pieces), crc) + ranges.ljust(RANGES_MAX * RANGE.size, b"\0")


def patch(path):
    with path.open("rb") as file:
        elf = ELFFile(file)
        table = symbol(elf, TABLE)
        start, offset = places(elf, table["st_value"], table["st_size"])
        first = symbol(elf, VECTORS)["st_value"]  # before it a bootloader keeps its header
        pieces = merge(cut(cut(contents(elf), 0, first), start, start + table["st_size"]))
        content = table_of(pieces)
        if len(content) != table["st_size"]:
            raise Refused(f"{TABLE} has {table['st_size']} bytes, not {len(content)}")
    with path.open("r+b") as file:
        file.seek(offset)
        file.write(content)
    return sum(len(data) for _, data in pieces), len(pieces)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objcopy", required=True)
    parser.add_argument("folder", type=pathlib.Path)
    arguments = parser.parse_args()
    elf = arguments.folder / "zephyr.elf"
    try:
        size, ranges = patch(elf)
    except (OSError, Refused) as error:
        sys.exit(f"zephyr-checksum: {error}")
    for name, options in FORMS.items():
        made = arguments.folder / name
        if made.exists():
            subprocess.run([arguments.objcopy, *options, elf, made], check=True)
    print(f"checksum of {size} bytes of program in {ranges} ranges")


if __name__ == "__main__":
    main()
