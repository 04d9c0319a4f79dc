"""A page, typed as it stands: its files are saved, its commands run, and what they print is compared.

A block behind a paragraph that says "Save this as `NAME`:" is that file. A console block is a list of commands after `$ ` and what
they print, standard error included; a line `...` stands for any lines, `...` at the end of a line for any rest of it.
"""
import os
import pathlib
import re
import shutil
import subprocess

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SAVE = re.compile(r"[Ss]ave this as\s+`([^`]+)`:?\s*\Z")


def steps(path):
    """In the order of the page: ("save", name, text), or ("run", command, expected lines)."""
    page = pathlib.Path(path).read_text(encoding="utf-8")
    for block in BLOCK.finditer(page):
        name = SAVE.search(page, 0, block.start())
        if name:
            yield "save", name[1], block[2]
        elif block[1] == "console":
            command, expected = None, []
            for line in block[2].splitlines():
                if line.startswith("$ "):
                    if command is not None:
                        yield "run", command, expected
                    command, expected = line[2:], []
                else:
                    expected.append(line)
            yield "run", command, expected


def pattern(lines):
    parts = []
    for line in lines:
        if line == "...":
            parts.append(r"(?:.*\n)*?")
        elif line.endswith("..."):
            parts.append(re.escape(line[:-3]) + r".*\n")
        else:
            parts.append(re.escape(line) + r"\n")
    return r"\A(?:%s)\Z" % "".join(parts)


def follow(case, these, folder, environment, left_out=(), instead=None):
    """Do these steps, in this folder. `$?` is the status of the command before. @return the number of commands"""
    count, status = 0, 0
    for kind, what, content in these:
        if kind == "save":
            (folder / what).parent.mkdir(parents=True, exist_ok=True)
            (folder / what).write_text(content, encoding="utf-8")
        elif not what.startswith(tuple(left_out)):
            command = what.replace("$?", str(status))
            for word, other in (instead or {}).items():
                command = command.replace(word, other)
            done = subprocess.run([shutil.which("bash"), "-c", command], cwd=folder, env=dict(os.environ, **environment),
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=600, check=False, text=True)
            status = done.returncode
            case.assertRegex(done.stdout, pattern(content), what)
            count += 1
    return count
