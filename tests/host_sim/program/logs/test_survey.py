"""`host_sim survey`: what it says of logs of a simulated vehicle, and the configuration that it proposes, replayed on the
same log: it trips nothing that the log does not deserve, and what is really wrong still trips."""
import gzip
import json
import os
import random
import re

import hostsim
import other_vehicle
import traffic
from traffic import byte, edit_payload, stop

MINUTE = 60000
ENGAGED = 5000
NO_TRIP = []


def jittered(frames, most_us, seed=1):
    """Every frame up to `most_us` later, in the order of the new times."""
    draw = random.Random(seed)
    for frame in frames:
        frame.t_us += draw.randrange(most_us)
    return sorted(frames, key=lambda frame: frame.t_us)


def slower(name, times):
    """Edit: only each n-th frame of a message, with a counter that counts as before."""
    seen = {"count": 0}

    def edit(frame):
        if frame.name == name:
            seen["count"] += 1
            if seen["count"] % times:
                return None
            if name in COUNTERS:
                frame.data = with_counter(frame, seen["count"] // times)
        return frame
    return edit


COUNTERS = {"vehicle_status": 7, "steering_status": 0, "turn_signal_command": 7}


def with_counter(frame, value):
    data = bytearray(frame.data)
    data[COUNTERS[frame.name]] = value & 0xFF
    return bytes(data)


class Case(hostsim.Case):
    def survey(self, frames, *arguments, name="log"):
        """Survey frames. Returns the JSON; the proposal is in config.yaml."""
        self.write(name, traffic.log(frames) if isinstance(frames, list) else frames)
        result = self.run_good("survey", "--json", "--config-out", "config.yaml", *arguments, name)
        self.assertEqual(result.stderr, "")
        return json.loads(result.stdout)

    def settings(self):
        """The settings of config.yaml, as text."""
        lines = self.read("config.yaml").splitlines()
        return dict(re.match(r"(\w+): (\S+)", line).groups() for line in lines if line and line[0] != "#")

    def trips_with_proposal(self, *arguments, name="log"):
        result = self.run_good("replay", "--config", "config.yaml", "--events", "events.jsonl", *arguments, name)
        self.assertGreater(result.summary()["supervised_ms"], 50000)
        return [reason for _, reason in result.trips()]

    def message(self, survey, name):
        return next(message for message in survey["messages"] if message["name"] == name)


class Proposal(Case):
    def test_a_healthy_vehicle_with_jitter(self):
        survey = self.survey(jittered(traffic.frames(MINUTE, ENGAGED), 4000))
        self.assertEqual(self.settings(), {"vcu_counter": "increments", "eps_counter": "increments"})
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)
        speed = self.message(survey, "wheel_speed")
        self.assertEqual(speed["count"], 6000)
        self.assertEqual(speed["deadline_ms"], 60)
        self.assertAlmostEqual(speed["gap_ms"]["median"], 10, delta=0.2)
        self.assertAlmostEqual(speed["margin_ms"], 60 - speed["gap_ms"]["max"], places=3)
        self.assertLess(speed["gap_ms"]["max"], 14)
        self.assertGreater(speed["gap_ms"]["min"], 6)
        self.assertEqual(speed["late"], 0)
        self.assertEqual(survey["not_heard"], [])
        self.assertEqual(survey["unknown"], [])
        self.assertEqual(survey["engagements"], 1)

    def test_a_slow_sender(self):
        survey = self.survey(jittered(traffic.frames(MINUTE, ENGAGED, edit=slower("throttle_status", 8)), 3000))
        self.assertAlmostEqual(self.message(survey, "throttle_status")["gap_ms"]["median"], 80, delta=1.5)
        settings = self.settings()
        self.assertEqual(sorted(settings), ["eps_counter", "throttle_status_timeout_ms", "vcu_counter"])
        self.assertGreaterEqual(int(settings["throttle_status_timeout_ms"]), 240)
        self.assertLessEqual(int(settings["throttle_status_timeout_ms"]), 250)
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)
        self.assertIn("WEAKER", self.read("config.yaml"))
        plain = self.run_good("replay", "--events", "events.jsonl", "log")
        self.assertEqual(plain.summary()["supervised_ms"], 0)  # with the default it never leaves INIT

    def test_a_slow_heartbeat(self):
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, edit=slower("vehicle_status", 4)))
        self.assertEqual(self.message(survey, "vehicle_status")["margin_ms"], 10)
        self.assertEqual(self.settings()["vcu_heartbeat_timeout_ms"], "120")
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)

    def test_a_sender_that_no_deadline_allows(self):
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, edit=slower("throttle_status", 30)))
        self.assertEqual(self.settings()["throttle_status_timeout_ms"], "500")
        self.assertTrue(any("must be faster" in note for note in survey["proposal"]["notes"]))

    def test_a_slow_sender_is_no_outage_and_one_frame_is_singular(self):
        slow = slower("steering_command", 8)

        def edit(frame):
            data = {"throttle_command": bytes([101 * 10 // 4]) + bytes(7), "turn_signal_command": bytes(7) + b"\x80"}
            if frame.t_ms // 100 == 50 and frame.name in data:
                frame.data = data[frame.name]
            return slow(frame)
        notes = self.survey(traffic.frames(20000, 1000, edit=edit))["proposal"]["notes"]
        self.assertTrue(any("ms, the longest at" in note and note.endswith(
            "; a sender that is too slow for steering_command_timeout_ms") for note in notes), notes)
        for beginning in ("075h throttle_command: 1 frame with an invalid throttle; no setting allows that",
                          "43Fh turn_signal_command: 2 of 199 steps of its counter were not by 1 to 3, "):
            self.assertTrue(any(note.startswith(beginning) for note in notes), notes)

    def test_the_other_id_set(self):
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, ids=traffic.TABLE_IDS))
        self.assertEqual(self.settings()["id_set"], "table")
        self.assertEqual(survey["id_sets"], {"heading": {"43F": 0, "363": 0}, "table": {"201": 600, "203": 6000},
                                             "used": "table"})
        self.assertEqual(self.message(survey, "vehicle_status")["id"], "203")
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)

    def test_the_id_set_that_was_asked_for_stays(self):
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, ids=traffic.TABLE_IDS), "--id-set", "heading")
        self.assertEqual(survey["id_sets"]["used"], "heading")
        settings = self.settings()
        self.assertNotIn("id_set", settings)
        self.assertEqual((settings["id_turn_signal_command"], settings["id_vehicle_status"]), ("0x201", "0x203"))
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)

    def test_renumbered_identifiers_of_a_pipe(self):
        ids = dict(traffic.IDS, gear_status=0x1A3)
        log = traffic.log(traffic.frames(MINUTE, ENGAGED, ids=ids)).encode()
        result = self.run_good("survey", "--config-out", "config.yaml", "-", stdin=log)
        self.assertIn("survey again with --config", result.stdout)
        self.assertEqual(self.settings()["id_gear_status"], "0x1A3")
        self.write("first.yaml", self.read("config.yaml"))
        survey = self.survey(log, "--config", "first.yaml")
        self.assertEqual(self.message(survey, "gear_status")["id"], "1A3")
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)

    def test_identifiers_that_cannot_be_told_apart_are_not_assigned(self):
        """A vehicle that stands still, in manual: several messages are all zeros."""
        ids = {name: 0x110 + 0x11 * number for number, name in enumerate(traffic.IDS)}
        survey = self.survey(traffic.frames(MINUTE, ids=ids))
        settings = self.settings()
        for name in ("throttle_status", "wheel_speed", "throttle_command"):
            self.assertNotIn("id_" + name, settings)
            self.assertTrue(any(note.startswith(name + " was not received") for note in survey["proposal"]["notes"]))

    def test_two_identifiers_that_fit_one_message(self):
        def twice(frame):
            copy = traffic.Frame(frame.t_us + 1, frame.name, 0x1A4, frame.data, frame.interface)
            return [frame, copy] if frame.name == "gear_status" else frame
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, ids=dict(traffic.IDS, gear_status=0x1A3), edit=twice))
        self.assertNotIn("id_gear_status", self.settings())
        self.assertIn("gear_status was not received; candidates: 1A3h, 1A4h. Look it up in the vehicle's document, and set "
                      "id_gear_status", survey["proposal"]["notes"])

    def test_counters_that_count_otherwise(self):
        steps = {"vehicle_status": 5, "steering_status": -1, "turn_signal_command": 3}
        counts = {}

        def edit(frame):
            if frame.name in steps:
                counts[frame.name] = counts.get(frame.name, 0) + steps[frame.name]
                frame.data = with_counter(frame, counts[frame.name])
            return frame
        survey = self.survey(traffic.frames(2 * MINUTE, ENGAGED, edit=edit))
        self.assertEqual(self.settings(), {"ai_counter": "increments"})
        self.assertEqual([self.message(survey, name)["counter"]["counts"] for name in sorted(steps)],
                         ["any", "increments", "any"])
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)

    def test_a_status_identifier_that_is_in_use(self):
        def edit(frame):
            other = traffic.Frame(frame.t_us + 10, "other", 0x7F0, bytes(8), frame.interface)
            return [frame, other] if frame.name == "gear_status" else frame
        self.survey(traffic.frames(MINUTE, ENGAGED, edit=edit))
        self.assertEqual(self.settings()["status_frame_id"], "0x7F1")
        self.assertEqual(self.trips_with_proposal(), NO_TRIP)
        result = self.run_good("replay", "--config", "config.yaml", "--events", "events.jsonl", "log")
        self.assertNotIn("STATUS_ID_IN_USE", [name for _, name, _ in result.faults()])

    def test_a_gateway(self):
        frames = traffic.frames(MINUTE, ENGAGED, ai_interface="can1", edit=slower("steering_command", 3))
        survey = self.survey(frames, "--ai-if", "can1")
        self.assertEqual(self.message(survey, "steering_command")["side"], "ai")
        settings = self.settings()
        self.assertEqual(settings["topology"], "gateway")
        self.assertEqual(settings["steering_command_timeout_ms"], "225")
        self.assertEqual([load["side"] for load in survey["load"]], ["vehicle", "ai"])
        self.assertEqual(self.trips_with_proposal("--ai-if", "can1"), NO_TRIP)


