"""`host_sim config`, and configurations as files."""
import pathlib
import re
import unittest
import zlib

import hostsim
import traffic

ROOT = pathlib.Path(__file__).parents[3]
LOG = traffic.log(traffic.frames(50))

ENTRY = re.compile(r"^([a-z][a-z0-9_]*): (\S+)(?:  # .*)?$")


def entries(text):
    """The settings of a YAML file as host_sim writes it: key -> value, each once."""
    result = {}
    for line in text.splitlines():
        if line and not line.startswith("#"):
            match = ENTRY.match(line)
            assert match, line
            assert match[1] not in result, line
            result[match[1]] = match[2]
    return result


def is_number(value):
    return re.fullmatch(r"\d+|0x[0-9A-F]{3}", value) is not None


def checksum_of(text):
    return re.search(r"^# Checksum: ([0-9A-F]{8})$", text, re.MULTILINE)[1]


class Listing(hostsim.Case):
    def test_every_setting_stands_with_default_unit_range_and_meaning(self):
        text = self.run_good("config").stdout
        found = entries(text)
        for key in found:
            if not key.startswith("class_"):
                self.assertRegex(text, r"(?m)^# \S.*\n# ((?:0x)?[\dA-F]+ to .*|[a-z_]+(?:\|[a-z_]+)+), default \w+(; [^;\n]+)*\n%s: " % key)
        self.assertIn("# 30 to 500 ms, default 50; a higher value weakens the supervision\nvcu_heartbeat_timeout_ms: 50\n", text)
        self.assertIn("# 0x001 to 0x7FF, default 0x168\nid_gear_command: 0x168\n", text)
        self.assertIn("default 0x7F0; 0 weakens the supervision\nstatus_frame_id: 0x7F0\n", text)
        self.assertIn("# shared|gateway, default shared\n", text)
        self.assertIn("# at_once|at_standstill, default at_once; at_standstill weakens the supervision\n", text)
        self.assertIn("default 100; gateway only\nthrottle_ceiling_pct: 100\n", text)

    def test_no_line_is_wider_than_a_terminal(self):
        self.assertEqual([line for line in self.run_good("config").stdout.splitlines() if len(line) > 100], [])

    def test_a_changed_configuration_is_taken_back(self):
        self.write("a.yaml", "topology: gateway\nown_heartbeat: frozen\nid_set: table\nstatus_frame_id: 0x7A0\n"
                             "class_remote_signal_lost: warn\nclass_store_invalid: trip\nshadow: on\nid_gear_command: 361\n")
        text = self.run_good("config", "--config", "a.yaml").stdout
        self.assertEqual(entries(text)["status_frame_id"], "0x7A0")
        self.assertEqual(entries(text)["id_gear_command"], "0x169")
        self.assertEqual(entries(text)["class_remote_signal_lost"], "warn")
        self.write("b.yaml", text)
        self.assertEqual(self.run_good("config", "--config", "b.yaml").stdout, text)
        self.assertEqual(self.run_good("config", "--config", "b.yaml").stderr, "")


