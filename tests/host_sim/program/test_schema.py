"""The JSON Schemas: every shipped file is valid, and what only the parser refuses is one of MEANING, which a schema cannot say.

Needs python3-jsonschema and python3-yaml; ends with 77 without them.
"""
import json
import os
import re
import sys
import unittest

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"NOT RUN: {missing}; scripts/install-deps installs it", file=sys.stderr)
    sys.exit(77)

import hostsim
from hostsim import LEAST, SHIPPED

NUMBER = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
FLAG = re.compile(r"true|True|TRUE|false|False|FALSE")
NOTHING = re.compile(r"~|null|Null|NULL|")


class Core(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
    """YAML 1.2, as editors read it: `off` and `N` are texts."""
    yaml_implicit_resolvers = {}


for tag, found in (("bool", FLAG), ("int", NUMBER), ("float", FLOAT), ("null", NOTHING)):
    Core.add_implicit_resolver("tag:yaml.org,2002:" + tag, re.compile(f"^(?:{found.pattern})$"), None)


# What only the parser refuses: a change of the file BASE, or of no settings, that shows it, and what is said.
BASE = """\
name: n
shows: [SUP-2]
duration_ms: 1000
board: [reset_button]
steps:
  - {name: first, at_ms: 100, ai: stop}
  - {at_ms: 200, eps: set, field: mode, value: 01h, frames: 2}
expect:
  states: [{to: INIT, at_ms: [0, 5]}]
  frames: [{id: 168h, at_ms: 5}]
  led: [{code: 0, at_ms: 5}]
"""
MEANING = {
    "a step that is earlier than the one before": ("at_ms: 200", "at_ms: 50", "the step is earlier than the one before it"),
    "a time after the end": ("at_ms: 200", "at_ms: 2000", r"ms is after the end \(duration_ms"),
    "times of steps that add up to more than a day":
        ("{at_ms: 200,", "{after: first, wait: 86400000,", "ms is above the longest scenario, 86400000 ms"),
    "a range that ends before it begins": ("[0, 5]", "[5, 0]", "the lowest value is above the highest"),
    "a time that is too fine": ("at_ms: 100", "at_ms: 0.5ms", "is not a whole number of"),
    "a time with a unit that is out of range": ("at_ms: 100", "at_ms: 25h", "is not within [0-9a-z]+ to [0-9a-z]+$"),
    "a number in quotes that is out of range": ("frames: 2", 'frames: "0"', r"is not within -?\d+ to \d+"),
    "a value of a frame in decimal": ("value: 01h", "value: 12", "is not a hexadecimal number such as"),
    "an identifier with a zero before it": ("id: 168h", "id: 065", "is not an identifier: 168h"),
    "a number with a sign or a point, or an octal one": ("frames: 2", "frames: +2", "is not a (whole number|time)"),
    "a byte without quotes that has one digit": ("value: 01h, frames: 2", "value: 01h, frames: 2}\n  - {at_ms: 300, bus: "
                                                 "deliver, kind: data, id: 1h, bytes: 5", "is not a list of up to 8 bytes"),
    "frames that never end": ("frames: 2", "frames: 2, every_frames: 2", "every_frames: must be more than 'frames'"),
    "an anchor that there is not": ("{at_ms: 200,", "{after: nobody,", "after: '.*' is neither the name of a step"),
    "a step's name that is taken": ("{at_ms: 200,", "{name: first, at_ms: 200,", r"name: the step on line \d+ has this name"),
    "a step's name that is an event's": ("name: first", "name: trip", "name: 'trip' is the name of an event"),
    "an AI side that there is not": ("value: 01h, frames: 2", "value: 01h}\n  - {at_ms: 300, supervisor: overrun, side: ai",
                                     "side: only topology: gateway has an AI side"),
    "a part that the board does not have": ("board: [reset_button]", "board: []", "needs a board with 'reset_button'"),
    "too many repeated steps": ("steps:\n", "steps:\n" + "  - {at_ms: 1, ai: stop, again_every_ms: 5}\n" * 33,
                                "more than 32 steps with again_every_ms"),
    "a first frame that is looked for too late": ("id: 168h, at_ms: 5", "id: 168h, at_ms: 5, first_since_ms: 6",
                                                  "first_since_ms is after at_ms"),
    "settings that do not fit together": ("board:", "config: {own_heartbeat: frozen}\nboard:",
                                          "needs the gateway topology|another message has this identifier|must be (below|"
                                          "above) reset_hold|this fault must stay a (trip|warning)|the value is out of range"),
    "what is not checked with any states": ("states: [{to: INIT, at_ms: [0, 5]}]", "states: any\n  resets: [{accepted: true, at_ms: 5}]",
                                            "cannot be expected together with 'states: any'"),
    "a vehicle of which nothing is expected": ("  led: [", "  vehicle: [{at_ms: 5}]\n  led: [", "give at least one value"),
    "a name of more than a line": ("name: n\n", 'name: "a\\nb"\n', "name: must be one line"),
    "a name that is too long in bytes": ("name: n\n", "name: " + "\u00e4" * 60 + "\n", "longer than 95 bytes"),
}
MEANING_EXTRA = {"a part that the board does not have": ("at_ms: 200, eps: set, field: mode, value: 01h, frames: 2",
                                                         "at_ms: 200, board: press")}
# Settings only the parser refuses: a file, and what is said.
MEANING_OF_SETTINGS = {
    "settings that do not fit together": ("id_gear_command: 0x101\n", "another message has this identifier"),
    "an identifier with a zero before it": ("id_gear_command: 0101\n", "is not an identifier"),
    "a time that is too fine": ("init_hold_ms: 100.5ms\n", "is not a whole number of"),
    "a time with a unit that is out of range": ("init_hold_ms: 25h\n", "is not within"),
    "a number with a sign or a point, or an octal one": ("status_invalid_frames: +3\n", "is not a (whole number|time)"),
    "an identifier in quotes": ('id_gear_command: "168h"\n', "write the number without quotes"),
}


class Schemas(hostsim.Case):
    def setUp(self):
        super().setUp()
        self.validators = {}
        for command in ("scenario", "config"):
            schema = json.loads(self.run_good(command, "--schema").stdout)
            jsonschema.Draft7Validator.check_schema(schema)
            self.validators[command] = jsonschema.Draft7Validator(schema)

    def is_valid(self, command, text):
        return self.validators[command].is_valid(yaml.load(text, Core))

    def refusal(self, command, text):
        """What the parser says; an empty text: it takes the file. No scenario is run: the interfaces are not there."""
        self.write("file.yaml", text)
        if command == "config":
            result = self.run_program("config", "--config", "file.yaml")
            return result.stderr if result.status == 2 else ""
        result = self.run_program("scenario", "--bus", "no0,no1", "file.yaml")
        self.assertEqual(result.status, 2, result.stdout)
        return "" if result.stderr.startswith("host_sim: no0: ") else result.stderr

    def test_every_shipped_file_is_valid(self):
        self.assertGreaterEqual(len(SHIPPED), LEAST)
        for path in SHIPPED:
            errors = self.validators["scenario"].iter_errors(yaml.load(path.read_text(encoding="utf-8"), Core))
            self.assertEqual([error.message for error in errors], [], path)
        for options in ((), ("--topology", "gateway", "--id-set", "table")):
            settings = self.run_good("config", *options).stdout
            self.assertTrue(self.is_valid("config", settings))
        self.assertEqual(self.refusal("scenario", BASE), "")
        self.assertTrue(self.is_valid("scenario", BASE))
        print(f"\n{len(SHIPPED)} scenarios are valid", end=" ")

    def test_a_frame_is_sent_at_least_once(self):
        for times, is_good in ((0, False), (1, True)):
            text = BASE.replace("frames: 2}", 'frames: 2}\n  - {at_ms: 300, bus: send, id: 1h, bytes: "01", times: %d}' % times)
            self.assertEqual((self.is_valid("scenario", text), self.refusal("scenario", text) == ""), (is_good, is_good))

    def test_an_expected_frame_has_11_bits(self):
        for identifier, good in (("7FFh", True), ("0x800", False), ("2048", False)):
            text = BASE.replace("id: 168h", "id: " + identifier)
            self.assertEqual((self.is_valid("scenario", text), self.refusal("scenario", text) == ""), (good, good), identifier)

    def test_a_message_has_an_identifier(self):
        for text, good in (("id_gear_command: 0", False), ("id_gear_command: 000h", False), ("id_gear_command: 0x0", False),
                           ("id_gear_command: 169h", True), ("status_frame_id: 0", True)):
            self.assertEqual((self.is_valid("config", text), self.refusal("config", text) == ""), (good, good), text)

    def test_every_difference_is_one(self):
        for name, (old, new, said) in MEANING.items():
            with self.subTest(name):
                self.assertIn(old, BASE)
                text = BASE.replace(old, new)
                if name in MEANING_EXTRA:
                    text = text.replace(*MEANING_EXTRA[name])
                self.assertTrue(self.is_valid("scenario", text), text)
                self.assertRegex(self.refusal("scenario", text), said)
        for name, (text, said) in MEANING_OF_SETTINGS.items():
            with self.subTest(name):
                self.assertTrue(self.is_valid("config", text), text)
                self.assertRegex(self.refusal("config", text), said)


if __name__ == "__main__":
    os.environ.setdefault("HOST_SIM", "build/host/bin/host_sim")
    unittest.main()
