"""host_sim run and scenario --bus on virtual interfaces: states, frames and their times, files, signals.

Bytes are written out from docs/protocol.md. Deadlines that are not tested have their greatest value.
"""
import json
import re
import signal
import subprocess
import time

import canbus
import clients

SLACK_S = 0.4  # how long this machine may have other things to do
PATIENT = {**clients.LONGEST_MS, "tx_stalled_ms": 500}
SETTINGS = "".join("%s: %d\n" % item for item in PATIENT.items())


def setUpModule():
    # Read from the disk what the program needs, which takes its time when it is the first one.
    for arguments in (["--for", "100"], ["--for", "100", "--events", "-"]):
        subprocess.run([canbus.PROGRAM, "run", "--can", "vcan0", *arguments], stdout=subprocess.DEVNULL, check=False)


class Case(canbus.Case):
    def setUp(self):
        super().setUp()
        self.config = self.folder / "patient.yaml"
        self.config.write_text(SETTINGS)

    def run_node(self, *arguments):
        return self.start("run", "--can", "vcan0", "--config", self.config, *arguments)

    def wait_state(self, process, state):
        return json.loads(process.wait_line('"to": "%s"' % state))


class Supervises(Case):
    def test_no_trip_is_no_failure(self):
        self.start("vehicle", "--can", "vcan0", "--manual")
        self.bus().wait_for(0x0A3)
        status, output, errors = self.run_to_end("run", "--can", "vcan0", "--config", self.config, "--fail-on-trip",
                                                 "--for", "1500")
        self.assertEqual((status, errors.count("\n")), (0, 1), errors)  # one note: what is not the default
        self.assertNotIn("NOT SUPERVISED", output)

    def test_a_bus_on_which_nothing_was_supervised_is_a_failure(self):
        for arguments, expected in (((), 0), (("--fail-on-trip",), 1)):
            status, output, _ = self.run_to_end("run", "--can", "vcan0", *arguments, "--for", "700")
            self.assertEqual(status, expected)
            self.assertRegex(output, r"\Avcan0: .* s\nNOT SUPERVISED: never left INIT; .* before startup_timeout_ms: --why ")

    def test_only_identifiers_of_the_protocol_are_received(self):
        bus = self.bus()
        process = self.run_node("--events", "-")
        self.wait_state(process, "INIT")
        for can_id in (0x123, 0x7FF, 0x363, 0x203):  # the latter belongs to the other ID set
            bus.send(can_id, bytes(8))
        time.sleep(0.3)
        self.assertEqual(process.end(), 0)
        events = [json.loads(line) for line in process.text().splitlines()]
        self.assertEqual((events[-1]["event"], events[-1]["received"], events[-1]["final_state"]), ("summary", 2, "INIT"))
        times = [event["t_ms"] for event in events]
        self.assertEqual(times, sorted(times))


class Ends(Case):
    def test_a_signal_ends_it_at_once_and_nothing_more_is_sent(self):
        bus = self.bus()
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            with self.subTest(number):
                process = self.run_node()
                bus.wait_for(0x168)
                self.assertEqual(process.end(number), 0)
                bus.forget()
                self.assertEqual(bus.listen(0.3), [])
                self.assertRegex(process.text(), r"\Avcan0: \d+\.\d{3} s\nNOT SUPERVISED: never left INIT; (.*\n)+"
                                                 r"frames: 0 received, 0 of them rejected, 0 dropped; \d+ sent\nwarnings: \d+\nfinal state: INIT, first reason: "
                                                 r"none\n\Z")

    def test_after_a_time(self):
        begin = time.monotonic()
        status, output, _ = self.run_to_end("run", "--can", "vcan0", "--shadow", "--for", "1000")
        self.assertEqual(status, 0)
        self.assertRegex(output, r"; 0 sent, [1-9]\d* held back in shadow mode\n")
        self.assertGreater(time.monotonic() - begin, 1)
        self.assertGreaterEqual(float(re.match(r"vcan0: ([\d.]+) s\n", output)[1]), 1)

    def test_interfaces_that_are_none(self):
        for name, why in (("vcan9", "no such interface"), ("lo", "lo")):
            status, output, errors = self.run_to_end("run", "--can", name)
            self.assertEqual((status, output, errors.count("\n")), (2, "", 1))
            self.assertIn(name + ": ", errors)
            self.assertIn(why, errors)


