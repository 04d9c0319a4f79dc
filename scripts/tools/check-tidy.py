#!/usr/bin/python3
"""clang-tidy 19 over the C files that ship: the core, the ports for hosts, the host program, the page's module (not tests and
benchmarks).

usage: check-tidy.py [--changed] [FILE...]
  --changed: not again a file in which it found nothing, while neither that file nor a header that it includes changed
  FILE: one that is not part of the build is compiled by itself, as C11
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/host-clang"
PASSED = BUILD / "clang-tidy"
# The analyzer stops exploring a function after so many steps: eight times faster than with its default of 225000.
ANALYZER = ("-Xclang", "-analyzer-config", "-Xclang", "max-nodes=30000")
TIDY = ["clang-tidy-19", f"--config-file={ROOT}/.clang-tidy", "--quiet", *(f"--extra-arg={word}" for word in ANALYZER)]
NOISE = (" warning generated.", " warnings generated.")


def output_of(*command, cwd=None):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, cwd=cwd).stdout


def compile_commands(configure):
    """The compiler's command for each source of the build; without what it is to write."""
    database = BUILD / "compile_commands.json"
    if configure or not database.exists():
        output_of("cmake", "--preset", "host-clang", "-S", ROOT)
    commands = {}
    for entry in json.loads(database.read_text(encoding="utf-8")):
        words = shlex.split(entry["command"])
        commands[pathlib.Path(entry["file"])] = words[:words.index("-o")]
    part = commands.get(ROOT / "host_sim/replay/replay.c")
    for file in (ROOT / "web/wasm").glob("*.c") if part else ():  # for another compiler: here as a part of the host program
        commands[file] = [*part, "-D_DEFAULT_SOURCE", "-Wno-unknown-attributes"]
    return commands


@functools.cache
def sum_of(part):
    return hashlib.sha256((BUILD / part).read_bytes()).digest()


def stamp_of(file, command, common):
    """Exists when nothing was found. Its name is a sum of all that this depends on: command, file, headers that it includes."""
    def named(parts):
        content = common + " ".join(command).encode() + b"".join(sum_of(part) for part in parts)
        return PASSED / hashlib.sha256(content).hexdigest()

    known = PASSED / f"{hashlib.sha256(str(file).encode()).hexdigest()}.parts"  # the same while none of them changes
    try:
        stamp = named(known.read_text(encoding="utf-8").split())
        if stamp.exists():
            return stamp
    except FileNotFoundError:  # not checked before, or a header has gone
        pass
    try:
        rule = output_of(*command, "-MM", file, cwd=BUILD).decode()
    except subprocess.CalledProcessError:  # clang-tidy will say why
        return None
    parts = rule.replace("\\\n", " ").split(": ", 1)[1].split()
    known.write_text("\n".join(parts), encoding="utf-8")
    return named(parts)


def check(file, command, stamp):
    """Whether nothing was found in this file, and what was said."""
    if stamp and stamp.exists():
        return True, ""
    options = ["--", *(command[1:] if command else ["-std=c11"])]
    done = subprocess.run([*TIDY, str(file), *options], check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = "".join(line for line in done.stdout.splitlines(True) if not line.rstrip().endswith(NOISE) and line.strip())
    if done.returncode == 0 and stamp:
        stamp.touch()
    return done.returncode == 0, said


def main(words):
    changed = words[:1] == ["--changed"]
    asked = [pathlib.Path(word).resolve() for word in words[changed:]]
    commands = compile_commands(not asked)
    folders = tuple(f"{ROOT}/{folder}/" for folder in ("firmware", "hal", "host_sim", "web"))
    files = asked or [file for file in commands if str(file).startswith(folders)]
    PASSED.mkdir(exist_ok=True)
    common = output_of("clang-tidy-19", "--version") + pathlib.Path(__file__).read_bytes() + (ROOT / ".clang-tidy").read_bytes()

    def one(file):
        command = commands.get(file)
        stamp = stamp_of(file, command, common) if changed and command else None
        return check(file, command, stamp)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(one, files))
    for _, said in results:
        print(said, end="")
    bad = sum(not good for good, _ in results)
    print(f"{len(results)} files, {bad} with findings")
    return bad != 0 or not results


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
