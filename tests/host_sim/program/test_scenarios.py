"""Every shipped scenario: as it is, in the other topology and with the other ID set; and that each of them can fail."""
import concurrent.futures
import json
import os
import re
import shutil
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree

import hostsim
from hostsim import LEAST, SCENARIOS, SHIPPED

GOOD = """\
name: N & <N>
shows: [SUP-2]
duration_ms: 600
expect:
  states: [{to: INIT, at_ms: 0}, {to: STANDBY, at_ms: [510, 513]}]
  safety_output: [{closed: true, at_ms: [410, 513]}]
"""


def fixes(path, key):
    return any(line.startswith(key + ":") for line in path.read_text(encoding="utf-8").splitlines())


class Playing(hostsim.Case):
    def play(self, files, *options, least=LEAST):
        self.assertGreaterEqual(len(files), least)
        result = self.run_program("scenario", "--junit", "j.xml", *options, *files, timeout=500)
        failed = [line for line in result.stdout.splitlines() if not line.startswith("ok ")]
        self.assertEqual(result.status, 0, "\n".join(failed) + result.stderr)
        suite = xml.etree.ElementTree.parse(self.folder / "j.xml").getroot()
        self.assertEqual(suite.get("tests"), str(len(files)))
        self.assertEqual(suite.get("failures"), "0")
        self.assertEqual(len(suite.findall("testcase")), len(files))
        print(f"\n{len(files)} scenarios passed {' '.join(options)}", end=" ")


class Shipped(Playing):
    def test_every_scenario_passes(self):
        self.play(SHIPPED)

    def test_what_why_and_events_say_of_every_scenario_agrees(self):
        def check(path):
            files = [self.folder / f"{path.stem}.{name}" for name in ("why", "events")]
            self.run_good("scenario", "--why", files[0], "--events", files[1], path)
            why = json.loads(files[0].read_text(encoding="utf-8"))
            events = [json.loads(line) for line in files[1].read_text(encoding="utf-8").splitlines()]
            warned = [event for event in events if event.get("class") == "warn" and event["active"]]
            return {"supervised": events[-1]["supervised_ms"] - why["supervised_ms"],
                    "warnings": events[-1]["warnings"] - len(warned),
                    "causes after their trip": [trip["t_ms"] for trip in why["trips"] if (trip["cause_ms"] or 0) > trip["t_ms"]],
                    "last good frames after the cause": [trip["t_ms"] for trip in why["trips"] if trip["last_good_ms"] is not None
                                                         and trip["last_good_ms"] > trip["cause_ms"]]}
        with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
            for path, differs in zip(SHIPPED, pool.map(check, SHIPPED)):
                self.assertEqual([key for key, value in differs.items() if value], [], path.stem)


