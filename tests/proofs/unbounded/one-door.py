#!/usr/bin/python3
"""Nothing but the state machine writes its memory, and the supervisor calls it in three known places only.

    one-door.py [ROOT]

gcc checks a copy of firmware/ in which the state machine and the memory of a supervisor are `const`. It then reports each place
that writes them, or that hands them on to be written. It also reports each use of a function that starts the state machine, or
that writes bytes. A search of the text finds what gcc lets pass. All that is found must be in the lists below, as often as there.
"""
import collections
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TREE = pathlib.Path(__file__).resolve().parents[3]
START, PASS, TOP, CORE = ("firmware/src/supervisor/" + name for name in (
    "supervisor_start.c", "supervisor_pass.c", "supervisor.c", "core.h"))
SUMS = "firmware/src/base/checksum.c"

# Changes of the copy. Each old text occurs once.
CHANGES = (
    (CORE, "    agv_state_machine_t machine;", "    const agv_state_machine_t machine;"),
    ("firmware/include/agv/supervisor.h", "unsigned char memory[", "const unsigned char memory["),
    (START, "static void begin_modules(", "__attribute__((deprecated)) static void begin_modules("),
    (START, "static void begin_state(", "__attribute__((deprecated)) static void begin_state("),
)
# Functions whose uses are reported: those that start the state machine; and in the sources of the supervisor those that write
# bytes. Other modules do not know the core (scripts/tools/check-layers.sh), so they write bytes of their own.
STARTS = ("agv_core_begin", "agv_core_begin_corrupted", "agv_supervisor_start")
WRITES = ("memcpy", "memmove", "memset", "hal_store_read_latch", "hal_store_read_record")
HEADERS = ("<string.h>", '"hal/store.h"', '"supervisor/supervisor_internal.h"')
OPTIONS = ("-std=c11", "-fsyntax-only", "-I.", "-Ifirmware/include", "-Ifirmware/src", f"-I{TREE / 'hal/include'}",
           "-include", "watched.h", "-Wcast-qual", "-Wc++-compat", "-Wstrict-prototypes", "-Wdeprecated-declarations", "-ftrack-macro-expansion=0",
           "-fno-diagnostics-show-caret", "-fdiagnostics-color=never", "-fmax-errors=0")

# What gcc must report: file, function, message.
PASSED = "passing argument 1 of '{}' discards 'const' qualifier from pointer target type"
USED = "'{}' is deprecated"
REPORTED = (
    # The three doors.
    (START, "begin_state", PASSED.format("agv_state_machine_start")),
    (START, "begin_state", PASSED.format("agv_state_machine_forbid_reset")),
    (PASS, "agv_core_decide", PASSED.format("agv_state_machine_step")),
    # The first of them is passed at a start only: by the program, or after a corruption, which trips.
    (START, "agv_core_begin", USED.format("begin_modules")),
    (START, "agv_core_begin", USED.format("begin_state")),
    (START, "agv_core_begin_corrupted", USED.format("agv_core_begin")),
    (TOP, "agv_supervisor_start", USED.format("agv_core_begin")),
    (TOP, "open_core", USED.format("agv_core_begin_corrupted")),
    # Memory is cleared at a start: all of it, then all but time, configuration and counters.
    (TOP, "agv_supervisor_start", USED.format("memset")),
    (TOP, "agv_supervisor_start", PASSED.format("memset")),
    (START, "begin_modules", USED.format("memset")),
    # The bytes of a supervisor are taken as its core.
    (CORE, "agv_core_of", "cast discards 'const' qualifier from pointer target type"),
    # Checksums read bytes.
    (SUMS, "agv_crc32", "request for implicit conversion from 'const void *' to 'const uint8_t *' not permitted in C++"),
    (SUMS, "agv_seal", "request for implicit conversion from 'const void *' to 'const unsigned char *' not permitted in C++"),
)
# What the search must find: file, text.
CAST = re.compile(r"\((?!const\b)(?:\w+ )+\*[* ]*(?:const)?\)|\( \*\)")  # in the sources of the supervisor
UNTYPED = re.compile(r"(?<!const )\bvoid \*")
# Pointers as numbers or under another name, arguments without a type, extensions of the compiler, and what stops its reports.
HIDDEN = re.compile(r"# ?pragma|\b(?:_Pragma|asm|union|u?intptr_t|__(?!cplusplus\b)[a-z]\w*)\b|"
                    r"\btypedef [^;{}()]*\*\w+ ?;|\} \*\w+ ?;|\bva_\w+|\.\.\.")
