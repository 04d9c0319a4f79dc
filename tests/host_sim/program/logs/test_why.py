"""What `replay` says to people, and `--why`, `--trace`: as they would be read. Times and words are written by hand."""
import json
import os
import pathlib
import unittest

import hostsim
import traffic
from traffic import EPS, byte, edit_payload, raise_remote_signal_lost, stop

S = 1000000
COLUMNS = 100
SCENARIOS = pathlib.Path(__file__).resolve().parents[4] / "host_sim" / "scenarios"
TRIP_KEYS = {"t_ms", "reason", "kind", "message", "id", "cause_ms", "last_good_ms", "limit", "unit", "evidence",
             "first_safe_ms", "confirmed_ms", "stopped_ms", "from_recording"}


class Case(hostsim.Case):
    def text(self, log, *arguments, status=0):
        """What replay prints: a list of lines, none longer than 100 columns."""
        self.write("my.log", log)
        result = self.run_program("replay", *arguments, "my.log", env=dict(os.environ, TZ="UTC"))
        self.assertEqual(result.status, status, result.stderr)
        lines = result.stdout.splitlines()
        self.assertLessEqual(max(map(len, lines)), COLUMNS, result.stdout)
        return lines

    def why(self, log, *arguments):
        self.write("my.log", log)
        self.run_good("replay", "--why", "why.json", *arguments, "my.log")
        return json.loads(self.read("why.json"))


class ASupervisorWasActive(Case):
    """Its commands are in the log: they hide that those of the AI computer stayed away."""

    def recorded(self, edit):
        """A log, and the same with what a supervisor sent."""
        log = traffic.log(traffic.frames(3000, engage_ms=1000, edit=edit))
        self.write("plain.log", log)
        self.run_good("replay", "--out", "out.log", "plain.log")
        lines = log.splitlines(keepends=True) + self.read("out.log").splitlines(keepends=True)
        return log, "".join(sorted(lines, key=lambda line: line.split()[0]))

    def trip(self, lines):
        return next(line for line in lines if line.startswith("tripped"))

    def test_a_command_stayed_away(self):
        plain, log = self.recorded(stop(("steering_command",), 2000))
        self.assertEqual(self.trip(self.text(plain)), "tripped     at 2.107 s (22:13:22.107): STEERING_COMMAND_TIMEOUT")
        lines = self.text(log)
        self.assertTrue(self.trip(lines).startswith("tripped     never"))
        self.assertEqual(lines[:3], [
            "hint        7F0h received: a supervisor was active, and its commands are in this log. It tripped by",
            "            STEERING_COMMAND_TIMEOUT, reported at 2.200 s. To see the cause: --until 2102ms --tail",
            "            200ms"])
        self.assertEqual(self.trip(self.text(log, "--until", "2102ms", "--tail", "200ms")), self.trip(self.text(plain)))

    def test_the_vehicle_reported_a_fault(self):
        _, log = self.recorded(edit_payload("vehicle_status", 2030, raise_remote_signal_lost, 2060))
        lines = self.text(log)
        self.assertEqual(lines[:2], [
            "hint        7F0h received: a supervisor was active, and its commands are in this log. It tripped by",
            "            REMOTE_SIGNAL_LOST, reported at 2.100 s. To see the cause: --until 2101ms"])
        lines = self.text(log, "--until", "2101ms")
        self.assertEqual(self.trip(lines), "tripped     at 2.030 s (22:13:22.030): REMOTE_SIGNAL_LOST")
        self.assertIn("my.log: 2.100 s on can0, 2023-11-14 22:13:20.000 to 22:13:22.100", lines)

    def test_it_had_tripped_before(self):
        _, log = self.recorded(stop(("steering_command",), 2000))
        late = "".join(line for line in log.splitlines(keepends=True) if line >= "(1700000002.250000)")
        self.assertIn("            by STEERING_COMMAND_TIMEOUT before the log began", self.text(late))

    def test_a_status_frame_of_somebody_else(self):
        log = traffic.log(traffic.frames(1000))
        for data in ("0000000000000000", "55C8000000000000", "55FF000000000000", "552A"):
            lines = self.text(log + "(1700000001.000000) can0 7F0#%s\n" % data)
            self.assertNotIn("tripped by", " ".join(lines))

    def test_it_did_not_trip(self):
        _, log = self.recorded(None)
        self.assertEqual(self.text(log)[0], "hint        7F0h received: a supervisor was active, and its commands are in this log")
        self.assertNotIn("hint", " ".join(self.text(log, "--config", self.write("off.yaml", "status_frame_id: 0\n"))))


