#!/usr/bin/python3
"""No condition of the core is hidden from MC/DC: found in clang's AST.

Reported are `|`, `&` and `^` (also as assignments) with a Boolean operand, an `if` that holds nothing but another `if`
(both could be one `&&`), and a Boolean `?:` with a constant arm (which is a `&&` or `||`). Intended cases are listed in
tests/proofs/mcdc/exceptions with their reasons.
"""
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys

import reasons

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("firmware/include", "firmware/src", "hal/include")
WRAPPERS = ("ImplicitCastExpr", "ParenExpr", "ConstantExpr", "CStyleCastExpr")
BITWISE = ("|", "&", "^", "|=", "&=", "^=")
LOGICAL = ("&&", "||", "<", ">", "<=", ">=", "==", "!=")
EXCEPTION = re.compile(r"([^ :]+): (\S.*)")


def fail(message):
    print(f"check-conditions: {message}", file=sys.stderr)
    sys.exit(1)


def children(node):
    return [child for child in node.get("inner", []) if child]


def stripped(node):
    while node.get("kind") in WRAPPERS and len(children(node)) == 1:
        node = children(node)[0]
    return node


def is_constant(node):
    return stripped(node).get("kind") in ("IntegerLiteral", "CXXBoolLiteralExpr") and \
        stripped(node).get("value") in ("0", "1", True, False)


def is_boolean(node):
    """Whether a value is Boolean: of the type bool, a comparison, or a condition that selects 0 or 1."""
    node = stripped(node)
    kind = node.get("kind")
    if kind == "ConditionalOperator":
        return all(is_constant(arm) for arm in children(node)[1:]) or all(is_boolean(arm) for arm in children(node)[1:])
    if kind == "BinaryOperator" and node["opcode"] in BITWISE:
        return any(is_boolean(child) for child in children(node))
    return (kind == "BinaryOperator" and node["opcode"] in LOGICAL) or \
        (kind == "UnaryOperator" and node["opcode"] == "!") or node.get("type", {}).get("qualType") in ("bool", "_Bool")


def only_an_if(node):
    """Whether a branch consists of a single `if` without `else`."""
    if node.get("kind") == "CompoundStmt":
        inner = children(node)
        return len(inner) == 1 and only_an_if(inner[0])
    return node.get("kind") == "IfStmt" and not node.get("hasElse")


def what_is_hidden(node):
    """The problem of a node, or None."""
    kind = node.get("kind")
    if kind in ("BinaryOperator", "CompoundAssignOperator") and node["opcode"] in BITWISE:
        if any(is_boolean(child) for child in children(node)):
            return f"a condition below '{node['opcode']}'"
    elif kind == "IfStmt" and not node.get("hasElse") and only_an_if(children(node)[1]):
        return "an if in an if: '&&'"
    elif kind == "ConditionalOperator":
        condition, *arms = children(node)
        truths = [is_boolean(arm) and not is_constant(arm) for arm in arms]
        if is_boolean(condition) and any(truths) and any(is_constant(arm) for arm in arms):
            return "a condition in an arm of '?:'"
    return None


def decisions_below(node, inside=False):
    """Number of decisions with several conditions: outermost `&&` and `||`."""
    if node.get("kind") == "StaticAssertDecl":
        return 0
    logical = node.get("kind") == "BinaryOperator" and node["opcode"] in ("&&", "||")
    same = logical or (inside and (node.get("kind") in WRAPPERS or node.get("opcode") == "!"))
    return (logical and not inside) + sum(decisions_below(child, same) for child in children(node))


def follow_place(location, place):
    """clang prints file and line only when they change: place has the last ones."""
    for part in (location.get("spellingLoc"), location.get("expansionLoc"), location):
        if part:
            place.update({key: part[key] for key in ("file", "line") if key in part})


def walk(node, place, found):
    """Adds (file, line, problem) of all hidden conditions below a node, in clang's order."""
    follow_place(node.get("loc", {}), place)
    node_range = node.get("range", {})
    follow_place(node_range.get("begin", {}), place)
    begin = (place.get("file"), place.get("line"))
    follow_place(node_range.get("end", {}), place)
    hidden = what_is_hidden(node)
    if hidden:
        found.add((*begin, hidden))
    for child in node.get("inner", []):
        walk(child, place, found)


def look_at(source):
    """The hidden conditions of a source, and its number of decisions with several conditions."""
    command = ["clang-19", "-std=c11", "-fsyntax-only", *(f"-I{ROOT}/{folder}" for folder in FOLDERS),
               "-Xclang", "-ast-dump=json", str(source)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        fail(done.stderr)
    sys.setrecursionlimit(10000)
    found = set()
    tree = json.loads(done.stdout)
    walk(tree, {}, found)
    return {(str(pathlib.Path(file).resolve().relative_to(ROOT)), line, what) for file, line, what in found
            if file and str(pathlib.Path(file).resolve()).startswith(f"{ROOT}/")}, decisions_below(tree)


def main():
    exceptions = reasons.read(ROOT / "tests/proofs/mcdc/exceptions", EXCEPTION, "FILE: SOURCE LINE")
    sources = sorted(ROOT.glob("firmware/src/**/*.c"))
    with concurrent.futures.ProcessPoolExecutor(max_workers=2) as pool:
        results = list(pool.map(look_at, sources))
    found = sorted(set().union(*(hidden for hidden, _ in results)))
    decisions = sum(count for _, count in results)
    if not sources:
        fail(f"there is nothing to check in {ROOT}")
    bad = []
    used = set()
    for file, line, what in found:
        text = (ROOT / file).read_text(encoding="utf-8").splitlines()[line - 1].strip()
        used.add((file, text))
        if (file, text) not in exceptions:
            bad.append(f"{file}:{line}: {what}: {text}")
    bad += [f"this exception is not needed: {file}: {text}" for file, text in exceptions if (file, text) not in used]
    if bad:
        fail("\n".join(bad))
    print(f"{decisions} decisions of several conditions; none is hidden from MC/DC, exceptions: {len(exceptions)}")


main()
