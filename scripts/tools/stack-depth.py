#!/usr/bin/python3
"""Deepest stack of a set of functions, from the call graphs that gcc writes (-fcallgraph-info=su).

usage: stack-depth FILE.ci... [--objects FILE | --pointers-lead-outside] --entry FUNCTION...
Prints the deepest path. Fails on recursion, on a frame whose size is not fixed, and on an entry that is not there: the
depth would be unknown. A call through a pointer may reach every function whose address these objects take; it fails when
there is none. Functions outside the files (HAL, libc) count as nothing and are listed. --pointers-lead-outside: so do calls
through pointers, as those to the drivers of an operating system.
"""
import argparse
import re
import subprocess
import sys

NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
FRAME = re.compile(r"\\n(\d+) bytes \(([^)]*)\)")


RELOCATIONS = re.compile(r"^RELOCATION RECORDS FOR \[\.(?:text|rodata|data)\S*\]:\n(.*?)\n\n", re.MULTILINE | re.DOTALL)
ADDRESS = re.compile(r"R_ARM_ABS32\s+(?:\.text\.)?(\w+)")
INDIRECT = "__indirect_call"


class Unbounded(Exception):
    pass


def read_graph(paths):
    """Stack frames in bytes of the functions in these files, and the calls between them."""
    frames, calls = {}, {}
    for path in paths:
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for title, label in NODE.findall(text):
            frame = FRAME.search(label)
            if not frame:
                continue  # defined elsewhere
            if frame.group(2) not in ("static", "dynamic,bounded"):
                raise Unbounded(f"{title}: the size of its frame is not fixed ({frame.group(2)})")
            frames[title] = int(frame.group(1))
        for caller, callee in EDGE.findall(text):
            calls.setdefault(caller, set()).add(callee)
    return frames, calls


def resolve_pointers(objects, frames, calls):
    """Let a call through a pointer reach every function whose address is taken somewhere in the objects."""
    taken = set()
    if objects:
        dump = subprocess.run(["arm-none-eabi-objdump", "-r", objects], check=True, capture_output=True, text=True).stdout
        for section in RELOCATIONS.findall(dump):
            taken.update(ADDRESS.findall(section))
    reachable = {title for title in frames if title.rsplit(":", 1)[-1] in taken}
    for caller, callees in calls.items():
        if INDIRECT in callees:
            if not reachable:
                raise Unbounded(f"{caller} calls through a pointer")
            callees.remove(INDIRECT)
            callees |= reachable


def deepest(function, frames, calls, path, known):
    """(bytes, path) of the deepest chain of calls from this function on."""
    if function in path:
        raise Unbounded("recursion: " + " -> ".join(path[path.index(function):] + [function]))
    if function not in known:
        chains = [deepest(callee, frames, calls, path + [function], known) for callee in calls.get(function, ())]
        below = max(chains, default=(0, []))
        known[function] = (below[0] + frames.get(function, 0), [function] + below[1])
    return known[function]


def main():
    parser = argparse.ArgumentParser(description="deepest stack from gcc's call graphs")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--objects", help="object or archive in which to look for addresses of functions")
    parser.add_argument("--pointers-lead-outside", action="store_true", help="ignore calls through pointers")
    parser.add_argument("--entry", nargs="+", required=True)
    parser.add_argument("--max", type=int, help="fail above this many bytes")
    arguments = parser.parse_args()
    known = {}
    try:
        frames, calls = read_graph(arguments.files)
        if not arguments.pointers_lead_outside:
            resolve_pointers(arguments.objects, frames, calls)
        for function in arguments.entry:
            if function not in frames:
                raise Unbounded(f"{function} is not there")
        # From every function, not only from the entries: no recursion anywhere.
        for function in frames:
            deepest(function, frames, calls, [], known)
    except Unbounded as error:
        print(f"stack-depth: {error}", file=sys.stderr)
        return 1
    depth, path = max(known[function] for function in arguments.entry)
    short = [name.rsplit(":", 1)[-1] for name in path]
    outside = sorted({callee for callees in calls.values() for callee in callees} - set(frames))
    limit = f" of {arguments.max}" if arguments.max is not None else ""
    print(f"stack  {depth:6} bytes{limit}  " + " > ".join(short))
    print("       without the frames of: " + ", ".join(outside))
    if arguments.max is not None and depth > arguments.max:
        print(f"stack-depth: {depth} bytes, the limit is {arguments.max}", file=sys.stderr)
        return 1
    return 0


sys.exit(main())
