#!/usr/bin/python3
"""A picture (SVG) of what a program shows on a terminal.

usage: terminal-picture.py WIDTHxHEIGHT TEXT PICTURE.svg COMMAND [ARGUMENT...]
The command runs in tmux. When a line contains TEXT, the screen is drawn and the command is ended.
"""
import html
import os
import pathlib
import re
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tests/host_sim/program"))
import tmux  # noqa: E402

CELL_WIDTH, CELL_HEIGHT, BASELINE, MARGIN = 8, 18, 13, 10
BACKGROUND, FOREGROUND = "#16191d", "#d5d9de"
COLOURS = {31: "#ff6b68", 32: "#7bc275", 33: "#e0b44c", 90: "#7f8790"}
ESCAPE = re.compile(r"\x1b\[([0-9;]*)m|\x1b[()][0B]|[\x0e\x0f]")


def capture(width, height, text, command):
    """The lines of the screen, with their control sequences."""
    with tempfile.TemporaryDirectory() as folder:
        terminal = tmux.Tmux(pathlib.Path(folder), width, height, "env", "-C", os.getcwd(), *command)
        try:
            terminal.wait_for(text)
            before, screen = None, []
            while screen != before:  # the program may still be drawing
                time.sleep(0.3)
                before, screen = screen, terminal.lines("-e", "-N")
            return screen
        except AssertionError as error:
            sys.exit(f"terminal-picture: {error}")
        finally:
            terminal.close()


def runs(line, style):
    """(column, text, style) of each part of one style. `style` goes on into the next line."""
    column = at = 0
    for match in list(ESCAPE.finditer(line)) + [None]:
        text = line[at:match.start() if match else len(line)]
        if text:
            yield column, text, dict(style)
            column += len(text)
        if match is None:
            return
        at = match.end()
        for code in [int(word or 0) for word in (match[1] or "0").split(";")] if match[1] is not None else []:
            if code == 0:
                style.clear()
            elif code in (1, 7):
                style[code] = True
            elif code in COLOURS or code == 39:
                style["colour"] = COLOURS.get(code, FOREGROUND)


def blocks(text, column, y, colour):
    """Block characters as rectangles: fonts draw them with gaps."""
    for i, character in enumerate(text):
        eighths = 0x2590 - ord(character)
        if 1 <= eighths <= 8:
            yield (f'<rect x="{MARGIN + (column + i) * CELL_WIDTH}" y="{y + 3}" width="{CELL_WIDTH * eighths / 8:g}" '
                   f'height="{CELL_HEIGHT - 7}" fill="{colour}"/>')


def draw(lines, width, height):
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width * CELL_WIDTH + 2 * MARGIN}" '
           f'height="{height * CELL_HEIGHT + 2 * MARGIN}" font-family="ui-monospace, DejaVu Sans Mono, Menlo, Consolas, monospace" '
           'font-size="13" xml:space="preserve">',
           f'<rect width="100%" height="100%" rx="6" fill="{BACKGROUND}"/>']
    style = {}
    for row, line in enumerate(lines[:height]):
        y = MARGIN + row * CELL_HEIGHT
        for column, text, how in runs(line, style):
            colour = how.get("colour", FOREGROUND)
            x, length = MARGIN + column * CELL_WIDTH, len(text) * CELL_WIDTH
            if how.get(7):
                out.append(f'<rect x="{x}" y="{y}" width="{length}" height="{CELL_HEIGHT}" fill="{colour}"/>')
                colour = BACKGROUND
            out += blocks(text, column, y, colour)
            # Blanks would be collapsed. Those at the end depend on what was drawn there before.
            shown = re.sub("[\u2588-\u258f ]", "\u00a0", text).rstrip("\u00a0")
            if shown:
                weight = ' font-weight="bold"' if how.get(1) else ""
                out.append(f'<text x="{x}" y="{y + BASELINE}" textLength="{len(shown) * CELL_WIDTH}" fill="{colour}"{weight}>'
                           f'{html.escape(shown, quote=False)}</text>')
    return "\n".join(out) + "\n</svg>\n"


def main():
    if len(sys.argv) < 5 or not re.fullmatch(r"\d+x\d+", sys.argv[1]):
        sys.exit(__doc__)
    width, height = sys.argv[1].split("x")
    lines = capture(width, height, sys.argv[2], sys.argv[4:])
    pathlib.Path(sys.argv[3]).write_text(draw(lines, int(width), int(height)), encoding="utf-8")


main()
