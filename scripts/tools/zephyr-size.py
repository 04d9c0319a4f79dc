#!/usr/bin/python3
"""Flash and RAM of builds of the firmware, as a table. usage: zephyr-size [--write] BUILD...

Each BUILD is the build folder of firmware/zephyr. --write puts the table between its markers in docs/firmware.md.
Flash: code, constants and initial values. RAM: all static memory, with stacks and retained memory; there is no heap.
Stack: the deepest path through core, port and application by gcc's call graph (scripts/tools/stack-depth.py), without the frames of
Zephyr's functions below them.
"""
import argparse
import pathlib
import re
import subprocess
import sys

import tables

BEGIN = "<!-- size table: made by scripts/tools/zephyr-size.py -->"
END = "<!-- end of size table -->"
SIMULATED = "native_sim"


def refuse(reason):
    print(f"zephyr-size: {reason}", file=sys.stderr)
    sys.exit(2)


def symbols(build):
    text = (build / "zephyr/.config").read_text(encoding="utf-8")
    return dict(re.findall(r"^CONFIG_(\w+)=(.*)$", text, re.MULTILINE))


def kind(config):
    words = ["gateway" if "AGV_TOPOLOGY_GATEWAY" in config else "shared bus"]
    words += [word for name, word in (("AGV_RELEASE", "release"), ("AGV_SHELL", "shell"), ("AGV_SHADOW_ON", "shadow"),
                                    ("BOOTLOADER_MCUBOOT", "behind MCUboot"), ("AGV_UPDATE", "update"))
              if name in config]
    return ", ".join(words)


def stack(build):
    """The deepest path from main() on, without Zephyr's own functions."""
    graphs = sorted(map(str, build.glob("CMakeFiles/app.dir/**/*.ci")))
    if not graphs:
        refuse(f"{build} has no call graph: its compiler is not gcc")
    command = [pathlib.Path(__file__).resolve().parent / "stack-depth.py", *graphs, "--pointers-lead-outside", "--entry", "main"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        refuse(f"{build}: {done.stderr.strip()}")
    return int(re.match(r"stack +(\d+) bytes", done.stdout)[1])


def row(build):
    config = symbols(build)
    board = config["BOARD"].strip('"')
    if board == SIMULATED:
        return None
    sizes = subprocess.run(["arm-none-eabi-size", build / "zephyr/zephyr.elf"], check=True, capture_output=True, text=True)
    text, data, bss = (int(cell) for cell in sizes.stdout.splitlines()[1].split()[:3])
    return f"| `{board}` | {kind(config)} | {text + data} | {data + bss} | {stack(build)} | {config['MAIN_STACK_SIZE']} |"


def main():
    parser = argparse.ArgumentParser(description="flash and RAM of builds of the firmware")
    parser.add_argument("--write", action="store_true", help="into docs/firmware.md")
    parser.add_argument("builds", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    for build in arguments.builds:
        if not (build / "zephyr/.config").exists() or not list(build.glob("zephyr/zephyr.e*")):
            refuse(f"{build} is no build of Zephyr, or not a whole one")
    rows = sorted(filter(None, map(row, arguments.builds)))
    table = "\n".join(["| board | build | flash, bytes | RAM, bytes | deepest stack without Zephyr's | stack |",
                       "|---|---|---|---|---|---|", *rows])
    if not arguments.write:
        print(table)
        return
    page = pathlib.Path(__file__).resolve().parents[2] / "docs/firmware.md"
    page.write_text(tables.with_section(page, page.read_text(encoding="utf-8"), BEGIN, END, table), encoding="utf-8")


main()
