#!/usr/bin/python3
"""Seeded faults: each is one or more lines of seeded.tsv. Its checker must find it and print the expected message.

usage: seed.py check                    the old text of each line must occur exactly once in its file
       seed.py list CHECKER             name, arguments and files of each seeded fault, separated by |
       seed.py rows CHECKER             name, arguments and expected message, separated by tabs
       seed.py apply CHECKER/NAME FOLDER [--paths]
                                        copies of the changed files, with their paths or without
       seed.py run CHECKER[/NAME]... [--bin FOLDER]
                                        run its programs, built by CMake (seeded.cmake): each must fail with the message
       seed.py tree CHECKER[/NAME]...   run the command of each line in a copy of this tree with the change: same
       seed.py fails CHECKER/NAME COMMAND...
                                        run this command: same
       seed.py --help                   this text

Several lines of one name are one fault. A line with no old text appends the new one; in the new
text \\n is the end of a line. A line with no file changes nothing, and its command is run in this tree.
"""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "tests/support"))
import tree  # noqa: E402

SECONDS = 1800  # a flip of each bit takes minutes
# the words that a command needs
NEEDS = {"check": "", "list": "CHECKER", "rows": "CHECKER", "apply": "CHECKER/NAME FOLDER", "run": "CHECKER[/NAME]",
         "tree": "CHECKER[/NAME]", "fails": "CHECKER/NAME COMMAND"}


class Fault:
    """One seeded fault: its changes, its arguments, the expected message."""

    def __init__(self, checker, name, arguments, says):
        self.checker, self.name, self.arguments, self.says = checker, name, arguments, says
        self.changes = []

    def files(self):
        return list(dict.fromkeys(change[0] for change in self.changes))

    def changed(self, root=ROOT):
        """The changed files: a text for each path."""
        texts = {}
        for path, old, new in self.changes:
            text = texts.get(path)
            if text is None:
                text = (root / path).read_text(encoding="utf-8") if (root / path).exists() else ""
            if old and text.count(old) != 1:
                sys.exit(f"seed: {self.checker}/{self.name}: {path} has {text.count(old)} times, not once: {old}")
            texts[path] = text.replace(old, new) if old else text + new + "\n"
        return texts

    def judge(self, status, said):
        """Whether it was found for its reason; the line to print."""
        for line in said.splitlines():
            if re.search(self.says, line) and status != 0:
                return True, f"found {self.checker}/{self.name}: {line.strip()[:120]}"
        end = "\n  ".join(said.splitlines()[-5:])
        return False, f"NOT FOUND {self.checker}/{self.name} (status {status}, no line says '{self.says}'):\n  {end}"


def read():
    """All seeded faults, in the order of the table."""
    faults = {}
    for number, line in enumerate((HERE / "seeded.tsv").read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("#") or not line:
            continue
        columns = line.split("\t")
        if len(columns) != 7:
            sys.exit(f"seed: seeded.tsv:{number}: {len(columns)} columns, not 7")
        checker, name, arguments, path, old, new, says = columns
        fault = faults.setdefault((checker, name), Fault(checker, name, arguments, says))
        if path:
            fault.changes.append((path, old, new.replace("\\n", "\n")))
    return list(faults.values())


def refuse(text):
    print(f"seed: {text}", file=sys.stderr)
    sys.exit(2)


def of(*words):
    """Those of checkers, or CHECKER/NAME."""
    faults = read()
    for word in words:
        if not any(word in (fault.checker, f"{fault.checker}/{fault.name}") for fault in faults):
            refuse(f"there is no seeded fault {word}")
    return [fault for fault in faults if fault.checker in words or f"{fault.checker}/{fault.name}" in words]


def apply(fault, folder, paths):
    for path, text in fault.changed().items():
        target = folder / (path if paths else pathlib.Path(path).name)
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_text(encoding="utf-8") != text:  # else nothing is built again
            target.write_text(text, encoding="utf-8")


def execute(command, cwd):
    try:
        result = subprocess.run(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                errors="replace", timeout=SECONDS, shell=isinstance(command, str), check=False)
        return result.returncode, result.stdout
    except subprocess.TimeoutExpired:
        return 0, f"nothing was said in {SECONDS} s"
    except OSError as error:
        return 0, f"it cannot be run: {error}"


def run_program(fault, folder):
    program = folder / f"seeded_{fault.checker}_{fault.name}"
    return fault.judge(*execute([str(program), *fault.arguments.split()], ROOT))


def run_in_tree(fault, folder):
    """The command writes nothing into the tree: the next one has the same copy, a copy for each thread."""
    if not fault.changes:
        return fault.judge(*execute(fault.arguments, ROOT))
    copy = pathlib.Path(folder) / str(threading.get_ident())
    if not copy.exists():
        tree.copy_tree(ROOT, copy)
        (copy / "build").symlink_to(ROOT / "build")
    before = {path: (copy / path).read_bytes() if (copy / path).exists() else None for path in fault.files()}
    apply(fault, copy, True)
    result = fault.judge(*execute(fault.arguments, copy))
    for path, text in before.items():
        if text is None:
            (copy / path).unlink()
        else:
            (copy / path).write_bytes(text)
    return result


def run_all(faults, how, folder):
    """Beside each other, but for commands in this tree: two builds of one folder would get in each other's way."""
    results = [how(fault, folder) for fault in faults if not fault.changes]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results += pool.map(lambda fault: how(fault, folder), [fault for fault in faults if fault.changes])
    for _, line in results:
        print(line)
    found = sum(good for good, _ in results)
    print(f"{found} of {len(faults)} seeded faults found")
    return found != len(faults)


def folder_of(words):
    """Takes --bin and its folder out of the words."""
    if "--bin" not in words:
        return ROOT / "build/host/bin"
    at = words.index("--bin")
    if at + 1 == len(words):
        refuse("--bin needs a folder")
    folder = pathlib.Path(words[at + 1])
    del words[at:at + 2]
    return folder


def check_words(what, rest):
    if what not in NEEDS:
        refuse(f"there is no command {what}; --help lists them" if what else "no command; --help lists them")
    if len(rest) < len(NEEDS[what].split()):
        refuse(f"{what} needs {NEEDS[what]}")
    if rest and not NEEDS[what]:
        refuse(f"{what} takes nothing")


def main(words):
    what, rest = (words[0], words[1:]) if words else ("", [])
    if what == "--help":
        print(__doc__.strip())
        return 0
    folder = folder_of(rest) if what == "run" else None
    check_words(what, rest)
    if what == "check":
        faults = read()
        for fault in faults:
            fault.changed()  # ends with the first that cannot
        print(f"{len(faults)} seeded faults can be applied")
    elif what == "list":
        for fault in of(*rest):
            print("|".join([fault.name, fault.arguments, *fault.files()]))
    elif what == "rows":
        for fault in of(*rest):
            print("\t".join([fault.name, fault.arguments, fault.says]))
    elif what == "apply":
        apply(of(rest[0])[0], pathlib.Path(rest[1]), "--paths" in rest)
    elif what == "run":
        return run_all(of(*rest), run_program, folder)
    elif what == "tree":
        with tempfile.TemporaryDirectory(prefix="seed") as copies:
            return run_all(of(*rest), run_in_tree, copies)
    else:
        good, line = of(rest[0])[0].judge(*execute(rest[1:], None))
        print(line)
        return not good
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
