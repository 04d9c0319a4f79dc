"""Campaigns: the same runs in every sharding, results that merge, breaks that leave a scenario, one line for what is wrong."""
import json
import pathlib
import re
import subprocess
import sys
import unittest

import hostsim

ROOT = pathlib.Path(__file__).resolve().parents[3]
PICTURE = ROOT / "scripts/campaign-picture"
ATLAS_PAGE = ROOT / "tests/proofs/atlas/atlas-page.py"
VERSION = subprocess.run([hostsim.PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
RUNS = 45  # enough for each fault that an engagement delays, and for each topology, bit rate, setting of the vehicle


class Campaign(hostsim.Case):
    def campaign(self, *arguments, status=0, **options):
        result = self.run_program("campaign", *arguments, **options)
        self.assertEqual(result.status, status, result.stdout + result.stderr)
        return result

    def shard(self, number, of, runs=20, seed=7, name=None):
        name = name or f"{number}.jsonl"
        self.campaign("--runs", runs, "--seed", seed, "--shard", f"{number}/{of}", "--results", name)
        return name

    def lines(self, name):
        return [json.loads(line) for line in self.read(name).splitlines()]

    def refuse(self, *arguments, says):
        result = self.run_program("campaign", *arguments)
        self.assert_refused(result, says)
        self.assertEqual(result.stdout, "")
        self.assertEqual([name for name in self.files() if name == "out.jsonl"], [])


class Results(Campaign):
    def test_every_sharding_merges_to_the_same_bytes_and_the_same_table(self):
        whole = self.campaign("--runs", 20, "--seed", 7, "--results", "whole.jsonl")
        for shards in (1, 2, 7):
            files = [self.shard(number, shards) for number in range(shards, 0, -1)]
            merged = self.campaign("--merge", *files, "--results", "merged.jsonl")
            self.assertEqual(merged.stdout, whole.stdout)
            self.assertEqual((self.folder / "merged.jsonl").read_bytes(), (self.folder / "whole.jsonl").read_bytes())

    def test_results_on_standard_output_are_all_that_is_there(self):
        self.campaign("--runs", 5, "--seed", 7, "--results", "file.jsonl")
        printed = self.campaign("--runs", 5, "--seed", 7, "--results", "-").stdout
        self.assertEqual(printed, self.read("file.jsonl"))
        self.assertEqual(self.campaign("--merge", "file.jsonl", "--results", "-").stdout, printed)

    def test_a_shard_without_runs_is_one_that_merges(self):
        files = [self.shard(number, 3, runs=2) for number in (1, 2, 3)]
        self.assertEqual(len(self.lines("3.jsonl")), 1)
        self.assertIn("2 runs, 0 broken", self.campaign("--merge", *files).stdout)

    def test_an_angle_that_is_held_once_the_eps_takes_it_is_no_unsafe_frame(self):
        """Run 5541: MODE_INVALID in manual. The EPS changes to angle control after the trip, while the wheels turn."""
        self.campaign("--runs", 50000, "--seed", 1, "--shard", "542/1000", "--results", "out.jsonl")
        self.assertIn(5541, [line.get("run") for line in self.lines("out.jsonl")])

    def test_another_seed_is_another_campaign(self):
        self.shard(1, 1, seed=7, name="a")
        self.shard(1, 1, seed=8, name="b")
        self.assertNotEqual(self.lines("a")[1:], self.lines("b")[1:])

    def test_a_line_says_what_was_done_and_what_came_of_it(self):
        self.shard(1, 1, runs=RUNS, name="a")
        head, *runs = self.lines("a")
        self.assertEqual((head["campaign"], head["runs"], head["seed"], head["shard"], head["shards"]), (1, RUNS, 7, 1, 1))
        self.assertEqual([run["run"] for run in runs], list(range(RUNS)))
        for key, values in (("topology", {"shared", "gateway"}), ("bitrate", {125000, 250000, 500000}),
                            ("id_set", {"heading", "table"}), ("park_guard", {True, False}),
                            ("park", {"at_once", "at_standstill"}), ("mode", {"autopilot", "manual"}),
                            ("bunched", {True, False}), ("broken", {None})):
            self.assertEqual({run[key] for run in runs}, values, key)
        for run in runs:
            if run["safe_us"] is not None:
                self.assertGreater(run["safe_us"], 0)

    def test_the_table_is_what_the_lines_say(self):
        table = self.campaign("--runs", RUNS, "--seed", 7, "--results", "a").stdout
        runs = self.lines("a")[1:]
        for fault in {run["fault"] for run in runs}:
            times = sorted(run["safe_us"] for run in runs if run["fault"] == fault and run["safe_us"] is not None)
            line = re.search(rf"(?m)^{fault} +(\d+) +(\S+) +(\S+) +(\S+) ", table)
            self.assertEqual(int(line[1]), sum(run["fault"] == fault for run in runs))
            for shown, time in zip(line.groups()[1:], (times[0], times[len(times) // 2], times[-1])):
                self.assertEqual(shown, f"{time // 1000}.{time % 1000:03}")

    def test_one_fault_alone(self):
        self.campaign("--runs", 20, "--seed", 1, "--fault", "BUS_OFF", "--results", "a")
        self.assertEqual({run["fault"] for run in self.lines("a")[1:]}, {"BUS_OFF"})

    def test_a_counter_that_stands_in_frames_that_are_late_is_lost(self):
        """On a full bus of 125 kbit/s 363h stays away for more than two cycles, right at the deadline (SUP-2)."""
        self.campaign("--runs", 4180, "--seed", 20, "--fault", "VCU_HEARTBEAT_STUCK", "--shard", "180/1000",
                      "--results", "a")
        self.assertEqual(self.lines("a")[-1]["reason"], "VCU_HEARTBEAT_LOST")

    def test_no_bar_where_there_is_no_terminal(self):
        self.assertEqual(self.campaign("--runs", 5, "--seed", 1).stderr, "")

    def test_all_faults_but_three_are_caused(self):
        tables = json.loads(self.campaign("--tables").stdout)
        rows = [row["fault"] for row in tables["rows"]]
        self.assertEqual(len(rows), len(set(rows)))
        self.assertEqual(set(tables["faults"]) - set(rows), {"TX_GATE_REFUSED", "STARTUP_TIMEOUT", "MOVING_WHILE_SAFE"})
        self.assertEqual(rows, [fault for fault in tables["faults"] if fault in rows])


class NewlyEngaged(Campaign):
    FAULTS = {"AI_HEARTBEAT_LOST", "GEAR_COMMAND_TIMEOUT", "THROTTLE_COMMAND_TIMEOUT", "STEERING_COMMAND_TIMEOUT",
              "AI_COMMAND_OUT_OF_RANGE", "EPS_MODE_OFF", "EPS_MODE_INVALID", "EPS_MODE_NOT_ANGLE", "GEAR_STATUS_INVALID",
              "THROTTLE_STATUS_INVALID", "STEERING_ANGLE_INVALID", "STEERING_DEVIATION", "THROTTLE_DEVIATION",
              "AUTOPILOT_OFF_IGNORED", "THROTTLE_IN_PARK"}

    def test_the_faults_that_an_engagement_delays(self):
        self.campaign("--runs", RUNS, "--seed", 3, "--newly-engaged", "--results", "a")
        head, *runs = self.lines("a")
        self.assertIs(head["newly_engaged"], True)
        self.assertEqual({run["fault"] for run in runs}, self.FAULTS)
        self.assertEqual({(run["mode"], run["broken"]) for run in runs}, {("autopilot", None)})

    def test_nothing_is_judged_in_the_first_half_second(self):
        self.campaign("--runs", 20, "--seed", 4, "--newly-engaged", "--fault", "EPS_MODE_OFF", "--results", "a")
        for run in self.lines("a")[1:]:
            # A cause that comes up to 500 ms after the switch waits for the rest of the 500 ms; then five frames of 10 ms.
            self.assertTrue(40000 < run["safe_us"] < 620000, run)
        self.assertGreater(max(run["safe_us"] for run in self.lines("a")[1:]), 300000)

    def test_a_run_is_a_scenario_that_passes(self):
        for run in range(13 if hostsim.PART == 1 else 3):
            shown = self.campaign("--runs", 13, "--seed", 3, "--newly-engaged", "--show", run).stdout
            self.write("run.yaml", shown)
            self.run_good("scenario", "run.yaml")

    def test_what_is_refused(self):
        good = ("--runs", "4", "--seed", "1")
        self.campaign(*good, "--newly-engaged", "--shard", "1/2", "--results", "1")
        self.campaign(*good, "--shard", "2/2", "--results", "2")
        self.refuse("--merge", "1", "2", says="2:1: not the same campaign as 1")
        head, *runs = self.read("2").splitlines(keepends=True)
        runs[0] = json.dumps({**json.loads(runs[0]), "fault": "BUS_OFF"}) + "\n"
        self.write("2", "".join([head.replace('"newly_engaged": false', '"newly_engaged": true'), *runs]))
        self.refuse("--merge", "1", "2", says="2:2: its fault cannot occur in a campaign with --newly-engaged")


class Broken(Campaign):
    def test_a_supervisor_that_does_nothing_or_is_always_tripped_breaks_every_run_and_its_scenarios_fail(self):
        for stub, broken in (("mute", {"NOT_READY", "LATE"}), ("tripped", {"NOT_READY", "WRONG_REASON"})):
            (self.folder / stub).mkdir()
            self.campaign("--runs", 30, "--seed", 3, "--broken", stub, "--results", "a", status=1, program=hostsim.STUBS[stub])
            self.assertEqual({run["broken"] for run in self.lines("a")[1:]}, broken)
            result = self.run_program("scenario", *(self.folder / stub).iterdir(), program=hostsim.STUBS[stub])
            self.assertEqual(result.status, 1)
            self.assertIn("20 scenarios: 0 passed, 20 failed", result.stdout)

    def test_a_run_is_a_scenario_that_passes(self):
        files = []
        for run in range(60):
            files.append(f"{run}.yaml")
            self.write(files[-1], self.campaign("--runs", 60, "--seed", 5, "--show", run).stdout)
        result = self.run_good("scenario", *files)
        self.assertIn("60 scenarios: 60 passed, 0 failed", result.stdout)


class Refused(Campaign):
    def test_what_does_not_merge(self):
        one, two = self.shard(1, 2), self.shard(2, 2)
        out = ("--results", "out.jsonl")
        self.refuse("--merge", one, *out, says="one of 2 shards, but 1 were given")
        self.refuse("--merge", one, one, *out, says="shard 1 is given twice")
        self.refuse("--merge", one, "nowhere", *out, says="nowhere")
        self.refuse("--merge", one, self.shard(2, 2, seed=8, name="seed"), *out, says="not the same campaign")
        self.refuse("--merge", one, self.shard(2, 2, runs=18, name="runs"), *out, says="not the same campaign")
        lines = self.read(two).splitlines(keepends=True)
        for name, changed, says in (("cut", lines[:-1], "it ends after line"),
                                    ("more", lines + lines[-1:], "more runs than the campaign has"),
                                    ("gap", lines[:5] + lines[6:], ":6: run 9 is expected here"),
                                    ("torn", lines[:-1] + [lines[-1][:20]], "not a result of a campaign"),
                                    ("open", lines[:-1] + [lines[-1][:-1]], "a campaign: the line is incomplete"),
                                    ("text", ["hello\n"], ":1: not a result of a campaign"),
                                    ("other", ["{}\n"], ":1: no results of a campaign"),
                                    ("empty", [], "empty: is empty")):
            self.write(name, "".join(changed))
            self.refuse("--merge", one, name, *out, says=says)

    def refuse_line(self, number, line, says):
        """Shard 2 of 2, of which a line is another."""
        lines = self.read("2.jsonl").splitlines(keepends=True)
        lines[number - 1] = line if isinstance(line, str) else json.dumps(line) + "\n"
        self.write("bad", "".join(lines))
        self.refuse("--merge", "1.jsonl", "bad", "--results", "out.jsonl", says=f"bad:{number}: {says}")

    def test_a_damaged_head_or_run_does_not_merge(self):
        self.shard(1, 2, runs=6)
        self.shard(2, 2, runs=6)
        head, _, run, *_ = self.lines("2.jsonl")
        no_head, no_run = f"no results of a campaign of host_sim {VERSION}: ", "not a result of a campaign: "
        for number, changed, says in (
                (1, {**head, "version": "0.0.0"}, no_head + "its 'version' is missing or wrong"),
                (1, {**head, "shard": 4294967298}, no_head + "its 'shard' is missing or wrong"),
                (1, {**head, "fault": "BUS_OFF"}, "not the same campaign as 1.jsonl"),
                (3, {**run, "fault": "TX_GATE_REFUSED"}, no_run + "its 'fault' is missing or wrong"),
                (3, {**run, "safe_us": 1.0}, no_run + "its 'safe_us' is missing or wrong"),
                (3, {key: value for key, value in run.items() if key != "mode"}, no_run + "its 'mode' is missing or wrong"),
                (3, {**run, "more": 1}, no_run + "its 'number of keys' is missing or wrong"),
                (3, {**run, "run": 1}, "run 3 is expected here"),
                (3, " " + json.dumps(run) + "\n", "not a result of a campaign"),
                (3, '{"run": 3, ' + json.dumps(run)[1:] + "\n", "not a result of a campaign")):
            self.refuse_line(number, changed, says)

    def test_a_run_of_another_fault_does_not_merge(self):
        for number in (1, 2):
            self.campaign("--runs", 6, "--seed", 7, "--fault", "BUS_OFF", "--shard", f"{number}/2", "--results",
                          f"{number}.jsonl")
        self.refuse_line(3, {**self.lines("2.jsonl")[2], "fault": "TX_STALLED"}, "its fault is not that of the campaign (--fault)")


class Picture(Campaign):
    def draw(self, *arguments):
        return subprocess.run([sys.executable, PICTURE, *arguments], cwd=self.folder, capture_output=True, text=True,
                              check=False)

    def test_a_histogram_of_all_runs(self):
        self.shard(1, 1, name="a")
        done = self.draw("a", "picture.svg")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        text = self.read("picture.svg")
        self.assertIn("20 runs", text)
        self.assertIn("500 kbit/s", text)

    def test_what_cannot_be_drawn(self):
        self.shard(1, 1, runs=2, name="a")
        self.write("b", "hello\n")
        for arguments, says in ((("a", "picture.txt"), "neither .svg nor .png"), (("b", "b.svg"), "b"),
                                (("nowhere", "b.svg"), "nowhere"), (("a", "no/where.svg"), "gnuplot failed")):
            done = self.draw(*arguments)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
            self.assertIn(says, done.stderr)


class AtlasPage(hostsim.Case):
    def make(self, *arguments):
        return subprocess.run([sys.executable, ATLAS_PAGE, *arguments], cwd=self.folder, capture_output=True, text=True,
                              check=False)

    def results(self):
        """One pair of faults, without the runs: its head and one case."""
        half = {"reason": None, "state": "STANDBY", "safe_us": None, "open_us": None, "stop_us": None, "hazard": None}
        head = {"atlas": 1, "version": "0.2.0", "shard": 1, "shards": 1}
        case = {"case": 8, "topology": "shared", "in": "STANDBY", "first": "BUS_OFF", "second": "TX_STALLED", "distance_ms": 0,
                "both": half, "first_alone": half, "second_alone": half, "weaker": None, "known": None}
        return json.dumps(head) + "\n" + json.dumps(case) + "\n"

    def test_a_pair_is_of_two_faults(self):
        self.write("a", self.results())
        done = self.make("a", "-o", "a.html")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("1 case of 2 faults, weaker than their worse baseline: none", done.stdout)

    def test_what_is_refused_in_one_line_with_the_file(self):
        self.write("bytes", b"\x7fELF\xff\xfe")
        self.write("text", "hello\n")
        self.write("list", "[]\n")
        self.write("damaged", self.results() + "{}\n")
        self.write("good", self.results())
        for arguments, said in ((("nofile",), "nofile: No such file or directory"), (("bytes",), "bytes holds no results"),
                                (("text",), "text holds no results"), (("list",), "list holds no results"),
                                (("damaged",), "damaged holds no results of host_sim atlas, or is damaged"),
                                (("good", "good"), "shard 1 is given twice"),
                                (("good", "-o", "no/where"), "no/where: No such file or directory")):
            done = self.make("-o", "x.html", *arguments)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
            self.assertIn(f"atlas-page: {said}", done.stderr)


if __name__ == "__main__":
    unittest.main()
