#!/usr/bin/python3
"""Flash, RAM and stack of the core on a Cortex-M4, -Os, after --gc-sections; fails above the limits.

Flash: the sections of the core's own objects that the linker kept for the entry points (code, constants, initial data),
without libc, HAL and recorder buffer. RAM: one agv_supervisor_t and the core's own variables. Stack: the deepest chain of
calls from an entry point.
Also fails when the core uses the heap or floating point, or recursion (INT-1).
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORE = "libagv_core_cortex-m4.a"
ENTRIES = ("agv_supervisor_start", "agv_supervisor_frame", "agv_supervisor_tick", "agv_supervisor_receive_alive")
SECTION = re.compile(r"^ (\.[\w.$-]+)\s+0x[0-9a-f]+\s+(0x[0-9a-f]+)\s+(\S.*)$")
FORBIDDEN = re.compile(r"^(malloc|calloc|realloc|free|__aeabi_[fd]\w+)$")


def fail(message):
    print(f"size: {message}", file=sys.stderr)
    sys.exit(1)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def kept_sections(map_file):
    """(section, bytes, object) of everything in the image. The map breaks a line after a long section name."""
    text = map_file.read_text(encoding="utf-8")
    image = text.split("Linker script and memory map", 1)[1]
    joined = re.sub(r"^( \.\S+)\n\s+", r"\1 ", image, flags=re.MULTILINE)
    for line in joined.splitlines():
        match = SECTION.match(line)
        if match:
            yield match.group(1), int(match.group(2), 16), match.group(3)


def core_bytes(map_file):
    """Bytes of the core's code, constants, initial data and zeroed data; and flash bytes by object."""
    total = {".text": 0, ".rodata": 0, ".data": 0, ".bss": 0}
    by_object = collections.Counter()
    for section, size, source in kept_sections(map_file):
        kind = "." + section.split(".")[1]
        if CORE in source and kind in total:
            total[kind] += size
            if kind != ".bss":
                by_object[source.split("(")[-1].rstrip(")")] += size
    return total, by_object


def supervisor_bytes(build):
    """sizeof(agv_supervisor_t), from an object that defines one."""
    (obj,) = build.glob("CMakeFiles/size_image.dir/**/size_image.c.o*")
    for line in run("arm-none-eabi-nm", "--print-size", str(obj)).splitlines():
        fields = line.split()
        if fields[-1] == "agv_size_supervisor":
            return int(fields[1], 16)
    return fail("the object has no agv_size_supervisor")


def check_symbols(image, core):
    """Every entry point must be in the image, and neither heap nor floating point may be used."""
    defined = run("arm-none-eabi-nm", "--defined-only", "--format=just-symbols", str(image)).split()
    missing = [name for name in ENTRIES if name not in defined]
    if missing:
        fail("not in the image: " + ", ".join(missing))
    undefined = run("arm-none-eabi-nm", "--undefined-only", "--format=just-symbols", str(core)).split()
    used = sorted({name for name in undefined + defined if FORBIDDEN.match(name)})
    if used:
        fail("the core uses " + ", ".join(used))


def flash_of(build):
    """Checks the image; flash and variables of the core in it, in bytes, and flash bytes by object."""
    image = build / "bin/size_image"
    if not image.exists():
        fail(f"{image} is not there: cmake --preset cortex-m && cmake --build --preset cortex-m")
    check_symbols(image, build / CORE)
    part, by_object = core_bytes(build / "size_image.map")
    flash = part[".text"] + part[".rodata"] + part[".data"]
    if flash == 0:
        fail("nothing of the core is in size_image.map")
    return flash, part[".data"] + part[".bss"], by_object


def stack_fails(build, limit):
    """Prints the deepest stack. Returns true if it is above the limit, or unlimited."""
    graphs = sorted(build.glob("CMakeFiles/agv_core_cortex-m4.dir/**/*.ci"))
    if not graphs:
        fail("no call graph of the core")
    command = [str(ROOT / "scripts/tools/stack-depth.py"), *map(str, graphs), "--objects", str(build / CORE), "--max", str(limit),
               "--entry", *ENTRIES]
    return subprocess.run(command, check=False).returncode != 0


def main():
    parser = argparse.ArgumentParser(description="flash, RAM and stack of the core on a Cortex-M4")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/cortex-m")
    parser.add_argument("--max-flash", type=int, default=20480)
    parser.add_argument("--max-ram", type=int, default=1024)
    parser.add_argument("--max-stack", type=int, default=512)
    parser.add_argument("--detail", action="store_true", help="also flash by object")
    arguments = parser.parse_args()
    build = arguments.build

    flash, variables, by_object = flash_of(build)
    supervisor = supervisor_bytes(build)
    ram = supervisor + variables
    print(f"flash  {flash:6} bytes of {arguments.max_flash}")
    print(f"RAM    {ram:6} bytes of {arguments.max_ram}  agv_supervisor_t {supervisor}, variables {ram - supervisor}")
    if arguments.detail:
        for name, size in by_object.most_common():
            print(f"       {size:6} bytes  {name}")
    sys.stdout.flush()
    deep = stack_fails(build, arguments.max_stack)
    if flash > arguments.max_flash or ram > arguments.max_ram:
        fail("over the limit")
    return 1 if deep else 0


sys.exit(main())