class Writes(Case):
    def test_files_grow_line_by_line_and_survive_a_kill(self):
        events, out = self.folder / "events.jsonl", self.folder / "out.log"
        events.write_text("of an earlier run\n" * 1000)
        bus = self.bus()
        process = self.run_node("--events", events, "--out", out)
        bus.wait_for(0x168)
        frames = bus.listen(0.7)
        self.assertEqual(process.end(signal.SIGKILL), -signal.SIGKILL)
        kinds = [json.loads(line)["event"] for line in events.read_text().splitlines()]
        self.assertEqual(kinds[:3], ["state", "safety_output", "led"])
        sent = re.findall(r"^\((\d+\.\d{6})\) vcan0 ([0-9A-F]{3})#([0-9A-F]{16})$", out.read_text(), re.MULTILINE)
        self.assertEqual(len(sent), len(out.read_text().splitlines()))
        logged = {(int(can_id, 16), bytes.fromhex(data)): float(at) for at, can_id, data in sent if can_id == "43F"}
        seen = canbus.of(frames, 0x43F)[:-1]
        self.assertGreater(len(seen), 3)
        for frame in seen:  # each 43Fh has a counter of its own; the stamps are the kernel's
            self.assertAlmostEqual(logged[(frame.id, frame.data)], frame.at, delta=0.01)

    def test_a_terminal_shows_one_line_that_is_rewritten(self):
        terminal = self.terminal("run", "--can", "vcan0", "--for", "1200", width=60)
        self.assertEqual(terminal.end(), (0, ""))
        line, rest = terminal.seen.split(b"\r\n", 1)
        shown = line.split(b"\r")[1:]
        self.assertGreaterEqual(len(shown), 3)
        self.assertRegex(shown[-1], rb"^\d+\.\d s  INIT: [A-Z_]+  output open")
        self.assertLessEqual(max(map(len, shown)), 59)
        self.assertIn(b"final state: INIT", rest)


SCENARIO = """
name: On a bus
shows: [SUP-3]
duration_ms: 4000
vehicle: {eps_lost_ms: 5000}
config:
%ssteps:
  - {at_ms: 1000, ai: drive, gear: D, throttle_pct: 20, steer_deg: 10}
  - {at_ms: 1500, operator: engage}
  - {at_ms: 2500, ai: stop}
expect:
  states:
    - {to: INIT, at_ms: 0}
    - {to: STANDBY, at_ms: [500, 530]}
    - {to: ACTIVE, at_ms: [1500, 1511]}
    - {to: TRIPPED, reason: %s, at_ms: [2975, 3010]}
    - {to: SAFE, at_ms: [3095, 3400]}
  frames:
    - {message: gear_command, bytes: "08 00 00 00 00 00 00 00", at_ms: [2975, 3012], side: vehicle}
    - {from: vcu, message: gear_status, bytes: "01 00 00 00 00 00 00 00", at_ms: [2000, 2900], side: vehicle}
  never:
    - {message: gear_command, bytes: "08 00 00 00 00 00 00 00", at_ms: [600, 2974]}
  safety_output:
    - {closed: true, at_ms: [500, 530]}
"""


