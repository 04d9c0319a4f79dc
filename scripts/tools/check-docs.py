#!/usr/bin/python3
"""Every page (*.md): its links and its commands.

- The target of a relative link must exist, and its heading, if it names one.
- Each command in a ```sh block, and behind `$ ` in a ```console block, must exist: a file of this project, a
  program that it builds for the host, or one on the PATH. A block that begins with ```sh not-run-here is for another
  machine and is not checked. Commands must be in such blocks only.
- A default that a page states as 50 ms (`vcu_heartbeat_timeout_ms`) must be that of config_settings.def.
- docs/architecture.md links every source and header of firmware/ and hal/include.
- The version of firmware/zephyr/VERSION is that of the citation, of the newest section of the changelog, and of the pages.
"""
import argparse
import os
import pathlib
import re
import shlex
import shutil
import sys
import urllib.parse

import tables

FENCE = re.compile(r"^ *(```+|~~~+) *(.*)$")
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(<?([^)\s>]+)>?(?: \"[^\"]*\")?\)", re.DOTALL)
IMAGE = re.compile(r'!\[[^\]]*\]\(<?([^)\s>]+)|<img\s[^>]*?\bsrc="([^"]+)"')
HEADING = re.compile(r"^#{1,6} +(.*?) *#*$")
STATED = re.compile(r"(\d+(?:\.\d+)?)( s| ms| mm/s| %|°)\s\(`(\w+)`")
IN_UNIT = {" s": ("ms", 1000), " ms": ("ms", 1), " mm/s": ("mm/s", 1), " %": ("%", 1), "°": ("0.1 deg", 10)}
KEYWORDS = {"if", "then", "else", "elif", "fi", "for", "do", "done", "while", "until", "case", "esac", "{", "}", "!", "cd",
            "export", "set", "echo", "source", "."}
# Where the version is written a second time: file, and what stands around it. Two numbers: without the patch level.
VERSIONS = (("CITATION.cff", r"^version: (.+)$"), ("CHANGELOG.md", r"\A(?:(?!^## ).*\n)*## \[([^\]]*)\]"),
            ("README.md", r"^Version (\d\S*)"), ("docs/firmware.md", r"^\| release \|.*\n\|.*\n\| ([^ ]+)"),
            ("docs/firmware.md", r"revision of the sources \(`([^+]+)\+"), ("docs/host-sim.md", r"^host_sim (\d\S*)$"),
            ("docs/host-sim.md", r"find_package\(AgvSupervisor (\S+) REQUIRED"))
SEPARATORS = {"|", "||", "&&", ";", "&", "(", ")"}


class Problems:
    def __init__(self):
        self.count = 0

    def add(self, message):
        print(f"check-docs: {message}", file=sys.stderr)
        self.count += 1


def read_page(path):
    """The text outside of code blocks, and the blocks as (line number, text behind the fence, lines)."""
    prose, blocks, fence, info, block = [], [], None, "", []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = FENCE.match(line)
        if fence is None and match:
            fence, info, block = match[1], match[2].strip(), []
            blocks.append((number + 1, info, block))
        elif fence is not None and match and match[1].startswith(fence) and not match[2]:
            fence = None
        elif fence is not None:
            block.append(line)
        prose.append("" if fence is not None or match else line)
    return "\n".join(prose), blocks


