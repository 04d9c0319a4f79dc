#!/usr/bin/python3
"""The tables of pins in docs/wiring.md: compared with the overlays of the boards, and drawn.

A table stands between `<!-- pins of BOARD -->` and `<!-- end of pins -->`; its rows name the signal, the pin of the processor and that of
a connector. Each signal that the overlay of the board, or its overlay for inputs, gives a pin must be there with that pin, and no other.
CAN pins and LEDs stand in the board's own files of Zephyr: they are compared when ZEPHYR_BASE is set. The
drawings are docs/pictures/wiring-BOARD.svg.

--check: changes nothing; fails when a table is wrong or a drawing is out of date.
"""
import argparse
import os
import pathlib
import re
import sys

import wiring_drawings

PORTS = {"nucleo": lambda port, pin: f"P{port.upper()}{pin}", "ucans32k1sic": lambda port, pin: f"PT{port.upper()}{pin}",
         "mr": lambda port, pin: f"PT{port[0].upper()}{int(pin) + (16 if port.endswith('_h') else 0)}"}
SIGNALS = {"safety-output": "safety output", "feedback": "feedback", "estop": "emergency stop", "reset": "push button"}
TABLE = re.compile(r"<!-- pins of (\w+) -->\n(.*?)<!-- end of pins -->", re.DOTALL)


def port_name(board, port, pin):
    return PORTS[board if board in PORTS else board.partition("_")[0]](port, pin)


def without_comments(text):
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def tables(root):
    """{board: {signal: (pin, connector)}}, in the order of the page."""
    found = {}
    for board, body in TABLE.findall((root / "docs/wiring.md").read_text(encoding="utf-8")):
        rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in body.strip().splitlines() if line.startswith("|")]
        found[board] = {row[0]: (row[1], row[2]) for row in rows[2:]}
    return found


def overlay_pins(root, board):
    """{signal: pin} of the overlays of a board."""
    pins = {}
    for name in (f"{board}.overlay", f"{board}_inputs.overlay"):
        path = root / "firmware/zephyr/boards" / name
        text = without_comments(path.read_text(encoding="utf-8")) if path.exists() else ""
        for signal, port, pin in re.findall(r"([a-z-]+)-gpios = <&gpio(\w+) (\d+)", text):
            pins[SIGNALS[signal]] = port_name(board, port, pin)
        for direction, pin in re.findall(r"&fdcan2_(rx|tx)_p(\w\d+)", text):
            pins[f"AI side {direction.upper()}"] = f"P{pin.upper()}"
    return pins


def zephyr_pins(zephyr, root, board):
    """{signal: pin} of what Zephyr's files of the board say: the controllers that the overlay names, and its LED."""
    overlay = without_comments((root / f"firmware/zephyr/boards/{board}.overlay").read_text(encoding="utf-8"))
    folder = next(zephyr.glob(f"boards/*/{board}"))
    text = without_comments("".join(path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.dts*")))) + overlay
    pins = {}
    for side, prop in (("vehicle side", "vehicle-can"), ("AI side", "ai-can")):
        number = re.search(rf"{prop} = <&(?:fdcan|flexcan)(\d)>", overlay)[1]
        for stm, direction, pin in re.findall(rf"&fdcan({number})_(rx|tx)_p(\w\d+)", text):
            pins[f"{side} {direction.upper()}"] = f"P{pin.upper()}"
        for direction, pin in re.findall(rf"<CAN{number}_([RT]X)_(PT\w\d+)>", text):
            pins[f"{side} {direction}"] = pin
        for pin, direction in re.findall(rf"<(PT\w\d+)_CAN{number}_([RT]X)>", text):
            pins[f"{side} {direction}"] = pin
    led = re.search(r"alarm-led = <&(\w+)>", overlay)[1]
    port, pin = re.search(rf"{led}: \w+ {{\s*gpios = <&gpio(\w+) (\d+)", text).groups()
    pins["LED"] = port_name(board, port, pin)
    return pins


def compare(board, table, pins, source):
    """What differs, as lines."""
    problems = []
    for signal, pin in pins.items():
        stated = table.get(signal, ("missing",))[0]
        if stated != pin:
            problems.append(f"docs/wiring.md: {board}: {signal} is {stated}, {source} says {pin}")
    return problems


def main():
    parser = argparse.ArgumentParser(description="pins of docs/wiring.md: compare with the overlays, draw")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[3])
    options = parser.parse_args()
    root, problems, compared, with_zephyr = options.root, [], 0, 0
    zephyr = os.environ.get("ZEPHYR_BASE")
    found = tables(root)
    boards = {path.stem for path in (root / "firmware/zephyr/boards").glob("*.overlay")
              if not path.stem.startswith("native_sim") and not path.stem.endswith("_inputs")}
    for board in sorted(boards ^ set(found)):
        problems.append(f"docs/wiring.md: {board} has {'no table of pins' if board in boards else 'no overlay'}")
    for board in sorted(boards & set(found)):
        pins = overlay_pins(root, board)
        problems += compare(board, found[board], pins, "its overlay")
        for signal in set(SIGNALS.values()) & set(found[board]) - set(pins):
            problems.append(f"docs/wiring.md: {board}: no overlay has a pin for {signal}")
        compared += len(pins)
        if zephyr:
            pins = zephyr_pins(pathlib.Path(zephyr), root, board)
            problems += compare(board, found[board], pins, "Zephyr")
            with_zephyr += len(pins)
    for name, svg in wiring_drawings.all_of(found).items():
        path = root / "docs/pictures" / name
        if not path.exists() or path.read_text(encoding="utf-8") != svg:
            if options.check:
                problems.append(f"docs/pictures/{name} is out of date: run scripts/tools/pictures/wiring.py")
            else:
                path.write_text(svg, encoding="utf-8")
    for problem in problems:
        print(f"wiring: {problem}", file=sys.stderr)
    print(f"{len(found)} boards, {compared} pins compared with the overlays, {with_zephyr} with Zephyr"
          + ("" if zephyr else " (ZEPHYR_BASE is not set)") + f", {len(problems)} problems")
    return 1 if problems else 0


sys.exit(main())
