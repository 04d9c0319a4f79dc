"""The program's front: commands, options, exit status, one line for what is wrong."""
import os
import pathlib
import random
import re
import subprocess
import unittest

import hostsim
import traffic

EXAMPLE = pathlib.Path(__file__).parents[3] / "host_sim/examples/ai-stops.log"
LOG = traffic.log(traffic.frames(100))


class Front(hostsim.Case):
    def test_version_is_one_line(self):
        result = self.run_good("--version")
        self.assertRegex(result.stdout, r"\Ahost_sim \d+\.\d+\.\d+\n\Z")
        self.assertEqual(result.stdout, self.run_good("-V").stdout)
        self.assertEqual(result.stderr, "")

    def test_help_lists_the_commands_and_each_has_its_own(self):
        commands = self.commands()
        self.assertLessEqual({"config", "replay"}, set(commands))
        for command in commands:
            text = self.run_good(command, "--help").stdout
            self.assertIn("usage: host_sim " + command, text)
            self.assertEqual(text, self.run_good(command, "-h").stdout)
            self.assertEqual(text, self.run_good("help", command).stdout)
            self.assertEqual([line for line in text.splitlines() if len(line) > 100], [])
        self.assertEqual(self.run_good("--help").stdout, self.run_good("help").stdout)
        self.assertEqual(self.run_good("--help").stdout, self.run_good("-h").stdout)
        self.assertEqual([line for line in self.run_good("-h").stdout.splitlines() if len(line) > 100], [])

    def test_help_wins_over_what_comes_after_it(self):
        self.run_good("replay", "--help", "--nonsense")

    def test_what_was_meant(self):
        self.write("c.yaml", "init_hold: 700\n")
        self.write("d.yaml", "park: AT_ONCE\n")
        self.write("s.yaml", "name: n\nshow: [SUP-2]\n")
        for arguments, says in ((("replya",), "unknown command 'replya': did you mean 'replay'?"),
                                (("help", "moniter"), "unknown command 'moniter': did you mean 'monitor'?"),
                                (("--hepl",), "unknown command '--hepl': did you mean '--help'?"),
                                (("version",), "unknown command 'version': did you mean '--version'?"),
                                (("-v",), "unknown command '-v': did you mean '-V'?"),
                                (("c.yaml",), "no command before the file 'c.yaml', such as replay"),
                                (("run", "can0"), "unexpected argument 'can0': did you mean '--can can0'?"),
                                (("demo", "reset"), "unexpected argument 'reset': did you mean '--scenario reset'?"),
                                (("vehicle", "--can", "none", "--fault", "ai-stpo@2s"), "unknown action 'stpo': did you mean 'stop'?"),
                                (("vehicle", "--can", "none", "--fault", "ai-mute,message=gear_comand@2s"), "did you mean 'gear_command'?"),
                                (("demo", "--scenario", "resett"), "no scenario 'resett': did you mean 'reset'?"),
                                (("campaign", "--runs", "1", "--seed", "1", "--fault", "bus-of"), "did you mean 'BUS_OFF'?"),
                                (("atlas", "--second", "bus-of"), "--second: unknown fault 'bus-of': did you mean 'BUS_OFF'?"),
                                (("config", "--config", "c.yaml"), "c.yaml:1: init_hold: unknown setting: did you mean 'init_hold_ms'?"),
                                (("config", "--config", "d.yaml"), "'AT_ONCE' is not one of at_once|at_standstill: did you mean 'at_once'?"),
                                (("scenario", "s.yaml"), "s.yaml:2: unknown key 'show' in a scenario: did you mean 'shows'?")):
            with self.subTest(says):
                self.assert_refused(self.run_program(*arguments), says)

    def test_every_command_refuses_an_unknown_option_by_its_name(self):
        for command in self.commands():
            for option in ("--nonsense", "--nonsense=1", "-n"):
                self.assert_refused(self.run_program(command, option), "'" + option + "'", command)

    def test_random_options(self):
        chance = random.Random(6)
        self.write("log", traffic.log(traffic.frames(5)))
        words = ["replay", "config", "--out", "--events", "--tail", "--start-ms", "--skip-bad-lines", "--ai-if",
                 "--reset-cause", "--store", "--config", "--topology", "--id-set", "--shadow", "--help", "--to-kconfig",
                 "log", "-", "--", "", "1", "gateway", "shared", "table", "watchdog", "can0", "=", "--tail=5", "-x", "o1",
                 "--out=o2", "--start-ms=4294967295", "\n", "%n"]
        for _ in range(100):
            arguments = ["replay"] * chance.randrange(2) + chance.choices(words, k=chance.randrange(7))
            result = self.run_program(*arguments)
            self.assertIn(result.status, (0, 2), arguments)
            if result.status == 2:
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            for name in self.files():
                if name != "log":
                    (self.folder / name).unlink()