class Identifiers(Case):
    """Vehicles with other identifiers: a wrong one is worse than none."""

    # An AI computer at 100 and 50 ms, a VCU at 20 and 50 ms and an EPS at 20 ms.
    SLOW = {"vehicle_status": 20, "gear_status": 50, "throttle_status": 20, "wheel_speed": 20, "steering_status": 20,
            "eps_status": 20, "steering_position": 20, "steering_command": 50}
    OTHER = {"turn_signal_command": 0x4A1, "gear_command": 0x1A8, "throttle_command": 0x0F5, "steering_command": 0x0E5,
             "vehicle_status": 0x3A1, "gear_status": 0x123, "throttle_status": 0x0D0, "steering_status": 0x0E7,
             "eps_status": 0x1E7, "steering_position": 0x2E7, "wheel_speed": 0x181}

    def proposed(self):
        return {name[3:]: int(value, 16) for name, value in self.settings().items()
                if name.startswith("id_") and name != "id_set"}

    def candidates(self, survey, message):
        """The identifiers that may carry a message: for each the texts for and against."""
        row = next(row for row in survey["candidates"] if row["message"] == message)
        self.assertEqual(row["setting"], "id_" + message)
        return {found["id"]: (found["for"], found["against"]) for found in row["identifiers"]}

    def test_the_document_s_own_vehicle(self):
        survey = self.survey(other_vehicle.frames(traffic.IDS))
        self.assertEqual((survey["not_heard"], survey["candidates"], self.proposed()), ([], [], {}))

    def test_other_identifiers_and_the_document_s_cycles(self):
        survey = self.survey(other_vehicle.frames(self.OTHER))
        self.assertEqual(self.proposed(), self.OTHER)
        self.assertEqual((survey["not_heard"], survey["unknown"]), ([], []))
        self.assertEqual(self.message(survey, "wheel_speed")["id"], "181")
        self.assertEqual([row["proposed"] for row in survey["candidates"]], [True] * 11)
        reason = next(row["reason"] for row in survey["proposal"]["settings"] if row["name"] == "id_gear_command")
        self.assertRegex(reason, "^1A8h has the gear of 123h; changes before 123h does; its gears are R, N, D; comes every "
                                 r"100\.\d ms, as in the protocol: check it with the vehicle's maker$")
        result = self.run_good("replay", "--config", "config.yaml", "--events", "events.jsonl", "log")
        self.assertGreater(result.summary()["supervised_ms"], 39000)

    def test_a_computer_that_fails_shows_which_commands_are_its(self):
        """The vehicle obeys at once, so that commands and statuses change together."""
        at_once = {"lag_ms": 0, "cycles": self.SLOW}
        pairs = {"gear_command", "gear_status", "throttle_command", "throttle_status"}
        self.survey(other_vehicle.frames(self.OTHER, **at_once))
        self.assertFalse(pairs & set(self.proposed()))
        survey = self.survey(other_vehicle.frames(self.OTHER, silent=(20000, 20500), **at_once))
        self.assertEqual(self.proposed(), self.OTHER)
        self.assertIn("is silent when 4A1h turn_signal_command is", self.candidates(survey, "gear_command")["1A8"][0])
        self.assertIn("comes while 4A1h turn_signal_command is silent", self.candidates(survey, "gear_status")["123"][0])

    def test_a_throttle_is_no_steering_command(self):
        ids = {name: number for name, number in self.OTHER.items() if name not in ("steering_command", "throttle_command")}
        survey = self.survey(other_vehicle.frames(ids, {"throttle_status": 25}))
        self.assertNotIn("steering_command", self.proposed())
        self.assertEqual(self.candidates(survey, "steering_command")["0D0"],
                         (["comes every 25.0 ms, as in the protocol"],
                          ["does not have the angle of 0E7h", "its angle is -900.0 to -887.5 deg, an end stop"]))

    def test_no_wrong_identifier_whatever_the_cycles(self):
        count = max(4, 24 // hostsim.PART)
        proposed = 0
        for seed in range(count):
            vehicle = other_vehicle.some(seed)
            survey = self.survey(other_vehicle.frames(**vehicle))
            with self.subTest(seed=seed):
                self.assertEqual({name: vehicle["ids"][name] for name in self.proposed()}, self.proposed())
                proposed += len(self.proposed())
                for message in set(survey["not_heard"]) - set(self.proposed()):
                    if vehicle["ids"][message] in traffic.TABLE_IDS.values() or vehicle["ids"][message] in traffic.IDS.values():
                        continue  # it is taken for the message of the document
                    self.assertIn("%03X" % vehicle["ids"][message], self.candidates(survey, message))
        self.assertGreater(proposed, 8 * count)

    def test_a_command_as_fast_as_a_status_in_the_document(self):
        """Commands and statuses have each other's cycles."""
        cycles = {"gear_command": 25, "gear_status": 100, "throttle_command": 10, "throttle_status": 100}
        for seed, lag_ms in enumerate((0, 40, 300)):
            self.survey(other_vehicle.frames(self.OTHER, cycles, lag_ms=lag_ms, seed=seed))
            proposed = self.proposed()
            self.assertEqual({name: self.OTHER[name] for name in proposed}, proposed)

    def test_candidates_with_what_speaks_for_and_against_them(self):
        """A vehicle in which command and status change in the same moment: nothing says which is which."""
        ids = {name: 0x110 + 0x11 * number for number, name in enumerate(traffic.IDS)}
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, ids=ids))
        self.assertEqual(self.proposed(), {name: ids[name] for name in (
            "steering_command", "vehicle_status", "steering_status", "steering_position", "wheel_speed")})
        command, status = "%03X" % ids["gear_command"], "%03X" % ids["gear_status"]
        self.assertEqual(self.candidates(survey, "gear_command"), {
            command: (["has the gear of %sh" % status, "its gears are P, D", "comes every 100.0 ms, as in the protocol"], []),
            status: (["has the gear of %sh" % command, "its gears are P, D"], ["comes every 25.0 ms, not every 100 ms"])})
        self.assertEqual(list(self.candidates(survey, "gear_status")), [status, command])
        self.assertEqual(list(self.candidates(survey, "turn_signal_command")), ["%03X" % ids["turn_signal_command"]])
        text = self.run_good("survey", "log").stdout
        self.assertIn("  id_gear_command: candidates\n"
                      "    %sh  for      has the gear of %sh\n"
                      "          for      its gears are P, D\n"
                      "          for      comes every 100.0 ms, as in the protocol\n"
                      "    %sh  for      has the gear of %sh\n"
                      "          for      its gears are P, D\n"
                      "          against  comes every 25.0 ms, not every 100 ms\n" % (command, status, status, command), text)
        for line in text.splitlines():
            self.assertLessEqual(len(line), 100, line)

    def test_bytes_of_zeros_are_a_candidate(self):
        ids = {name: number for name, number in self.OTHER.items() if name != "steering_position"}
        survey = self.survey(other_vehicle.frames(ids, strangers=[("empty", 0x2F0, 20)]))
        self.assertEqual(self.proposed(), ids)
        self.assertEqual(self.candidates(survey, "steering_position"),
                         {"2F0": ([], ["all its bytes are 0", "comes every 20.0 ms, not every 10 ms"])})

    def test_an_identifier_of_the_document_that_carries_something_else(self):
        ids = dict(traffic.IDS, wheel_speed=0x0A3, gear_status=0x2A1)
        self.survey(other_vehicle.frames(ids))
        self.assertEqual(self.proposed(), {"wheel_speed": 0x0A3, "gear_status": 0x2A1})
        del ids["gear_status"]
        survey = self.survey(other_vehicle.frames(ids))
        self.assertEqual(self.proposed(), {})  # two messages cannot have one identifier
        self.assertIn("gear_status is not what 0A3h carries (most of its frames do not fit), and no identifier here could be "
                      "it. Look it up in the vehicle's document, and set id_gear_status", survey["proposal"]["notes"])
        self.assertEqual(list(self.candidates(survey, "wheel_speed")), ["0A3"])

    def test_an_identifier_of_the_other_set_is_not_an_id_set(self):
        survey = self.survey(other_vehicle.frames(dict(traffic.IDS, vehicle_status=0x3A1, wheel_speed=0x203)))
        self.assertEqual(survey["id_sets"]["used"], "heading")
        self.assertEqual(self.proposed(), {"vehicle_status": 0x3A1, "wheel_speed": 0x203})

    def test_a_gateway_has_its_commands_on_the_ai_side(self):
        def to_ai_side(frame):
            frame.interface = "can1" if frame.name in traffic.AI else "can0"
            return frame
        self.survey(other_vehicle.frames(self.OTHER, lag_ms=0, edit=to_ai_side), "--ai-if", "can1")
        self.assertEqual(self.proposed(), self.OTHER)