PROGRAM = re.compile(r"\bagv_supervisor_start\b")
FOUND = (
    (CORE, "(agv_core_t *)"),
    (CORE, "(void *)"),
    (CORE, "void *"),
    (START, "(unsigned char *)"),  # begin_modules, as above
    # A program starts its supervisor once.
    ("firmware/zephyr/src/supervise.c", "agv_supervisor_start"),
    ("firmware/zephyr/samples/own_main/src/main.c", "agv_supervisor_start"),
)


def change(root):
    for name, old, new in CHANGES:
        text = (root / name).read_text(encoding="utf-8")
        if text.count(old) != 1:
            sys.exit(f"one-door: {name} has {text.count(old)} times, not once: {old}")
        (root / name).write_text(text.replace(old, new), encoding="utf-8")
    lines = [f"#include {header}" for header in HEADERS]
    lines += [f"extern __typeof__({name}) {name} __attribute__((deprecated));" for name in STARTS + WRITES]
    (root / "watched.h").write_text("\n".join(lines) + "\n", encoding="utf-8")


def reported(root, source):
    """What gcc reports of a source: file, function, message, line, column; how often."""
    done = subprocess.run(["gcc", *OPTIONS, source], cwd=root, env={**os.environ, "LC_ALL": "C"}, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, check=False)
    counts, function = collections.Counter(), ""
    for line in done.stderr.splitlines():
        inside = re.search(r": (?:In function '(\w+)'|At top level)", line)
        if inside:
            function = inside[1] or ""
        says = re.match(r"([^:]+):(\d+):(\d+): (?:warning|error|fatal error): (.*?)(?: \[-W[^]]*\])?$", line)
        if says:
            file, row, column, message = says.groups()
            counts[file, function, re.sub(r" \{aka [^}]*\}", "", message), row, column] += 1
    if done.returncode != 0 and not counts:
        sys.exit(f"one-door: gcc: {done.stderr.strip()}")
    return counts


def by_gcc(root):
    """File, function, message: at how many places. What a header has is reported for each source that includes it."""
    places, counts = collections.Counter(), collections.Counter()
    passes = [USED.format(name) for name in WRITES]
    for path in sorted((root / "firmware/src").rglob("*.c")):
        source = path.relative_to(root).as_posix()
        known = () if source.startswith("firmware/src/supervisor/") else passes
        places |= collections.Counter({key: count for key, count in reported(root, source).items() if key[2] not in known})
    for (file, function, message, _, _), count in places.items():
        counts[file, function, message] += count
    return counts


def code(path):
    """The text of a file: without comments and strings, with one space between words."""
    text = path.read_text(encoding="utf-8").replace("\\\n", "")
    text = re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'",
                  lambda match: " " if match[0].startswith("/") else '""', text, flags=re.DOTALL)
    text = re.sub(r"\s+", " ", text)
    return re.sub(r" ?\* ?", " *", text)


def by_search(root):
    counts = collections.Counter()
    for path in sorted((root / "firmware").rglob("*.*")):
        if path.suffix not in (".c", ".h", ".def"):
            continue
        file = path.relative_to(root).as_posix()
        text = code(path)
        patterns = [PROGRAM] if file.startswith("firmware/zephyr/") else [UNTYPED, HIDDEN]
        if file.startswith("firmware/src/supervisor/"):
            patterns.append(CAST)
        counts.update((file, match[0]) for pattern in patterns for match in pattern.finditer(text))
    return counts


def main(words):
    root = pathlib.Path(words[0] if words else TREE)
    if len(words) > 1 or not (root / CORE).is_file():
        sys.exit(f"one-door: usage: one-door.py [ROOT]; {root} has no {CORE}")
    searched = by_search(root)
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for part in ("firmware/include", "firmware/src"):
            shutil.copytree(root / part, copy / part)
        change(copy)
        compiled = by_gcc(copy)
    wrong = 0
    for found, known in ((compiled, collections.Counter(REPORTED)), (searched, collections.Counter(FOUND))):
        for key in sorted(found.keys() | known.keys()):
            if found[key] != known[key]:
                print(f"one-door: {': '.join(part for part in key if part)} ({found[key]} times, not {known[key]})")
                wrong += 1
    if not wrong:
        print(f"{sum(compiled.values())} places reported by gcc and {sum(searched.values())} found in the text, all known")
    return wrong != 0


sys.exit(main(sys.argv[1:]))