class SaysWhy(Case):
    # Shows: SUP-2, EPS_HEARTBEAT_LOST
    def test_a_steering_that_falls_silent_is_the_reason_of_the_trip(self):
        why, report = self.folder / "why.json", self.folder / "why.html"
        vehicle = self.start("vehicle", "--can", "vcan0")
        process = self.start("run", "--can", "vcan0", "--events", "-", "--why", why, "--report", report, "--fail-on-trip")
        self.assertEqual(self.wait_state(process, "INIT")["from"], None)
        self.wait_state(process, "ACTIVE")
        vehicle.say("eps stop")
        tripped = self.wait_state(process, "TRIPPED")
        self.wait_state(process, "SAFE")
        self.assertEqual((process.end(), vehicle.end()), (1, 0))
        told = json.loads(why.read_text())
        self.assertEqual((told["log"], told["not_supervised"]), ("vcan0", []))
        trip = told["trips"][0]
        self.assertEqual((trip["reason"], trip["t_ms"]), (tripped["reason"], tripped["t_ms"]))
        self.assertEqual([trip[key] for key in ("reason", "kind", "message", "id", "limit", "unit")],
                         ["EPS_HEARTBEAT_LOST", "silence", "steering_status", "067", 50, "ms"])
        self.assertGreater(trip["t_ms"] - trip["last_good_ms"], 50)
        self.assertLess(trip["t_ms"] - trip["last_good_ms"], 50 + 1000 * SLACK_S)
        self.assertLess(trip["first_safe_ms"] - trip["t_ms"], 1000 * SLACK_S)
        self.assertGreater(trip["confirmed_ms"], trip["t_ms"])
        self.assertIs(trip["from_recording"], False)
        self.assertIn("EPS_HEARTBEAT_LOST", report.read_text())


class Scenarios(Case):
    def scenario(self, name, reason):
        path = self.folder / name
        settings = "".join("  %s: %d\n" % item for item in PATIENT.items())
        path.write_text(SCENARIO % (settings, reason))
        return path

    def test_passed_failed_and_left_out(self):
        good, bad = self.scenario("good.yaml", "STEERING_COMMAND_TIMEOUT"), self.scenario("bad.yaml", "AI_HEARTBEAT_LOST")
        left_out = self.folder / "left_out.yaml"
        left_out.write_text(good.read_text().replace("duration_ms", "bitrate: 125000\nduration_ms", 1))
        status, output, errors = self.run_to_end("scenario", "--bus", "vcan0", "--tolerance", "300", "--junit",
                                                 self.folder / "junit.xml", good, bad, left_out)
        self.assertEqual((status, errors), (1, ""), output)
        lines = output.splitlines()
        self.assertEqual(lines[0], "ok      %s: 9 expectations" % good, output)
        self.assertEqual(lines[1], "FAILED  %s: 1 of 9 expectations" % bad, output)
        self.assertEqual(lines[-2], "left out %s: bitrate: a real interface has its own" % left_out)
        self.assertEqual(lines[-1], "3 scenarios: 1 passed, 1 failed, 1 left out")
        self.assertIn('tests="2" failures="1"', (self.folder / "junit.xml").read_text())

    def test_a_signal_ends_it(self):
        process = self.start("scenario", "--bus", "vcan0", self.scenario("s.yaml", "STEERING_COMMAND_TIMEOUT"))
        self.bus().wait_for(0x363)
        self.assertEqual((process.end(signal.SIGINT), process.text("stderr")), (2, "host_sim: interrupted\n"))

    def test_a_signal_ends_the_wait_for_another_supervisor(self):
        for command in ("sleep 1000", "yes"):
            process = self.start("scenario", "--bus", "vcan0", "--supervisor", command,
                                 self.scenario("s.yaml", "STEERING_COMMAND_TIMEOUT"))
            time.sleep(0.5)
            self.assertTrue(process.is_running())
            self.assertEqual((process.end(signal.SIGTERM), process.text("stderr")), (2, "host_sim: interrupted\n"))

    def test_signals_that_the_program_ignores_act_in_another_supervisor(self):
        path = self.scenario("s.yaml", "STEERING_COMMAND_TIMEOUT")
        for name in ("PIPE", "XFSZ"):
            command = "kill -%s $$; echo it goes on >&2" % name
            status, _, errors = self.run_to_end("scenario", "--bus", "vcan0", "--supervisor", command, path)
            self.assertEqual((status, errors), (2, "host_sim: '%s' has ended\n" % command))