class NotRelaxed(Case):
    def test_an_outage_still_trips(self):
        frames = jittered(traffic.frames(MINUTE, ENGAGED), 4000)
        for name, reason in (("steering_status", "EPS_HEARTBEAT_LOST"), ("vehicle_status", "VCU_HEARTBEAT_LOST"),
                             ("steering_command", "STEERING_COMMAND_TIMEOUT"), ("eps_status", "EPS_STATUS_TIMEOUT"),
                             ("wheel_speed", "WHEEL_SPEED_TIMEOUT"), ("gear_command", "GEAR_COMMAND_TIMEOUT")):
            with self.subTest(name):
                survey = self.survey(list(filter(stop((name,), 50000, 50600), frames)))
                self.assertEqual([key for key in self.settings() if key.endswith("_ms")], [])
                self.assertEqual(self.trips_with_proposal()[0], reason)
                self.assertEqual(self.message(survey, name)["late"], 1)
                self.assertLess(self.message(survey, name)["margin_ms"], -200)
                self.assertTrue(any(name in note and "an outage" in note for note in survey["proposal"]["notes"]))

    def test_outages_that_come_again_and_again_still_trip(self):
        def edit(frame):
            return None if frame.name == "eps_status" and frame.t_ms > 6000 and frame.t_ms % 1000 < 300 else frame
        self.survey(traffic.frames(MINUTE, ENGAGED, edit=edit))
        self.assertNotIn("eps_status_timeout_ms", self.settings())
        self.assertEqual(self.trips_with_proposal()[0], "EPS_STATUS_TIMEOUT")

    def test_a_slow_sender_that_fails_still_trips(self):
        slow = slower("throttle_status", 8)
        frames = traffic.frames(MINUTE, ENGAGED, edit=lambda f: stop(("throttle_status",), 50000, 50600)(f) and slow(f))
        self.survey(frames)
        self.assertIn(self.settings()["throttle_status_timeout_ms"], ("240", "245"))
        self.assertEqual(self.trips_with_proposal()[0], "THROTTLE_STATUS_TIMEOUT")

    def test_a_counter_that_sticks_still_trips(self):
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, edit=edit_payload("steering_status", 50000, byte(0, 7))))
        self.assertEqual(self.trips_with_proposal()[0], "EPS_HEARTBEAT_STUCK")
        self.assertGreater(self.message(survey, "steering_status")["counter"]["longest_without_change_ms"], 9900)

    def test_an_alarm_keeps_its_class(self):
        survey = self.survey(traffic.frames(MINUTE, ENGAGED, edit=edit_payload("eps_status", 50000, byte(7, 0x40))))
        self.assertEqual(self.trips_with_proposal()[0], "EPS_MOTOR_ENCODER")
        self.assertEqual(self.message(survey, "eps_status")["alarms"],
                         [{"name": "EPS_MOTOR_ENCODER", "first_ms": 50003.3, "frames": 1000}])
        self.assertFalse([key for key in self.settings() if key.startswith("class_")])

    def test_a_short_log_relaxes_nothing(self):
        self.survey(traffic.frames(900, 300, edit=slower("throttle_status", 8)))
        self.assertEqual(self.settings(), {})

    def test_no_proposal_is_weaker_than_three_cycles_and_half(self):
        """Random senders: a deadline is never above the larger of default, 3 cycles and 1.5 usual longest gaps."""
        for seed in range(6):
            draw = random.Random(seed)
            times = draw.choice((2, 3, 5, 7))
            jitter = draw.choice((1000, 5000, 20000))
            survey = self.survey(jittered(traffic.frames(20000, 2000, edit=slower("eps_status", times)), jitter, seed))
            cycle = 10 * times
            most = max(60, 3.1 * cycle + 5, 1.5 * 1.02 * (cycle + jitter / 1000) + 5)
            with self.subTest(seed=seed):
                self.assertLessEqual(int(self.settings().get("eps_status_timeout_ms", 60)), most)
                self.assertEqual(survey["proposal"]["settings"],
                                 [row for row in survey["proposal"]["settings"] if row["reason"]])