def anchors(path):
    """The anchors of a page's headings, as hosting sites generate them."""
    found = set()
    for line in read_page(path)[0].splitlines():
        match = HEADING.match(line)
        if match:
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", match[1]).replace("`", "")
            found.add(re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-"))
    return found


def check_links(root, page, prose, problems):
    count = 0
    text = re.sub(r"`[^`]*`", "`code`", prose)
    images = {first or second for first, second in IMAGE.findall(text)}
    for target in sorted(images.union(LINK.findall(text))):
        if re.match(r"[a-z][a-z+.-]*:", target):
            continue
        count += 1
        place, _, heading = urllib.parse.unquote(target).partition("#")
        path = (page.parent / place).resolve() if place else page
        if not path.exists() or not path.is_relative_to(root.resolve()):
            problems.add(f"{page.relative_to(root)}: the link {target} is broken")
        elif heading and path.suffix == ".md" and heading not in anchors(path):
            problems.add(f"{page.relative_to(root)}: {target} names a heading that does not exist")
    return count


def commands_of(lines):
    """(number of the line, first word) of every command of a block."""
    number, pending = 0, ""
    for offset, line in enumerate(lines):
        if not pending:
            number = offset
        pending += line
        if pending.endswith("\\"):
            pending = pending[:-1] + " "
            continue
        lexer = shlex.shlex(pending, posix=True, punctuation_chars=True)
        lexer.commenters = "#"
        lexer.wordchars += ":@%+,[]{}$!^"
        expected, skip = True, False
        for word in lexer:
            if word in SEPARATORS:
                expected = True
            elif skip:
                skip = False
            elif set(word) <= set("<>&"):
                skip = True  # a redirection and its file
            elif expected and not re.match(r"\w+=", word) and word != "sudo":
                if word not in KEYWORDS:
                    yield number, word
                expected = word in KEYWORDS - {"cd", "export", "set", "echo", "source", "."}
        pending = ""


def check_commands(root, page, blocks, problems):
    count = 0
    path = f"{root}/build/host/bin{os.pathsep}{os.environ['PATH']}"
    for first, info, lines in blocks:
        if info.split(" ")[0] in ("bash", "shell", "zsh"):
            problems.add(f"{page.relative_to(root)}:{first - 1}: a block of commands must be marked sh or console")
        if info == "console":
            lines = [line.removeprefix("$ ") if line.startswith("$ ") else "" for line in lines]
        elif info != "sh":
            continue
        try:
            commands = list(commands_of(lines))
        except ValueError as error:
            problems.add(f"{page.relative_to(root)}:{first}: not readable as shell: {error}")
            continue
        for offset, word in commands:
            count += 1
            if shutil.which(root / word if "/" in word else word, path=path) is None:
                problems.add(f"{page.relative_to(root)}:{first + offset}: unknown command {word}")
    return count


def check_defaults(root, page, prose, problems):
    settings = {row.name: (int(row.default, 0), row.unit) for row in tables.settings(root) if isinstance(row, tables.Setting)}
    count = 0
    for value, stated_unit, name in STATED.findall(prose):
        unit, factor = IN_UNIT[stated_unit]
        count += 1
        if settings.get(name) != (round(float(value) * factor), unit):
            problems.add(f"{page.relative_to(root)}: {value}{stated_unit} is not the default of {name}")
    return count


def check_modules(root, problems):
    page = root / "docs/architecture.md"
    linked = {(page.parent / target).resolve() for target in LINK.findall(page.read_text(encoding="utf-8"))}
    files = [path for folder in ("firmware/include", "firmware/src", "hal/include") for path in (root / folder).rglob("*")
             if path.suffix in (".c", ".h", ".def")]
    for path in sorted(files):
        if path.resolve() not in linked:
            problems.add(f"docs/architecture.md does not link {path.relative_to(root)}")


def check_version(root, problems):
    text = (root / "firmware/zephyr/VERSION").read_text(encoding="utf-8")
    version = ".".join(re.search(rf"^{part} = (\d+)", text, re.MULTILINE)[1]
                       for part in ("VERSION_MAJOR", "VERSION_MINOR", "PATCHLEVEL"))
    for name, pattern in VERSIONS:
        found = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
        if not found or found[1] not in (version, version.rpartition(".")[0]):
            problems.add(f"{name}: the version is {found[1] if found else 'missing'}, firmware/zephyr/VERSION says {version}")


def main():
    parser = argparse.ArgumentParser(description="links, commands and defaults in all pages")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    root = parser.parse_args().root
    problems = Problems()
    pages = [page for page in sorted(root.rglob("*.md"))
             if not {"build", "node_modules"} & set(page.relative_to(root).parts)
             and not any(part.startswith(".") for part in page.relative_to(root).parts)]
    links = commands = defaults = 0
    for page in pages:
        prose, blocks = read_page(page)
        links += check_links(root, page, prose, problems)
        commands += check_commands(root, page, blocks, problems)
        defaults += check_defaults(root, page, prose, problems)
    if pages:
        check_modules(root, problems)
        check_version(root, problems)
    else:
        problems.add(f"no pages in {root}")
    print(f"{len(pages)} pages, {links} links, {commands} commands, {defaults} defaults, {problems.count} problems")
    return 1 if problems.count else 0


sys.exit(main())