class FiveLogs(Case):
    """Logs of which nothing, or not all, was supervised: they must not look like a pass."""

    def test_a_log_that_begins_in_autopilot(self):
        log = traffic.log(traffic.frames(20000, engage_ms=0, edit=stop(("steering_command",), 10000, 11000)))
        lines = self.text(log)
        self.assertEqual(lines[:6], [
            "NOT SUPERVISED: never left INIT, missing: manual (363h reports autopilot from its first frame),",
            "                standstill (101h reports left 400 mm/s, right 400 mm/s)",
            "  hint      supervision begins in manual, at standstill: start the recording before the autopilot is",
            "            engaged",
            "my.log: 19.994 s on can0, 2023-11-14 22:13:20.000 to 22:13:39.994",
            "supervised  0.00 s   INIT 19.99  STANDBY 0.00  ACTIVE 0.00  TRIPPED 0.00  SAFE 0.00"])
        self.assertIn("            STEERING_COMMAND_TIMEOUT  trip  10.107 s   1 time   0.900 s  in INIT: no trip", lines)
        self.assertEqual(self.text(log, "--fail-on-trip", status=1), lines)
        self.assertEqual(self.why(log)["not_supervised"], ["standstill", "manual"])
        self.assertEqual(self.why(log)["supervised_ms"], 0)

    def test_a_throttle_that_hangs_at_standstill(self):
        def hangs(frame):
            if frame.name == "throttle_status":
                frame.data = bytes([0x0A]) + frame.data[1:]
            return frame
        log = traffic.log(traffic.frames(3000, edit=hangs))
        self.assertEqual(self.text(log)[0], "NOT SUPERVISED: never left INIT, missing: throttle (050h last reported 10 counts)")
        self.assertEqual(self.why(log)["not_supervised"], ["throttle"])

    def test_what_flickers_at_the_end_is_missing_too(self):
        def every_70_ms(frame):
            return frame if frame.name != "vehicle_status" or frame.t_ms % 70 < 10 else None
        log = traffic.log(traffic.frames(8000, edit=every_70_ms))
        self.assertEqual(self.text(log)[:2], [
            "NOT SUPERVISED: never left INIT, missing: vcu_heartbeat (not all the time), trip_cause (not all the",
            "                time), standstill (not all the time)"])
        self.assertEqual(set(self.why(log)["not_supervised"]), {"vcu_heartbeat", "trip_cause", "standstill"})

    def test_the_other_id_set(self):
        log = traffic.log(traffic.frames(5000, ids=traffic.TABLE_IDS))
        lines = self.text(log, "--fail-on-trip", status=1)
        self.assertTrue(lines[0].startswith("NOT SUPERVISED: never left INIT, missing: manual (363h never received)"))
        self.assertIn("  hint      201h and 203h heard, 43Fh and 363h not: --id-set table", lines)
        fits = self.text(log, "--id-set", "table", "--fail-on-trip")
        self.assertTrue(fits[0].startswith("my.log: "), fits[0])

    def test_the_other_way_round(self):
        lines = self.text(traffic.log(traffic.frames(3000)), "--id-set", "table")
        self.assertIn("  hint      43Fh and 363h heard, 201h and 203h not: --id-set heading", lines)

    def test_a_log_without_the_eps(self):
        log = traffic.log(traffic.frames(3000, senders=("vcu", "ai")))
        lines = self.text(log, "--fail-on-trip", status=1)
        self.assertIn("NOT SUPERVISED: never left INIT, missing: eps_heartbeat (067h never received)", lines[0])
        self.assertIn("  hint      067h, 167h and 267h never received: is the EPS on this bus?", lines)
        self.assertIn("messages (167h, 267h never received)", " ".join(line.strip() for line in lines[:4]))
        self.assertEqual(set(self.why(log)["not_supervised"]), {"eps_heartbeat", "trip_cause", "messages"})

    def test_a_log_of_another_vehicle(self):
        frames = traffic.frames(2000)
        for frame in frames:
            frame.can_id = (frame.can_id + 0x111) & 0x7FF
        lines = self.text(traffic.log(frames), "--fail-on-trip", status=1)
        self.assertTrue(lines[0].startswith("NOT SUPERVISED: "), lines[0])
        hint = next(i for i, line in enumerate(lines) if line.startswith("  hint"))
        self.assertEqual(lines[hint:hint + 2], [
            "  hint      161h, 176h, 178h, 186h, 1B4h, 212h, and others received, 0 of the 11 messages of the",
            "            protocol: another vehicle? Each identifier is a setting (id_...); host_sim survey"])

    def test_a_log_with_some_other_identifiers(self):
        ids = dict(traffic.IDS, vehicle_status=0x303, steering_command=0x165)
        lines = self.text(traffic.log(traffic.frames(2000, ids=ids)))
        hint = next(i for i, line in enumerate(lines) if line.startswith("  hint"))
        self.assertEqual(lines[hint:hint + 2], [
            "  hint      065h and 363h never received, but 165h and 303h, which the protocol does not know: other",
            "            identifiers? host_sim survey proposes them"])

    def test_frames_of_another_kind(self):
        log = traffic.log(traffic.frames(2000))
        lines = self.text(log.replace("#", "##0"))
        self.assertIn("  hint      only CAN FD frames received: the protocol has classic CAN frames", lines)
        self.assertEqual(lines[-1], "log         CAN FD frames: 1420")
        lines = self.text(log.replace(" can0 ", " can0 00000"))
        self.assertIn("  hint      only 29-bit identifiers received: the protocol has 11-bit ones", lines)
        self.assertEqual(lines[-1], "log         frames with 29-bit identifiers: 1420")

    def test_a_clock_that_is_set_back(self):
        log = traffic.log(traffic.frames(2000)) + traffic.log(traffic.frames(2000), base_us=traffic.BASE_US - 60 * S)
        lines = self.text(log, "--fail-on-trip", status=1)
        self.assertEqual(lines[0], "NOT SUPERVISED: the time stamps go back by 61.994 s at line 1421: from there on, "
                                   "lines with an")
        self.assertEqual(lines[1], "                earlier time stamp get the time 1.994 s; cut the log there, or sort it")
        self.assertEqual(lines[-1], "log         time stamps that went backwards: 1420")
        self.assertEqual(self.why(log)["not_supervised"], ["time_stamps"])

    def set_back(self, back_us):
        """A healthy log; after 2 s its clock is set back."""
        frames = traffic.frames(3000)
        at = next(i for i, frame in enumerate(frames) if frame.t_us >= 2 * S)
        step = back_us + frames[at].t_us - frames[at - 1].t_us
        for frame in frames[at:]:
            frame.t_us -= step
        return traffic.log(frames)

    def test_how_far_a_clock_may_be_set_back(self):
        lines = self.text(self.set_back(10000), "--fail-on-trip", status=1)
        self.assertTrue(lines[0].startswith("NOT SUPERVISED: the time stamps go back by 0.010 s at line "), lines[0])
        self.assertNotIn("NOT SUPERVISED", "".join(self.text(self.set_back(9999), "--fail-on-trip")))

    def test_two_interfaces_that_were_logged_out_of_order(self):
        frames = traffic.frames(3000, engage_ms=1000, ai_interface="can1")
        frames.sort(key=lambda frame: frame.t_us + (5000 if frame.interface == "can0" else 0))
        lines = self.text(traffic.log(frames), "--ai-if", "can1", "--fail-on-trip")
        self.assertNotIn("NOT SUPERVISED", "".join(lines))
        self.assertTrue(lines[-1].startswith("log         time stamps that went backwards: "), lines[-1])

    def test_a_clock_that_is_set_forward(self):
        log = traffic.log(traffic.frames(2000)) + traffic.log(traffic.frames(2000), base_us=traffic.BASE_US + 60 * S)
        self.assertEqual(self.text(log)[:2], [
            "hint        no frame at all from 1.994 s to 60.000 s: was the recording interrupted, or its clock",
            "            set?"])

    def test_two_vehicles_in_one_log(self):
        frames = traffic.frames(2000) + traffic.frames(2000, interface="can1")
        lines = self.text(traffic.log(sorted(frames, key=lambda frame: frame.t_us)))
        self.assertEqual(lines[:2], [
            "hint        the messages come on can0 and can1: a gateway (--ai-if names its AI side), or two",
            "            vehicles in one log?"])

    def test_a_gateway_recorded_on_both_of_its_sides(self):
        def forward(frame):
            other = "can0" if frame.interface == "can1" else "can1"
            return [frame, traffic.Frame(frame.t_us + 200, frame.name, frame.can_id, frame.data, other)]
        frames = traffic.frames(3000, engage_ms=1000, ai_interface="can1", edit=forward)
        lines = self.text(traffic.log(frames), "--ai-if", "can1", "--fail-on-trip", status=1)
        self.assertEqual([line for line in lines if line.startswith("  hint")],
                         ["  hint      commands come on the vehicle side (can0): recorded on the vehicle side of a gateway?"])
        self.assertEqual(lines[3], "            Remove the frames that the gateway sent")

    def test_the_sides_of_a_gateway_are_swapped(self):
        log = traffic.log(traffic.frames(3000, engage_ms=1000, ai_interface="can1"))
        lines = self.text(log, "--ai-if", "can0")
        self.assertEqual([line for line in lines if line.startswith("  hint")],
                         ["  hint      the sides are swapped (status messages come on can0): --ai-if can1"])
        self.assertFalse(self.text(log, "--ai-if", "can1")[0].startswith("NOT SUPERVISED"))

    def test_a_shared_bus_is_named_as_the_ai_side(self):
        lines = self.text(traffic.log(traffic.frames(3000)), "--ai-if", "can0")
        self.assertIn("  hint      status messages come on can0, which is the AI side: for the log of a shared bus leave", lines)

    def test_a_log_that_ends_in_the_middle_of_a_fault(self):
        frames = traffic.frames(3000, engage_ms=1000, edit=stop(("steering_command",), 2910))
        lines = self.text(traffic.log(frames))
        self.assertIn("tripped     never; see the line 'at the end'", lines)
        self.assertEqual(lines[-1], "at the end  065h steering_command was silent for 88 ms, deadline 125 ms: "
                                    "the log ended too early")
        tripped = self.text(traffic.log(frames), "--tail", "40")
        self.assertIn("tripped     at 3.032 s (22:13:23.032): STEERING_COMMAND_TIMEOUT", tripped)

    def test_a_log_that_ends_before_its_bad_frames_are_enough(self):
        edit = edit_payload("eps_status", 2980, byte(7, 0x01))
        lines = self.text(traffic.log(traffic.frames(3000, edit=edit)))
        self.assertEqual(lines[-1], "at the end  EPS_UNDER_VOLTAGE had begun at 2.983 s: the log ended too early")