class Text(Case):
    def test_what_people_read(self):
        def edit(frame):
            other = traffic.Frame(frame.t_us + 10, "other", 0x123, bytes(3), frame.interface)
            return [frame, other] if frame.name == "gear_status" else frame
        self.write("log", traffic.log(traffic.frames(MINUTE, ENGAGED, edit=edit)))
        result = self.run_good("survey", "log")
        for line in ("log: 59.994 s on can0, 45000 frames (750/s), candump -l",
                     "engaged  54.994 s in 1 engagement",
                     "ID set   heading (frames: 43Fh 600, 363h 6000; of table: 201h 0, 203h 0)",
                     "065h   steering_command         2400    25.00    25.00    25.00     25.00      125*    100.00",
                     "101h   wheel_speed              6000    10.00    10.00    10.00     10.00       60      50.00",
                     "  050h  throttle        0.0 to 4.0 %",
                     "  0A3h  gear            D, P",
                     "  363h  mode            manual, autopilot",
                     "  123h      2400 frames, 40.0/s, 3 bytes, median gap 25.00 ms",
                     "vcu_counter: increments  # default any"):
            self.assertIn(line + "\n", result.stdout)
        self.assertRegex(result.stdout, r"load +1\d\.\d to \d\d\.\d % of 500000 bit/s")
        for line in result.stdout.splitlines():
            self.assertLessEqual(len(line), 100, line)

    def test_the_load_of_a_bus(self):
        """1000 frames of 8 bytes a second at 500 kbit/s: 111 bits each, and at most 24 stuff bits."""
        lines = ["(%d.%06d) can0 123#0000000000000000\n" % (1 + i // 1000, i % 1000 * 1000) for i in range(10001)]
        survey = self.survey("".join(lines))
        load = survey["load"][0]
        self.assertAlmostEqual(load["least_pct"], 22.2, delta=0.01)
        self.assertAlmostEqual(load["most_pct"], 27.0, delta=0.01)
        self.assertAlmostEqual(load["busiest_second_pct"], 27.0, delta=0.01)
        half = self.survey("".join(lines), "--bitrate", "250000")["load"][0]
        self.assertAlmostEqual(half["most_pct"], 54.0, delta=0.02)

    def test_a_gap_that_exceeds_the_deadline_by_microseconds_does_not_show_0(self):
        def edit(frame):
            if frame.name == "vehicle_status" and 1000 <= frame.t_ms < 1040:
                return None
            frame.t_us += 4 if frame.name == "vehicle_status" and frame.t_ms == 1040 else 0
            return frame

        self.write("log", traffic.log(traffic.frames(5000, edit=edit)))
        self.assertRegex(self.run_good("survey", "log").stdout, r"\n363h .* 50 +-0\.01  LATE\n")

    def test_a_log_that_says_nothing_of_the_defaults(self):
        unknown, notes, fit = verdicts = ("# No message of the protocol came often enough to evaluate the defaults.",
                                          "# No setting needs another value, but the findings below must be explained first.", "# The defaults fit.")
        counts = dict.fromkeys(("vehicle_status", "steering_status"), 0)

        def fewer(frame):  # from 1000 steps of a counter on, it would propose a setting
            if frame.name in counts:
                counts[frame.name] += 1
                return frame if counts[frame.name] % 7 else None
            return frame

        for log, said in (("(1.000000) can0 123#11\n", unknown), (traffic.log(traffic.frames(500)), unknown),
                          (traffic.log(traffic.frames(3000, engage_ms=1000)), notes),
                          (traffic.log(traffic.frames(11500, engage_ms=1000, edit=fewer)), fit)):
            self.write("log", log)
            lines = self.run_good("survey", "log").stdout.splitlines()
            self.assertEqual([line for line in lines if line in verdicts], [said])

    def test_what_is_odd_about_the_log(self):
        self.write("log", "(2.000000) can0 123#11\nnonsense\n(1.000000) can0 123#11\n(1.000000) can0 20000004#0000000000000000\n")
        lines = self.run_good("survey", "--skip-bad-lines", "log").stdout.splitlines()
        self.assertIn("log      lines skipped: 1, time stamps that went backwards: 2, error frames: 1", lines)
        self.write("log", "(1.000000) can0 123#11\n")
        self.assertNotIn("\nlog  ", self.run_good("survey", "log").stdout)

    def test_a_log_whose_time_goes_back_says_so_first(self):
        said = "time goes back by 0.010 s at 0.500 s: gaps and load are wrong; cut or sort the log there"
        for stamp, expected in (("1.490000", [f"NOT RELIABLE: {said}", f"# - {said}"]), ("1.490001", [])):
            self.write("log", f"(1.000000) can0 123#11\n(1.500000) can0 123#11\n({stamp}) can0 123#11\n")
            lines = self.run_good("survey", "log").stdout.splitlines()
            self.assertEqual([line for line in lines if "goes back" in line], expected)
            self.assertEqual(lines[0].startswith("NOT RELIABLE"), bool(expected))

    def test_messages_that_were_not_heard(self):
        self.write("log", traffic.log(traffic.frames(2000, senders=("vcu",))))
        result = self.run_good("survey", "log")
        self.assertIn("067h   steering_status             -  not received\n", result.stdout)
        self.assertIn("  id_steering_status: no candidate\n", result.stdout)
        self.assertIn("# - steering_status was not received, and no identifier here could be it. Look it up in the "
                      "vehicle's document, and set id_steering_status\n", result.stdout.replace("\n#  ", ""))
        self.assertIn("# - autopilot was never engaged", result.stdout)

    def test_two_interfaces_that_are_not_a_gateway(self):
        self.write("log", traffic.log(traffic.frames(2000, ai_interface="can1")))
        self.assertIn("all interfaces count as one bus", self.run_good("survey", "log").stdout)
        self.assertNotIn("all interfaces", self.run_good("survey", "--ai-if", "can1", "log").stdout)

    def test_eight_interfaces_are_named_and_the_one_that_an_option_names(self):
        def log(count):
            return "".join("(%d.000000) can%d 123#00\n" % (second, second) for second in range(count))
        eight = "can0, can1, can2, can3, can4, can5, can6, can7"
        for count, arguments, said, more in ((8, (), eight + ", 8 frames", False), (9, (), eight + " and others, 9 frames", True),
                                             (10, ("--ai-if", "can9"), eight.replace("can7", "can9 and others, 10 frames"), True)):
            self.write("log", log(count))
            self.assertIn(" s on " + said, self.run_good("survey", *arguments, "log").stdout)
            survey = json.loads(self.run_good("survey", "--json", *arguments, "log").stdout)
            self.assertEqual((survey["interfaces"], survey["more_interfaces"]),
                             (said.split(" and")[0].rsplit(", 8 frames")[0].split(", "), more))
        self.assert_refused(self.run_program("survey", "--ai-if", "ai", "log"), "frames from " + eight + " and others, but none from ai")

    def test_the_proposal_alone(self):
        self.write("log", traffic.log(traffic.frames(2000)))
        result = self.run_good("survey", "--config-out", "-", "log")
        self.assertTrue(result.stdout.startswith("# Proposed by host_sim survey from log\n"), result.stdout)
        self.assertTrue(result.stdout.endswith("(INT-2).\n"), result.stdout)  # what nothing relaxes
        self.write("c.yaml", result.stdout)
        self.run_good("config", "--config", "c.yaml")

    def test_the_proposal_from_a_log_whose_name_is_no_text(self):
        content = traffic.log(traffic.frames(2000)).encode("ascii")
        for name in (b"\xff.log", b"\x7f\x01.log", *(f"{letter}: 1.log".encode("utf-8") for letter in
                                                     "\u00fc\u0080\u0085\u2028\u2029\ufeff\ufffe\uffff\U0001f697")):
            (self.folder / os.fsdecode(name)).write_bytes(content)
            self.run_good("survey", "--config-out", "c.yaml", os.fsdecode(name))
            self.run_good("config", "--config", "c.yaml")

    def test_an_hour_in_under_five_seconds(self):
        self.write("log", traffic.repeated(traffic.log(traffic.frames(MINUTE, ENGAGED)), max(1, 60 // hostsim.PART)))
        cpu_s = self.least_cpu_s(5, "survey", "log")
        print(f"survey of an hour: {cpu_s:.2f} s CPU", flush=True)
        self.assertLess(cpu_s, 5)


class Refused(Case):
    def test_logs_that_cannot_be_read_leave_the_proposal_as_it_was(self):
        packed = gzip.compress(traffic.log(traffic.frames(500)).encode())
        for content, part in ((b"", "contains no frame"), (b"\x00" * 100, "binary data"), (packed[:200], "cut off"),
                              (b"LOGG" + bytes(100), "python3 -m can.logconvert log log.log"),
                              (traffic.log(traffic.frames(500)).encode()[:-4], "log:")):
            self.write("config.yaml", "park: at_once\n")
            self.write("log", content)
            with self.subTest(part):
                self.assert_refused(self.run_program("survey", "--config-out", "config.yaml", "log"), part)
                self.assertEqual(self.read("config.yaml"), "park: at_once\n")
                self.assertEqual(self.files(), ["config.yaml", "log"])

    def test_the_survey_is_printed_though_the_proposal_is_lost(self):
        self.write("log", traffic.log(traffic.frames(2000)))
        expected = self.run_good("survey", "log").stdout
        result = self.run_program("survey", "--config-out", "/dev/full", "log")
        self.assert_refused(result, "/dev/full: No space left")
        self.assertEqual(result.stdout, expected)


if __name__ == "__main__":
    hostsim.unittest.main()