class Gateway(Playing):
    # Shows: TOP-2
    def test_every_scenario_that_leaves_the_topology_open_passes_in_the_gateway(self):
        self.play([path for path in SHIPPED if not fixes(path, "topology")], "--topology", "gateway", least=LEAST * 2 // 3)


class TableIds(Playing):
    # Shows: P1
    def test_every_scenario_that_leaves_the_id_set_open_passes_with_the_table_ids(self):
        self.play([path for path in SHIPPED if not fixes(path, "id_set")], "--id-set", "table")


class Stubs(hostsim.Case):
    """No scenario passes against a supervisor that does nothing, nor against one that is always tripped."""

    def play_against(self, stub):
        result = self.run_program("scenario", *SHIPPED, program=hostsim.STUBS[stub])
        self.assertEqual(result.status, 1, result.stderr)
        passed = [line for line in result.stdout.splitlines() if line.startswith("ok ")]
        self.assertEqual(passed, [])
        self.assertEqual(result.stdout.count("FAILED  "), len(SHIPPED))
        print(f"\n{len(SHIPPED)} scenarios failed: {stub}", end=" ")

    def test_a_mute_one(self):
        self.play_against("mute")

    def test_one_that_is_always_tripped(self):
        self.play_against("tripped")


class Command(hostsim.Case):
    def scenario(self, text, *options):
        self.write("s.yaml", text)
        return self.run_program("scenario", *options, "s.yaml")

    def test_it_says_what_held(self):
        result = self.scenario(GOOD)
        self.assertEqual(result.status, 0, result.stderr)
        self.assertEqual(result.stdout, "ok      s.yaml: 3 expectations\n1 scenario: 1 passed, 0 failed\n")

    def test_a_single_expectation(self):
        for states, status, said in (("[{to: INIT, at_ms: 0}]", 0, "ok      s.yaml: 1 expectation\n"),
                                     ("[{to: SAFE, at_ms: 0}]", 1, "FAILED  s.yaml: 1 of 1 expectation\n")):
            result = self.scenario("name: n\nshows: [SUP-2]\nduration_ms: 1\nexpect: {states: %s}\n" % states)
            self.assertEqual(result.status, status, result.stdout)
            self.assertIn(said, result.stdout)

    def test_the_name_of_a_file_is_one_line_of_text(self):
        self.write("a\n\x1b[2J.yaml", GOOD)
        result = self.run_good("scenario", "a\n\x1b[2J.yaml")
        self.assertEqual(result.stdout, "ok      a??[2J.yaml: 3 expectations\n1 scenario: 1 passed, 0 failed\n")

    def test_it_says_what_did_not_hold_and_what_was_seen(self):
        result = self.scenario(GOOD.replace("[510, 513]", "[500, 505]"))
        self.assertEqual(result.status, 1)
        self.assertEqual(result.stdout.splitlines(), [
            "FAILED  s.yaml: 1 of 3 expectations",
            "        line 5: STANDBY (no reason) is expected in 500..505 ms, seen: STANDBY (no reason) at 511 ms",
            "1 scenario: 0 passed, 1 failed"])

    def test_one_bad_file_and_nothing_runs_and_nothing_is_written(self):
        self.write("good.yaml", GOOD)
        self.write("bad.yaml", GOOD + "oops: 1\n")
        result = self.run_program("scenario", "good.yaml", "bad.yaml")
        self.assert_refused(result, "bad.yaml:7: unknown key 'oops'")
        self.assertEqual(result.stdout, "")
        self.assert_refused(self.run_program("scenario", "--events", "e.jsonl", "bad.yaml"), "unknown key")
        self.assertEqual(self.files(), ["bad.yaml", "good.yaml"])

    def test_an_older_junit_file_does_not_pass_for_the_result_of_what_could_not_be_run(self):
        self.write("good.yaml", GOOD)
        self.write("bad.yaml", GOOD + "oops: 1\n")
        self.run_good("scenario", "--junit", "j.xml", "good.yaml")
        for files, unusable in ((("good.yaml", "bad.yaml"), "bad.yaml"), (("nowhere.yaml",), "nowhere.yaml")):
            result = self.run_program("scenario", "--junit", "j.xml", *files)
            self.assert_refused(result, unusable)
            suite = xml.etree.ElementTree.parse(self.folder / "j.xml").getroot()
            self.assertEqual([suite.get(key) for key in ("tests", "failures", "errors")], ["1", "0", "1"])
            self.assertEqual([case.get("classname") for case in suite], [unusable])
            self.assertEqual(suite[0].find("error").get("message"), "could not be run; standard error says why")
        self.assertEqual(self.files(), ["bad.yaml", "good.yaml", "j.xml"])

    def test_events(self):
        result = self.scenario(GOOD, "--events", "e.jsonl")
        self.assertEqual(result.status, 0, result.stderr)
        events = result.events("e.jsonl")
        self.assertEqual(events[0], {"t_ms": 0, "event": "state", "from": None, "to": "INIT", "reason": None})
        self.assertEqual(events[-1]["event"], "summary")
        self.assertEqual(events[-1]["final_state"], "STANDBY")

    def test_no_output_is_put_in_place_unless_all_can_be(self):
        self.write("e.jsonl", "old")
        result = self.scenario(GOOD, "--events", "e.jsonl", "--junit", "/dev/full")
        self.assertEqual((result.status, result.stderr), (2, "host_sim: /dev/full: No space left on device\n"))
        self.assertEqual(self.read("e.jsonl"), "old")

    def test_standard_output_as_an_output_gets_nothing_else(self):
        result = self.scenario(GOOD, "--events", "-")
        events = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual(events[-1]["event"], "summary")
        self.assertEqual(result.stderr, "ok      s.yaml: 3 expectations\n1 scenario: 1 passed, 0 failed\n")
        suite = xml.etree.ElementTree.fromstring(self.scenario(GOOD, "--junit", "-").stdout)
        self.assertEqual(suite.get("tests"), "1")

    def test_a_signal_ends_it_and_leaves_what_was_there(self):
        self.write("s.yaml", GOOD.replace("duration_ms: 600", "duration_ms: 86400000"))
        for number in (signal.SIGINT, signal.SIGTERM):
            self.write("j.xml", "old")
            with subprocess.Popen([hostsim.PROGRAM, "scenario", "--junit", "j.xml", "s.yaml"], cwd=self.folder,
                                  stdout=subprocess.PIPE) as program:
                deadline = time.monotonic() + 30
                while len(self.files()) < 3 and time.monotonic() < deadline:
                    time.sleep(0.01)
                program.send_signal(number)
                self.assertEqual((program.wait(timeout=30), program.stdout.read()), (-number, b""))
            self.assertEqual(self.read("j.xml"), "old")
            self.assertEqual(self.files(), ["j.xml", "s.yaml"])

    def test_a_pipe_is_read_once(self):
        with subprocess.Popen(["cat"], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as cat:
            cat.stdin.write(GOOD.encode())
            cat.stdin.close()
            result = subprocess.run([hostsim.PROGRAM, "scenario", "/dev/stdin"], stdin=cat.stdout, capture_output=True,
                                    text=True, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_an_error_frame_is_delivered_and_not_sent(self):
        step = 'steps:\n  - {at_ms: 100, bus: send, id: 124h, bytes: "01", kind: error}\n'
        self.assert_refused(self.scenario(GOOD + step), "s.yaml:", "only for deliver")
        self.assertEqual(self.scenario(GOOD + step.replace("bus: send", "bus: deliver")).status, 0)

    def test_a_frame_in_fd_format_is_heard_by_supervisor_and_vehicle(self):
        """A sloppy VCU that stands without power to the wheels takes the gear of it; the supervisor counts it."""
        text = GOOD.replace("duration_ms: 600", "duration_ms: 3000") + """\
  counters_at_end: {rejected_fd: 1}
  vehicle: [{at_ms: 2900, gear: %s, mode: manual}]
steps:
  - {at_ms: 1000, vcu: %s}
  - {at_ms: 1000, operator: drive, gear: D, throttle_pct: 0}
  - {at_ms: 2000, bus: send, message: gear_command, bytes: "08", kind: fd}
"""
        for word, gear in (("be_sloppy", "P"), ("be_strict", "D")):
            result = self.scenario(text % (gear, word))
            self.assertEqual(result.status, 0, result.stdout + result.stderr)

    # Shows: TX_STALLED
    def test_swallowed_frames_never_leave(self):
        step = "steps:\n  - {at_ms: %d, supervisor: swallow_tx}\n  - {at_ms: 300, supervisor: pass_tx}\n"
        expected = "  frames: [{message: gear_command, at_ms: [10, 250], count: %s}]\n"
        for at_ms, count in ((0, "0"), (290, "[2, 8]")):
            result = self.scenario(GOOD + expected % count + step % at_ms)
            self.assertEqual(result.status, 0, result.stdout + result.stderr)

    def test_a_configuration_lies_under_that_of_the_file(self):
        self.write("c.yaml", "init_hold_ms: 400\n")
        self.assertEqual(self.scenario(GOOD.replace("[510, 513]", "[410, 413]"), "--config", "c.yaml").status, 0)
        over = GOOD + "config: {init_hold_ms: 500}\n"
        self.assertEqual(self.scenario(over, "--config", "c.yaml").status, 0)


def words_of(schema):
    """The keys and the words that a schema knows."""
    if isinstance(schema, list):
        return set().union(*map(words_of, schema)) if schema else set()
    if not isinstance(schema, dict):
        return set()
    words = set(schema.get("properties", {})) | {word for word in schema.get("enum", ()) if isinstance(word, str)}
    return words.union(*map(words_of, schema.values()))


class Manual(hostsim.Case):
    """docs/scenarios.md says what is so."""

    PAGE = (SCENARIOS.parents[1] / "docs" / "scenarios.md").read_text(encoding="utf-8")

    def test_every_word_of_the_format_stands_on_the_page(self):
        schema = json.loads(self.run_good("scenario", "--schema").stdout)
        schema["properties"]["config"] = schema["properties"]["shows"] = {}  # settings, requirements: their own pages
        words = {word for word in words_of(schema) if not re.fullmatch(r"[A-Z][A-Z_0-9]{7,}", word)}  # faults, too
        self.assertGreater(len(words), 150)
        self.assertEqual([word for word in sorted(words) if not re.search(rf"(?<!\w){re.escape(word)}(?!\w)", self.PAGE)], [])


class Demo(hostsim.Case):
    def test_it_shows_the_main_job(self):
        result = self.run_good("demo")
        for text in ("ai          stop", "=> TRIPPED: STEERING_COMMAND_TIMEOUT", "sends 168 [08 00 00 00 00 00 00 00]",
                     "reports manual", "reports gear P", "=> SAFE", "press button 1", "reset accepted",
                     "=> TRIPPED: EPS_OVER_CURRENT_SHUTDOWN", "first safe frame is out", "expectations passed"):
            self.assertIn(text, result.stdout)
        self.assertEqual([line for line in result.stdout.splitlines() if len(line) > 100], [])

    def test_a_scenario_by_name_and_by_path(self):
        self.assertIn("BUS_OFF", self.run_good("demo", "--scenario", "bus_off").stdout)
        self.write("s.yaml", GOOD)
        self.assertIn("=> STANDBY", self.run_good("demo", "--scenario", "./s.yaml").stdout)

    def test_what_is_not_seen_is_said(self):
        self.write("s.yaml", GOOD.replace("[510, 513]", "[500, 505]"))
        result = self.run_program("demo", "--scenario", "s.yaml")
        self.assertEqual(result.status, 1)
        self.assertIn("Expectations FAILED, s.yaml:\n  line 5: STANDBY", result.stdout)

    def test_events_are_those_of_the_scenario_command(self):
        self.run_good("scenario", "--events", "of_scenario.jsonl", SCENARIOS / "overview" / "demo.yaml")
        result = self.run_good("demo", "--events", "of_demo.jsonl")
        self.assertIn("expectations passed", result.stdout)
        events = self.read("of_demo.jsonl")
        self.assertEqual(events, self.read("of_scenario.jsonl"))
        result = self.run_good("demo", "--events", "-")
        self.assertEqual(result.stdout, events)
        self.assertEqual(result.stderr, "All 31 expectations passed.\n")

    def test_events_that_cannot_be_written(self):
        result = self.run_program("demo", "--events", "/dev/full")
        self.assertEqual((result.status, result.stderr), (2, "host_sim: /dev/full: No space left on device\n"))

    def test_a_program_without_its_folder_of_scenarios(self):
        (self.folder / "bin").mkdir()
        alone = self.folder / "bin" / "host_sim"
        shutil.copy(hostsim.PROGRAM, alone)
        self.assert_refused(self.run_program("demo", program=alone), "no folder ", "share/agv-supervisor/scenarios; keep the "
                            "program with its share folder, or give --scenario FILE")


if __name__ == "__main__":
    os.environ.setdefault("HOST_SIM", "build/host/bin/host_sim")
    unittest.main()