class Text(Case):
    def test_a_healthy_log(self):
        lines = self.text(traffic.log(traffic.frames(3000, engage_ms=1000)), "--fail-on-trip")
        self.assertEqual(lines, [
            "my.log: 2.994 s on can0, 2023-11-14 22:13:20.000 to 22:13:22.994",
            "supervised  2.48 s   INIT 0.51  STANDBY 0.49  ACTIVE 1.99  TRIPPED 0.00  SAFE 0.00",
            "tripped     never",
            "faults      none"])

    def test_a_trip_with_what_a_recording_cannot_obey(self):
        log = traffic.log(traffic.frames(12000, engage_ms=1000, edit=stop(("steering_command",), 3000, 4000)))
        lines = self.text(log)
        self.assertEqual(lines, [
            "my.log: 11.994 s on can0, 2023-11-14 22:13:20.000 to 22:13:31.994",
            "supervised  11.48 s   INIT 0.51  STANDBY 0.49  ACTIVE 2.11  TRIPPED 8.89  SAFE 0.00",
            "tripped     at 3.107 s (22:13:23.107): STEERING_COMMAND_TIMEOUT",
            "  why       065h steering_command was silent: last at 2.981 s, deadline 125 ms, next at 4.006 s",
            "  then      first safe frame 3.107 s; P and autopilot off not confirmed; wheels never at standstill",
            "            (a recording cannot obey)",
            "faults      STEERING_COMMAND_TIMEOUT  trip  3.107 s   1 time   0.900 s",
            "            SAFE_STATE_UNCONFIRMED    trip  3.607 s   1 time   8.387 s  (a recording cannot obey)",
            "            VEHICLE_NOT_STOPPING      trip  8.107 s   1 time   3.887 s  (a recording cannot obey)"])
        self.assertEqual(self.text(log, "--fail-on-trip", status=1), lines)

    def test_what_of_the_confirmation_did_not_come(self):
        def then(name, change):
            emergency, other = edit_payload("eps_status", 2000, byte(7, 0x08)), edit_payload(name, 2100, change)
            stands = edit_payload("wheel_speed", 2500, lambda data: data.__setitem__(slice(0, 8), bytes(8)))
            log = traffic.log(traffic.frames(3000, engage_ms=1000, edit=lambda frame: stands(other(emergency(frame)))))
            return next(line for line in self.text(log) if line.startswith("  then"))
        self.assertEqual(then("gear_status", byte(0, 8)), "  then      first safe frame 2.003 s; autopilot off not confirmed "
                         "(a recording cannot obey); stands")
        self.assertEqual(then("vehicle_status", byte(6, 0x40)), "  then      first safe frame 2.003 s; P not confirmed "
                         "(a recording cannot obey); stands 2.501 s")

    def test_a_trip_that_an_earlier_run_latched(self):
        log = traffic.log(traffic.frames(4000, engage_ms=1000, edit=stop(("steering_command",), 3000)))
        self.text(log, "--store", "store")
        lines = self.text(log, "--store", "store", "--reset-cause", "watchdog", "--why", "why.json")
        self.assertEqual(lines[2:4], ["tripped     at 0.000 s (22:13:20.000): STEERING_COMMAND_TIMEOUT", "  why       latched "
                                      "in an earlier run"])
        trip = json.loads(self.read("why.json"))["trips"][0]
        self.assertEqual([trip[key] for key in ("kind", "message", "cause_ms", "last_good_ms", "limit", "unit", "evidence")],
                         ["silence", "steering_command", None, None, None, None, []])

    def test_a_warning_that_an_engagement_makes_a_trip(self):
        log = traffic.log(traffic.frames(4000, engage_ms=3000, edit=stop(("turn_signal_command",), 1500)))
        self.assertIn("faults      AI_HEARTBEAT_LOST       trip  1.758 s   1 time   2.236 s  a warning until 3.000 s",
                      self.text(log))

    def test_a_log_without_an_engagement(self):
        lines = self.text(traffic.log(traffic.frames(2000)), "--fail-on-trip")
        self.assertEqual(lines[2:], ["not judged  the commands of the AI computer: the autopilot was never engaged",
                                     "tripped     never", "faults      none"])

    def test_a_log_that_is_supervised_late(self):
        lines = self.text(traffic.log(traffic.frames(8000, edit=stop(EPS, 0, 3000))))
        self.assertEqual(lines[0], "NOT SUPERVISED: 3.513 s in INIT, until then missing: eps_heartbeat, trip_cause, "
                                   "messages")
        self.assertEqual(self.why(traffic.log(traffic.frames(8000, edit=stop(EPS, 0, 3000))))["not_supervised"],
                         ["eps_heartbeat", "trip_cause", "messages"])

    def test_a_log_that_is_too_short(self):
        lines = self.text(traffic.log(traffic.frames(300)))
        self.assertEqual(lines[0], "NOT SUPERVISED: never left INIT: the log is too short, a start takes more than 500 ms")
        self.assertEqual(self.why(traffic.log(traffic.frames(300)))["not_supervised"], ["init"])

    def test_stamps_that_are_no_time_of_day(self):
        log = traffic.log(traffic.frames(2000, edit=edit_payload("vehicle_status", 1500, raise_remote_signal_lost)),
                          base_us=5 * S)
        lines = self.text(log)
        self.assertEqual(lines[0], "my.log: 1.994 s on can0")
        self.assertIn("tripped     at 1.500 s: REMOTE_SIGNAL_LOST", lines)

    def test_a_night_has_two_dates_and_a_log_two_interfaces(self):
        frames = traffic.frames(2000, ai_interface="can1")
        lines = self.text(traffic.log(frames, base_us=1700006399 * S))
        self.assertEqual(lines[0], "hint        commands come on can1, status messages on can0: a gateway? --ai-if can1")
        self.assertEqual(lines[1], "my.log: 1.994 s on can0, can1, 2023-11-14 23:59:59.000 to "
                                   "2023-11-15 00:00:00.994")

    def test_a_name_of_more_than_a_line(self):
        self.write("n" * 180, traffic.log(traffic.frames(2000)))
        result = self.run_good("replay", "n" * 180, env=dict(os.environ, TZ="UTC"))
        self.assertEqual(result.stdout.splitlines()[:3], ["n" * 100, "n" * 80 + ":", "            1.994 s on can0, "
                                                          "2023-11-14 22:13:20.000 to 22:13:21.994"])

    def test_what_was_odd_about_the_log(self):
        log = "oops\n" + traffic.log(traffic.frames(2000)) + "(1700000001.000000) can0 0A3#08\n"
        lines = self.text(log, "--skip-bad-lines")
        self.assertEqual(lines[-1], "log         lines skipped: 1, time stamps that went backwards: 1, messages of a wrong "
                                    "length: 1")

    def test_error_frames(self):
        frames = traffic.log(traffic.frames(2000)).splitlines(True)
        frames.insert(700, frames[700].split(" ")[0] + " can0 20000088#0000000000000000\n")
        self.assertEqual(self.text("".join(frames))[-1], "log         error frames: 1")

    def test_many_trips(self):
        def edit(frame):
            if frame.name == "vehicle_status":
                data = bytearray(frame.data)
                at = frame.t_ms % 4000
                data[4] = 0x01 if 1000 <= at < 1100 else 0
                data[6] |= traffic.BUTTON_1 if 2000 <= at < 3500 else 0
                frame.data = bytes(data)
            return frame
        lines = self.text(traffic.log(traffic.frames(40000, edit=edit)))
        self.assertEqual(len([line for line in lines if line.endswith(": REMOTE_SIGNAL_LOST")]), 8)
        self.assertIn("            and 2 times more: --why FILE has them all", lines)
        self.assertEqual(len(self.why(traffic.log(traffic.frames(40000, edit=edit)))["trips"]), 10)

    def test_a_long_path_has_a_line_of_its_own(self):
        rest = "2.994 s on can0, 2023-11-14 22:13:20.000 to 22:13:22.994"
        for length, expected in ((42, "%s: " + rest), (43, "%s:\n            " + rest)):
            name = "x" * length
            self.write(name, traffic.log(traffic.frames(3000)))
            result = self.run_program("replay", name, env=dict(os.environ, TZ="UTC"))
            self.assertTrue(result.stdout.startswith(expected % name + "\n"), result.stdout)

    def test_the_name_of_a_log_is_one_line_of_text(self):
        name = os.fsdecode(b"a\n\x1b[31m\xef\xc3\xbc.log")
        (self.folder / name).write_text(traffic.log(traffic.frames(1000)), encoding="ascii")
        for command in ("replay", "survey"):
            self.assertTrue(self.run_good(command, name).stdout.startswith("a??[31m?\u00fc.log: 0.994 s on can0, "), command)

    def test_a_trip_after_midnight_has_its_date(self):
        midnight_us = 1700006400 * S
        frames = traffic.frames(4000, engage_ms=1000, edit=stop(("steering_command",), 2000))
        self.assertIn("tripped     at 2.107 s (2023-11-15 00:00:00.107): STEERING_COMMAND_TIMEOUT",
                      self.text(traffic.log(frames, midnight_us - 2 * S)))
        self.assertIn("tripped     at 2.107 s (00:00:02.107): STEERING_COMMAND_TIMEOUT", self.text(traffic.log(frames, midnight_us)))

    def test_the_timeline(self):
        log = traffic.log(traffic.frames(4000, engage_ms=1000, edit=stop(("steering_command",), 2000)))
        lines = self.text(log, "--timeline")
        shown = [line[:90].rstrip() for line in lines]
        for expected in ("    1.000 s  vcu         reports autopilot",
                         "    1.005 s  vcu         reports gear D",
                         "    2.107 s  supervisor  sends 168 [08 00 00 00 00 00 00 00] gear_command: gear P",
                         "    2.107 s  supervisor  => TRIPPED: STEERING_COMMAND_TIMEOUT"):
            self.assertTrue(any(line.startswith(expected) for line in shown), expected)
        self.assertIn("tripped     at 2.107 s (22:13:22.107): STEERING_COMMAND_TIMEOUT", lines)
        self.assert_refused(self.run_program("replay", "--timeline", "--why", "-", "my.log"), "--timeline")

    def test_the_timeline_of_any_speed_fits(self):
        for mm_s, shown in ((999999, "999.99"), (1000000, ">999"), (-99999, "-99.99"), (-100000, "<-99"), (-2**31, "<-99")):
            def change(data, left=mm_s.to_bytes(4, "little", signed=True)):
                data[0:4] = left
            wheels, ended = edit_payload("wheel_speed", 1100, change), stop(("steering_command",), 1500)
            log = traffic.log(traffic.frames(2000, engage_ms=1000, edit=lambda frame: ended(wheels(frame))))
            lines = self.text(log, "--timeline")
            self.assertTrue(any(line.endswith(f"  D autopilot {shown} m/s") for line in lines), lines)

    def test_below_the_speed_of_standstill_and_0_are_told_apart(self):
        example = pathlib.Path(__file__).parents[4] / "host_sim/examples/ai-stops.log"
        text = self.run_good("replay", "--timeline", example).stdout
        self.assertIn("    1.301 s  vcu         reports 0.00 m/s ", text)
        self.assertIn("; stands 1.281 s\n", text)
        self.assertNotIn("stands still", text)


