#!/usr/bin/python3
"""The settings of the supervisor as Kconfig: made from config_settings.def, message_table.def and fault_table.def.

Writes firmware/zephyr/Kconfig.settings (a symbol, range and default a setting, a choice a word, an identifier a message) and
firmware/zephyr/src/kconfig_settings.def (which symbol is which setting, for the build's own check), and in
docs/safety-manual.md the list of settings that weaken the supervision, between its markers.

--check: changes nothing; fails when one of the three is out of date.
"""
import argparse
import pathlib
import sys

import tables
from tables import Problem

MADE = "made by scripts/tools/kconfig.py from config_settings.def, message_table.def and fault_table.def"
GATEWAY = "AGV_TOPOLOGY_GATEWAY"
BEGIN, END = "<!-- settings that weaken: made by scripts/tools/kconfig.py -->", "<!-- end of settings that weaken -->"
WEAK_WHEN = {"ABOVE": "above {}", "BELOW": "below {}", "ZERO": "0", "CHOSEN": "{}"}


def choice_lines(symbol, prompt, words, default, scope):
    """With the scope GATEWAY, only a gateway can choose the second word."""
    lines = [f"choice AGV_{symbol}", f'\tprompt "{prompt}"', f"\tdefault AGV_{symbol}_{words[default].upper()}", ""]
    for index, word in enumerate(words):
        lines += [f"config AGV_{symbol}_{word.upper()}", f'\tbool "{word}"']
        lines += [f"\tdepends on {GATEWAY}"] if scope == "GATEWAY" and index > 0 else []
        lines.append("")
    return lines + ["endchoice", ""]


def sentence(meaning):
    return meaning[0].upper() + meaning[1:]


def setting_lines(name, preset, lowest, highest, unit, _weakens, scope, meaning):
    """With the scope GATEWAY, only a gateway can change the number: without a prompt a symbol keeps its default."""
    kind = "hex" if preset.startswith("0x") else "int"
    lowest, highest = (f"0x{int(limit, 0):X}" if kind == "hex" else limit for limit in (lowest, highest))
    prompt = sentence(meaning) + (f" [{unit}]" if unit else "")
    return [f"config AGV_{name.upper()}", f'\t{kind} "{prompt}"' + (f" if {GATEWAY}" if scope == "GATEWAY" else ""),
            f"\tdefault {preset}", f"\trange {lowest} {highest}", ""]


def id_lines(name, heading, table):
    label = name.replace("_", " ")
    help_line = f"With AGV_ID_SET_TABLE the default {heading} stands for {table}; any other value is used as it is."
    return [f"config AGV_ID_{name.upper()}", f'\thex "Identifier: {label} (P1)"', f"\tdefault {heading}", "\trange 0x001 0x7FF",
            *(["\thelp", f"\t  {help_line}"] if table != heading else []), ""]


def make(settings, messages, faults):
    kconfig, rows_made = [f"# Every setting of the supervisor; {MADE}.", ""], [f"/* {MADE[0].upper()}{MADE[1:]}. */"]
    for row in settings:
        symbol = row.name.upper()
        if isinstance(row, tables.Choice):
            words = row.words.split("|")
            kconfig += choice_lines(symbol, sentence(row.meaning), words, 0, row.scope)
            enabled = [f"IS_ENABLED(CONFIG_AGV_{symbol}_{word.upper()}) ? {index} : " for index, word in enumerate(words) if index > 0]
            rows_made.append(f"AGV_KCONFIG({row.name}, {''.join(enabled)}0)")
        else:
            kconfig += setting_lines(*row)
            rows_made.append(f"AGV_KCONFIG({row.name}, CONFIG_AGV_{symbol})")
    kconfig += ['menu "Identifiers of the messages"', ""]
    for name, heading, table in messages:
        kconfig += id_lines(name, heading, table)
        rows_made.append(f"AGV_KCONFIG(id_{name}, CONFIG_AGV_ID_{name.upper()})")
    kconfig += ["endmenu", ""]
    kconfig += ['menu "What each fault does"', ""]
    for name, fault_class, _, flags, _ in faults:
        if "FIXED" not in flags:
            kconfig += choice_lines(f"CLASS_{name}", name, ["warn", "trip"], int(fault_class == "TRIP"),
                                    "GATEWAY" if "GATEWAY" in flags else "ANY")
            rows_made.append(f"AGV_KCONFIG_CLASS({name}, IS_ENABLED(CONFIG_AGV_CLASS_{name}_TRIP))")
    return "\n".join(kconfig + ["endmenu", ""]), "\n".join(rows_made + [""])


def weakening_table(settings, faults):
    """The settings that weaken the supervision when they leave their default in one direction (INT-2)."""
    lines = ["| setting | weakens when | default | what it is |", "|---|---|---|---|"]
    for row in settings:
        if isinstance(row, tables.Choice):
            default, weak = row.words.split("|")[:2]
            unit = ""
        else:
            default = weak = row.default
            unit = f" {row.unit}" if row.unit else ""
        if row.weakens != "NEVER":
            when = WEAK_WHEN[row.weakens].format(weak)
            lines.append(f"| `{row.name}` | {when} | {default}{unit} | {row.meaning.replace('|', '/')} |")
    weaker = [row.name for row in faults if row.fault_class == "TRIP" and "FIXED" not in row.flags]
    lines += [f"| `class_{name.lower()}` | warn | trip | the vehicle drives on with `{name}` |" for name in weaker]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description="the settings as Kconfig")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--check", action="store_true", help="change nothing, fail when something is out of date")
    arguments = parser.parse_args()
    settings, messages, faults = (read(arguments.root) for read in (tables.settings, tables.messages, tables.faults))
    made = dict(zip(("firmware/zephyr/Kconfig.settings", "firmware/zephyr/src/kconfig_settings.def"),
                    make(settings, messages, faults)))
    manual = "docs/safety-manual.md"
    if (arguments.root / "docs").exists():
        text = (arguments.root / manual).read_text(encoding="utf-8")
        made[manual] = tables.with_section(manual, text, BEGIN, END, weakening_table(settings, faults))
    for name, text in made.items():
        path = arguments.root / name
        if not arguments.check:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            raise Problem(f"{name} is out of date: run scripts/tools/kconfig.py")
    print(f"{len(settings)} settings, {len(messages)} identifiers, {len(faults)} faults")


try:
    main()
except (Problem, OSError) as problem:
    print(f"kconfig: {problem}", file=sys.stderr)
    sys.exit(1)