class Examples(hostsim.Case):
    """The examples of every help work as they stand, one after the other, in any folder; but the long ones do less."""
    LESS = {"--runs 200": "--runs 20", "--hours 1 ": "--hours 1 --shard 1/20 ", "--hours 30d": "--hours 1d",
            "atlas --shard": "atlas --first BUS_OFF --shard"}
    ON_A_BUS = {"monitor": 1, "run": 2, "scenario": 1, "survey": 1, "vehicle": 2}

    def examples(self, command, **options):
        text = self.run_good("help", command, **options).stdout
        return re.findall(r"^  (host_sim .*)\n      \S", text.split("\nExamples:\n")[1], re.MULTILINE)

    def test_each_one(self):
        path = "%s:%s" % (os.path.dirname(hostsim.PROGRAM), os.environ["PATH"])
        less = re.compile("|".join(self.LESS))
        for command in self.commands():
            examples = self.examples(command)
            self.assertIn(len(examples), (2, 3), command)
            alone = [line for line in examples if "--can" not in line and "--bus" not in line]
            self.assertEqual(len(examples) - len(alone), self.ON_A_BUS.get(command, 0), command)
            if command == "man":
                alone.remove("host_sim man replay | man -l -")  # test_man_pages
            for line in alone:
                line = less.sub(lambda found: self.LESS[found[0]], line)
                done = subprocess.run(["sh", "-c", line], cwd=self.folder, env={**os.environ, "PATH": path}, check=False,
                                      stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300)
                self.assertEqual(done.returncode, 0, line + "\n" + done.stderr.decode())

    def test_files_are_named_as_one_would_type_them(self):
        source = pathlib.Path(__file__).parents[3]
        done = subprocess.run([hostsim.PROGRAM, "help", "replay"], cwd=source, stdout=subprocess.PIPE, check=True)
        self.assertIn(b"\n  host_sim replay host_sim/examples/ai-stops.log\n", done.stdout)
        self.assertIn("host_sim replay %s/host_sim/examples/ai-stops.log" % source, self.examples("replay"))


class ExitStatus(hostsim.Case):
    ROWS = {0: ("replay", EXAMPLE), 1: ("replay", "--fail-on-trip", EXAMPLE), 2: ("replay", "nofile")}

    def test_the_table_is_the_same_everywhere_and_right(self):
        text = re.sub(r"\n {5}(?=\S)", " ", self.run_good("--help").stdout)  # longer lines than 100 columns
        printed = dict(re.findall(r"^  (\d)  (.*)$", text, re.MULTILINE))
        manual = (pathlib.Path(__file__).parents[3] / "docs/host-sim.md").read_text(encoding="utf-8")
        self.assertEqual(printed, {status: means.replace("`", "")
                                   for status, means in re.findall(r"^\| (\d) \| (.*) \|$", manual, re.MULTILINE)})
        self.assertEqual({int(status) for status in printed}, set(self.ROWS))
        for status, arguments in self.ROWS.items():
            self.assertEqual(self.run_program(*arguments).status, status)
        page = self.run_good("man").stdout.replace("\\-", "-")
        for status, means in printed.items():
            self.assertIn("\\fB%s\\fR\n%s\n" % (status, means), page)


class StandardOutput(hostsim.Case):
    """What does not arrive is noticed."""

    def test_a_full_disk(self):
        self.write("log", LOG)
        for arguments in (("--help",), ("--version",), ("config",), ("config", "--to-kconfig"), ("replay", "--help"),
                          ("replay", "log"), ("replay", "--events", "-", "log"), ("replay", "--out=-", "log"),
                          # what is noticed long before the end
                          ("monitor", "--shadow", "--speed", "max", "--log", "log"), ("scenario", "--schema"),
                          ("config", "--schema"), ("survey", "--json", "log")):
            with self.subTest(arguments), open("/dev/full", "wb") as full:
                self.assert_refused(self.run_program(*arguments, stdout=full), "standard output: No space left on device")

    def test_a_closed_pipe(self):
        self.write("log", traffic.log(traffic.frames(3000)))
        for arguments in (("config",), ("replay", "--out", "-", "log"), ("replay", "log"),
                          ("monitor", "--log", "log", "--speed", "max", "--shadow")):
            with self.subTest(arguments):
                reading, writing = os.pipe()
                os.close(reading)
                result = self.run_program(*arguments, stdout=writing)
                os.close(writing)
                self.assert_refused(result, "standard output: Broken pipe")

    def test_a_closed_standard_output(self):
        self.write("log", LOG)
        done = subprocess.run(["sh", "-c", '"$0" config >&-', hostsim.PROGRAM], stderr=subprocess.PIPE, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr.count(b"\n"), 1)


if __name__ == "__main__":
    unittest.main()
