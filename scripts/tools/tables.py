"""The tables of the core (firmware/include/agv/*.def), read once for all scripts, and the sections of pages that scripts make.

A row that is not understood is a Problem, as is a page without the lines around its section.
"""
import collections
import re

HEADERS = "firmware/include/agv"
NUMBER = r"(\d+|0x[0-9A-F]+)"
FLAGS = {"NONE", "UNRESETTABLE", "FIXED", "FROM_AI", "OF_EPS", "GATEWAY"}

Fault = collections.namedtuple("Fault", "name fault_class led flags event")
Setting = collections.namedtuple("Setting", "name default lowest highest unit weakens scope meaning")
Choice = collections.namedtuple("Choice", "name words weakens scope meaning")
Message = collections.namedtuple("Message", "name heading table")

FAULT = re.compile(r"^AGV_FAULT(_TRANSIENT)?\((\w+), (TRIP|WARN), (\d+), ([A-Z_]+(?: \| [A-Z_]+)*)\)$")
SETTING = re.compile(rf'^AGV_SETTING\((\w+), {NUMBER}, {NUMBER}, {NUMBER}, "([^"]*)", (ABOVE|BELOW|ZERO|NEVER), (GATEWAY|ANY), '
                     r'"([^"]*)"\)$')
CHOICE = re.compile(r'^AGV_CHOICE\((\w+), "(\w+(?:\|\w+)+)", \d+, (CHOSEN|NEVER), (GATEWAY|ANY), "([^"]*)"\)$')
MESSAGE = re.compile(r"^AGV_(?:COMMAND|STATUS)\(\w+, (\w+), (0x[0-9A-F]{3}), (0x[0-9A-F]{3}), .*\)$")


class Problem(SystemExit):
    """An error that ends a script with a message."""


def read(path, kinds):
    """The rows of a table. kinds: beginning of a row, its pattern, and the function for its groups."""
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for begin, pattern, make in kinds:
            if line.startswith(begin):
                match = pattern.match(line)
                if match is None:
                    raise Problem(f"{path}:{number}: invalid row, expected {begin}...) like the others")
                found.append(make(*match.groups()))
    if not found:
        raise Problem(f"{path} holds no rows")
    return found


def fault(event, name, fault_class, led, flags):
    flags = set(flags.split(" | "))
    if not flags <= FLAGS:
        raise Problem(f"{name}: unknown flags {sorted(flags - FLAGS)}: add them to scripts/tools/tables.py")
    return Fault(name, fault_class, int(led), flags, event is not None)


def faults(root):
    """Highest rank first."""
    begins = ("AGV_FAULT(", "AGV_FAULT_TRANSIENT(")
    return read(root / HEADERS / "fault_table.def", [(begin, FAULT, fault) for begin in begins])


def settings(root):
    """Numbers (Setting) and choices (Choice), in their order."""
    return read(root / HEADERS / "config_settings.def", [("AGV_SETTING(", SETTING, Setting), ("AGV_CHOICE(", CHOICE, Choice)])


def messages(root):
    return read(root / HEADERS / "message_table.def", [(begin, MESSAGE, Message) for begin in ("AGV_COMMAND(", "AGV_STATUS(")])


def section(page, text, begin, end):
    """What stands before, between and after the lines begin and end of a text. page: its name, for the message."""
    if text.count(begin) != 1 or end not in text.split(begin)[1]:
        raise Problem(f"{page} needs the lines '{begin}' and '{end}'")
    before, rest = text.split(begin)
    return before, *rest.split(end, 1)


def with_section(page, text, begin, end, content):
    """The text with this content between the lines begin and end."""
    before, _, after = section(page, text, begin, end)
    return f"{before}{begin}\n\n{content}\n\n{end}{after}"