class Kconfig(hostsim.Case):
    def test_the_fragment_says_the_same(self):
        self.write("c.yaml", "topology: gateway\ninit_hold_ms: 700\nid_gear_command: 0x169\nclass_remote_signal_lost: warn\n"
                             "class_eps_temp_above_110: trip\n")
        yaml = self.run_good("config", "--config", "c.yaml").stdout
        kconfig = self.run_good("config", "--config", "c.yaml", "--to-kconfig").stdout
        self.assertEqual(checksum_of(yaml), checksum_of(kconfig))
        lines = [line for line in kconfig.splitlines() if not line.startswith("#")]
        self.assertEqual(len(lines), len(set(lines)))
        classes = 0
        for key, value in entries(yaml).items():
            name = "CONFIG_AGV_" + key.upper()
            if is_number(value):
                self.assertIn("%s=%s" % (name, value), lines)
            elif not key.startswith("class_"):
                self.assertIn("%s_%s=y" % (name, value.upper()), lines)
            elif "%s_%s=y" % (name, value.upper()) in lines:
                classes += 1
            else:  # only a class that cannot be chosen may be missing
                self.assertRegex(yaml, r"(?m)^%s: .*mandatory$" % key)
        self.assertIn("CONFIG_AGV_CLASS_REMOTE_SIGNAL_LOST_WARN=y", lines)
        self.assertIn("CONFIG_AGV_ID_GEAR_COMMAND=0x169", lines)
        self.assertIn("CONFIG_AGV_ID_THROTTLE_COMMAND=0x075", lines)
        self.assertIn("CONFIG_AGV_CLASS_EPS_TEMP_ABOVE_110_TRIP=y", lines)
        settings = [key for key in entries(yaml) if not key.startswith("class_")]
        self.assertEqual(len(lines), len(settings) + classes)

    def test_the_checksum_is_what_the_header_says(self):
        """CRC-32 over all settings, 16 bit little-endian each, then the trips, 32 bit little-endian words."""
        text = self.run_good("config").stdout
        values, trips, faults = b"", 0, 0
        for key, value in entries(text).items():
            if key.startswith("class_"):
                trips |= (value == "trip") << faults
                faults += 1
            elif is_number(value):
                values += int(value, 0).to_bytes(2, "little")
            else:
                words = re.search(r"^# ([a-z_|]+), default \S+.*\n%s: " % key, text, re.MULTILINE)[1].split("|")
                values += words.index(value).to_bytes(2, "little")
        expected = zlib.crc32(values + trips.to_bytes((faults + 31) // 32 * 4, "little"))
        self.assertEqual(checksum_of(text), "%08X" % expected)


class Deviations(hostsim.Case):
    # Shows: INT-2
    def test_what_is_not_the_default_is_listed_at_the_start(self):
        self.write("log", LOG)
        self.write("c.yaml", "init_hold_ms: 700\npark: at_standstill\nclass_remote_signal_lost: warn\n"
                             "tx_stalled_ms: 100\n")
        result = self.run_good("replay", "--config", "c.yaml", "--shadow", "--events", "-", "log")
        self.assertEqual(result.stderr, "host_sim: not the default: shadow: on (default off, WEAKER), "
                                        "park: at_standstill (default at_once, WEAKER), "
                                        "init_hold_ms: 700 (default 500), "
                                        "class_remote_signal_lost: warn (default trip, WEAKER)\n")
        self.assertTrue(result.stdout.startswith('{"t_ms"'))

    # Shows: INT-2
    def test_each_command_that_runs_the_supervisor_lists_them_once(self):
        self.write("c.yaml", "mode_invalid_ms: 60\n")
        log = ROOT / "host_sim/examples/ai-stops.log"
        scenario = ROOT / "host_sim/scenarios/overview/demo.yaml"
        own = self.write("own.yaml", scenario.read_text() + "config: {mode_invalid_ms: 60}\n")  # part of the test: not listed
        listed = "host_sim: not the default: mode_invalid_ms: 60 (default 50, WEAKER)\n"
        for arguments in (("demo",), ("demo", "--events", "-"), ("scenario", scenario, scenario),
                          ("scenario", own), ("scenario", "--events", "-", scenario), ("scenario", "--from", log),
                          ("monitor", "--speed", "max", "--log", log), ("replay", log)):
            with self.subTest(arguments):
                plain = self.run_good(*arguments)
                changed = self.run_good(arguments[0], "--config", "c.yaml", *arguments[1:])
                self.assertEqual(changed.stderr, listed + plain.stderr)
                if "--from" not in arguments:  # it writes the settings into the scenario that it makes
                    self.assertEqual(changed.stdout, plain.stdout)


if __name__ == "__main__":
    unittest.main()