class Why(Case):
    def test_the_keys_and_values(self):
        why = self.why(traffic.log(traffic.frames(12000, engage_ms=1000, edit=stop(("steering_command",), 3000, 4000))))
        self.assertEqual(set(why), {"log", "supervised_ms", "not_supervised", "trips", "messages"})
        self.assertEqual((why["log"], why["supervised_ms"], why["not_supervised"]), ("my.log", 11482, []))
        first = why["trips"][0]
        self.assertEqual(set(first), TRIP_KEYS)
        evidence = first.pop("evidence")
        self.assertEqual(first, {
            "t_ms": 3107, "reason": "STEERING_COMMAND_TIMEOUT", "kind": "silence", "message": "steering_command",
            "id": "065", "cause_ms": 3006, "last_good_ms": 2981, "limit": 125, "unit": "ms", "first_safe_ms": 3107,
            "confirmed_ms": None, "stopped_ms": None, "from_recording": False})
        self.assertEqual(evidence[-2:], [{"t_ms": 2981.1, "if": "can0", "id": "065", "data": "2823000000000000"},
                                         {"t_ms": 4006.1, "if": "can0", "id": "065", "data": "2823000000000000"}])
        self.assertEqual([(trip["reason"], trip["kind"], trip["from_recording"]) for trip in why["trips"][1:]],
                         [("SAFE_STATE_UNCONFIRMED", "vehicle", True), ("VEHICLE_NOT_STOPPING", "vehicle", True)])
        self.assertIn("steering_command", [message["name"] for message in why["messages"]])

    def test_an_error_frame_is_told_from_a_data_frame(self):
        frames = traffic.log(traffic.frames(2000)).splitlines(True)
        frames.insert(700, frames[700].split(" ")[0] + " can0 20000040#0000000000000000\n")
        evidence = self.why("".join(frames))["trips"][0]["evidence"]
        self.assertEqual([frame["id"] for frame in evidence], ["20000040"])

    def test_a_gateway_and_a_foreign_sender(self):
        frames = traffic.frames(3000, engage_ms=1000, ai_interface="can1")
        frames.append(traffic.Frame(2500000, "gear_command", 0x168, bytes([2, 0, 0, 0, 0, 0, 0, 0]), "can0"))
        frames.sort(key=lambda frame: frame.t_us)
        trip = self.why(traffic.log(frames), "--ai-if", "can1")["trips"][0]
        self.assertEqual((trip["reason"], trip["kind"], trip["message"], trip["id"], trip["cause_ms"]),
                         ("FOREIGN_COMMAND_SENDER", "intrusion", "gear_command", "168", 2500))
        self.assertEqual(trip["evidence"], [{"t_ms": 2500, "if": "can0", "id": "168", "data": "0200000000000000"}])
        self.assertEqual((trip["limit"], trip["unit"], trip["last_good_ms"]), (None, None, None))

    def test_a_limit_of_the_configuration(self):
        self.write("c.yaml", "steering_command_timeout_ms: 200\neps_supply_fault_frames: 1\n")
        log = traffic.log(traffic.frames(4000, engage_ms=1000, edit=stop(("steering_command",), 3000)))
        trip = self.why(log, "--config", "c.yaml")["trips"][0]
        self.assertEqual((trip["limit"], trip["cause_ms"], trip["t_ms"]), (200, 3006, 3182))
        edit = edit_payload("eps_status", 3000, byte(7, 0x01))
        trip = self.why(traffic.log(traffic.frames(4000, edit=edit)), "--config", "c.yaml")["trips"][0]
        self.assertEqual((trip["reason"], trip["kind"]), ("EPS_UNDER_VOLTAGE", "bit"))  # one frame is enough

    def test_a_log_whose_name_is_no_utf_8(self):
        name = os.fsdecode(b"na\xefve.log")
        (self.folder / name).write_text(traffic.log(traffic.frames(1000)), encoding="ascii")
        for command, key in ((("replay", "--why", "-"), "log"), (("survey", "--json"), "source")):
            result = self.run_good(*command, name)
            self.assertEqual(json.loads(result.stdout)[key], "na?ve.log")

    def test_it_goes_to_standard_output_alone(self):
        self.write("my.log", traffic.log(traffic.frames(1000)))
        result = self.run_good("replay", "--why", "-", "my.log")
        self.assertEqual(json.loads(result.stdout)["trips"], [])
        self.assert_refused(self.run_program("replay", "--why", "-", "--events", "-", "my.log"), "--why")

    def test_demo_and_scenario_say_why(self):
        self.run_good("demo", "--why", "why.json", "--trace", "trace.json")
        demo = json.loads(self.read("why.json"))
        self.assertEqual([(trip["reason"], trip["kind"], trip["message"], trip["from_recording"])
                          for trip in demo["trips"]],
                         [("STEERING_COMMAND_TIMEOUT", "silence", "steering_command", False),
                          ("EPS_OVER_CURRENT_SHUTDOWN", "bit", "eps_status", False)])
        longest = {message["name"]: message["deadline_gap_ms"]["max"] for message in demo["messages"]}
        self.assertEqual({name for name, gap in longest.items() if gap > 100.1}, {"turn_signal_command", "steering_command"})
        scenario = str(SCENARIOS / "vcu" / "vcu_heartbeat_stuck.yaml")
        why = json.loads(self.run_good("scenario", "--why", "-", scenario).stdout)
        self.assertEqual([(trip["reason"], trip["kind"], trip["id"]) for trip in why["trips"]][0],
                         ("VCU_HEARTBEAT_STUCK", "stuck", "363"))

    def test_the_trace(self):
        self.write("my.log", traffic.log(traffic.frames(4000, engage_ms=1000, edit=stop(("steering_command",), 3000))))
        self.run_good("replay", "--trace", "trace.json", "my.log")
        events = json.loads(self.read("trace.json"))["traceEvents"]
        bars = [(event["name"], event["ts"], event["dur"]) for event in events if event["ph"] == "X"]
        self.assertEqual(bars[:3], [("INIT", 0, 512000), ("STANDBY", 512000, 488000), ("ACTIVE", 1000000, 2107000)])
        self.assertIn(("closed", 512000, 3095000), bars)
        faults = [(event["ph"], event["name"], event["ts"]) for event in events if event.get("cat") == "fault"]
        self.assertEqual(faults[0], ("b", "STEERING_COMMAND_TIMEOUT", 3107000))
        self.assertEqual(sorted(name for ph, name, _ in faults if ph == "b"),
                         sorted(name for ph, name, _ in faults if ph == "e"))
        frame = next(event for event in events if event["ph"] == "i" and event["name"] == "0A3")
        self.assertEqual(frame["args"], {"data": "0800000000000000", "signals": "gear P", "side": "vehicle"})


if __name__ == "__main__":
    unittest.main()
