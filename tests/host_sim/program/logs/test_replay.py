"""`host_sim replay`: time, frames, events, what is sent. The byte values and times are written by hand."""
import json
import unittest

import hostsim
import traffic
from traffic import AI, BASE_US, EPS, IDS, US_PER_MS, VCU, byte, edit_payload, raise_remote_signal_lost, stop

S = 1000000
SAFE_LIGHTS = 0x43F
SAFE_GEAR = (0x168, bytes([8, 0, 0, 0, 0, 0, 0, 0]))
SAFE_THROTTLE = (0x075, bytes(8))

STATUS = 0x7F0  # the status frame of the supervisor



class Healthy(hostsim.Case):
    # Shows: FSM-4, TOP-3
    def test_manual_traffic_reaches_standby_and_nothing_but_its_status_is_sent_from_then_on(self):
        result = self.replay(traffic.log(traffic.frames(3000)), "--tail", "0")
        states = [(event["from"], event["to"], event["reason"]) for event in result.of("state")]
        self.assertEqual(states, [(None, "INIT", None), ("INIT", "STANDBY", None)])
        standby = result.of("state")[1]["t_ms"]
        self.assertTrue(500 <= standby <= 520, standby)
        self.assertEqual([event["closed"] for event in result.of("safety_output")], [False, True])
        later = [sent for sent in result.sent() if sent.us >= BASE_US + standby * US_PER_MS]
        self.assertEqual([(sent.can_id, (sent.us - BASE_US) / US_PER_MS) for sent in later],
                         [(STATUS, t_ms) for t_ms in range(600, 3000, 100)])
        self.assertEqual(result.summary()["supervised_ms"], result.summary()["t_ms"] - standby)
        self.assertEqual(result.summary()["first_reason"], None)
        self.assertEqual(result.summary()["final_state"], "STANDBY")

    def supervised_for(self, expected_ms, frames):
        result = self.replay(traffic.log(frames), "--tail", "0", "--why", "why.json")
        self.assertEqual((result.summary()["supervised_ms"], json.loads(result.text("why.json"))["supervised_ms"]),
                         (expected_ms, expected_ms))

    def test_the_time_of_supervision_begins_with_the_frame_that_ends_init(self):
        for us in (0, 1, 999):
            frames = traffic.frames(3000)
            for frame in frames:  # each on a whole millisecond, or all after one
                frame.t_us = frame.t_us // US_PER_MS * US_PER_MS + (us if frame.t_us >= US_PER_MS else 0)
            standby = self.replay(traffic.log(frames), "--tail", "0").of("state")[1]["t_ms"]
            self.supervised_for(frames[-1].t_us // US_PER_MS - standby, frames)

    def test_init_sends_the_safe_commands_from_the_first_stamp_on(self):
        result = self.replay(traffic.log(traffic.frames(1000)))
        first = [sent for sent in result.sent() if sent.can_id != STATUS][:3]
        self.assertEqual([sent.us for sent in first], [BASE_US] * 3)
        self.assertEqual([(sent.can_id, sent.data) for sent in first[:2]], [SAFE_THROTTLE, SAFE_GEAR])
        self.assertEqual((first[2].can_id, first[2].data[:7]), (SAFE_LIGHTS, bytes([0, 0, 0, 0, 0x70, 0, 0])))
        self.assertNotIn(0x065, [sent.can_id for sent in result.sent()])

    # Shows: P1
    def test_identifiers_of_a_configuration(self):
        ids = dict(traffic.IDS, gear_command=0x169, vehicle_status=0x364)
        self.write("c.yaml", "id_gear_command: 0x169\nid_vehicle_status: 0x364\n")
        log = traffic.log(traffic.frames(2000, ids=ids, engage_ms=1000))
        result = self.replay(log, "--config", "c.yaml")
        self.assertEqual(result.summary()["final_state"], "ACTIVE")
        self.assertEqual(result.of("fault"), [])
        self.assertEqual({sent.can_id for sent in result.sent()}, {0x43F, 0x169, 0x075, STATUS})

    # Shows: TOP-3, STATUS_ID_IN_USE
    def test_a_status_frame_in_the_log_is_that_of_another_sender(self):
        lines = traffic.log(traffic.frames(2000)).splitlines(keepends=True)
        lines += ["%s can0 7F0#0000000000000000\n" % traffic.stamp(BASE_US + 1000500)]
        result = self.replay("".join(sorted(lines)))
        self.assertEqual(result.faults()[0][:2], (1000, "STATUS_ID_IN_USE"))
        self.assertEqual(result.summary()["final_state"], "STANDBY")

    # Shows: P1
    def test_the_other_set_of_identifiers(self):
        log = traffic.log(traffic.frames(2000, ids=traffic.TABLE_IDS, engage_ms=1000))
        result = self.replay(log, "--id-set", "table", "--tail", "0")
        self.assertEqual(result.summary()["final_state"], "ACTIVE")
        self.assertIn(0x201, [sent.can_id for sent in result.sent()])


class Time(hostsim.Case):
    # Shows: FSM-2
    def test_what_a_frame_causes_carries_the_stamp_of_the_frame(self):
        frames = traffic.frames(2000, edit=edit_payload("vehicle_status", 1500, raise_remote_signal_lost))
        culprit = next(frame for frame in frames if frame.name == "vehicle_status" and frame.t_ms >= 1500)
        culprit.t_us += 123
        result = self.replay(traffic.log(frames), "--tail", "10")
        self.assertEqual(result.trips(), [(1500, "REMOTE_SIGNAL_LOST")])
        after = [sent for sent in result.sent() if sent.us > BASE_US + 1500 * US_PER_MS]
        # All safe commands at once; manual is reported, so no steering hold; no tick comes in between.
        self.assertEqual([sent.us - BASE_US for sent in after[:3]], [1500123] * 3)
        self.assertEqual({sent.can_id for sent in after[:3]}, {0x43F, 0x168, 0x075})
        self.assertNotEqual(after[3].us, BASE_US + 1500123)

    # Shows: SUP-2, VCU_HEARTBEAT_LOST
    def test_ticks_fall_on_whole_milliseconds_since_the_first_stamp(self):
        base = BASE_US + 777
        frames = traffic.frames(2000, edit=stop(VCU, 1001))
        result = self.replay(traffic.log(frames, base_us=base), "--tail", "10")
        # The last 363h came at 1000.000; at 1050 its age is 50, which is not greater than the deadline.
        self.assertEqual(result.trips()[0], (1051, "VCU_HEARTBEAT_LOST"))
        after = [sent for sent in result.sent() if sent.us > base + 1000 * US_PER_MS]
        self.assertEqual(after[0].us, base + 1051 * US_PER_MS)

    # Shows: SUP-2
    def test_a_frame_comes_before_the_tick_of_the_same_moment(self):
        def gap(us):
            # 363h at 1000 ms is followed by one at 1051 ms + us; all else as ever.
            def edit(frame):
                if frame.name == "vehicle_status" and 1000 < frame.t_ms <= 1050:
                    if frame.t_ms < 1050:
                        return None
                    frame.t_us = 1051 * US_PER_MS + us
                return frame
            return traffic.log(traffic.frames(1500, edit=edit))
        self.assertEqual(self.replay(gap(0), "--tail", "0").trips(), [])
        self.assertEqual(self.replay(gap(-1), "--tail", "0").trips(), [])
        self.assertEqual(self.replay(gap(1), "--tail", "0").trips(), [(1051, "VCU_HEARTBEAT_LOST")])

    def test_the_stamp_of_a_frame_is_rounded_down_to_milliseconds(self):
        # 363h at 1000.999: 51 ms later, at 1051, its age is 51, since it counts as 1000.
        def edit(frame):
            if frame.name == "vehicle_status" and frame.t_ms >= 1000:
                frame.t_us += 999
            return None if frame.name == "vehicle_status" and frame.t_ms >= 1001 else frame
        result = self.replay(traffic.log(traffic.frames(1500, edit=edit)), "--tail", "0")
        self.assertEqual(result.trips()[0], (1051, "VCU_HEARTBEAT_LOST"))

    def test_the_run_goes_on_for_the_tail(self):
        log = traffic.log(traffic.frames(1000))  # ends at 994.1
        self.assertEqual(self.replay(log, "--tail", "0").summary()["t_ms"], 994)
        self.assertEqual(self.replay(log).summary()["t_ms"], 994)
        self.assertEqual(self.replay(log, "--tail", "5").summary()["t_ms"], 999)
        last = "(1700000001.000000) can0 000#\n"
        self.assertEqual(self.replay(log + last, "--tail", "5").summary()["t_ms"], 1005)
        self.assertEqual(self.replay(log, "--tail", "60").trips(), [(1041, "VCU_HEARTBEAT_LOST")])
        self.assertEqual(self.replay(last, "--tail", "0").summary()["t_ms"], 0)

    def test_a_stamp_that_goes_backwards_is_taken_as_the_last_one_and_counted(self):
        lines = traffic.log(traffic.frames(2000)).splitlines(keepends=True)
        at = lines.index("(1700000001.000000) can0 363#0000000000004064\n")
        lines[at + 1:at + 1] = ["(1700000000.500000) can0 363#0000000001004000\n",  # alarm: remote signal lost
                                "(0000000000.000001) can0 000#\n", "(1700000000.999999) can0 000#\n"]
        result = self.replay("".join(lines), "--tail", "0")
        self.assertEqual(result.summary()["backward_stamps"], 3)
        self.assertEqual(result.trips(), [(1000, "REMOTE_SIGNAL_LOST")])
        self.assertIn(BASE_US + 1 * S, [sent.us for sent in result.sent()])

    # Shows: TIM-2
    def test_the_clock_may_start_anywhere_and_wrap(self):
        log = traffic.log(traffic.frames(3000, engage_ms=1000, edit=stop(AI, 2000)))
        base = self.replay(log)
        texts = base.text("events.jsonl"), base.text("out.log")
        self.assertEqual(base.trips(), [(2107, "STEERING_COMMAND_TIMEOUT")])
        for start_ms in (1, 4294967295, 4294967295 - 2106, 4294967295 - 2107, 4294967295 - 1500, 2147483647):
            result = self.replay(log, "--start-ms", start_ms)
            self.assertEqual((result.text("events.jsonl"), result.text("out.log")), texts, start_ms)

    def test_the_stamps_of_the_log_may_be_of_any_time(self):
        frames = traffic.frames(1000, edit=stop(EPS, 700))
        base = self.replay(traffic.log(frames))
        for base_us in (0, 1, 999999, 999999999 * S, 9999999999 * S, 999999999990 * S):
            result = self.replay(traffic.log(frames, base_us=base_us))
            self.assertEqual(result.text("events.jsonl"), base.text("events.jsonl"))
            self.assertEqual(result.sent()[0].us, base_us)

    def test_a_jump_of_more_than_100_days_is_a_bad_line(self):
        one = "(0000000012.000000) can0 000#\n"
        result = self.replay(one + "(1700000000.000000) can0 000#\n(0000000013.000000) can0 000#\n",
                             "--skip-bad-lines", "--tail=0")
        self.assertEqual((result.summary()["skipped_lines"], result.summary()["t_ms"]), (1, 1000))

    def test_a_clock_that_was_set_hides_no_trip(self):
        """Else every later line would be skipped, and with it the trip."""
        frames = traffic.log(traffic.frames(1500, engage_ms=1000), base_us=10 * S).splitlines(keepends=True)
        later = traffic.log(traffic.frames(3000, engage_ms=0, edit=stop(AI, 1000))).splitlines(keepends=True)
        self.assert_refused(self.refuse("".join(frames + later), "--skip-bad-lines", "--fail-on-trip"),
                            "log:%d: the clock was set" % (len(frames) + 1))
        for command in (("survey",), ("monitor", "--speed=max", "--log"), ("scenario", "--from")):
            self.assert_refused(self.run_program(*command, "log"), "log:%d: " % (len(frames) + 1), "100 days")


class Events(hostsim.Case):
    def flapping(self, times, until_ms=None):
        """A warning that comes with every second 167h, so many times; then, from until_ms on, it stays."""
        def edit(frame):
            if frame.name == "eps_status":
                number = (int(frame.t_ms) - 2000) // 10
                comes = number >= 0 and number % 2 == 0 and number < 2 * times
                stays = until_ms is not None and frame.t_ms >= until_ms
                frame.data = frame.data[:7] + bytes([0x10 if comes or stays else 0])
            return frame
        return self.replay(traffic.log(traffic.frames(4000, edit=edit)), "--tail", "0")

    # Shows: EPS_TEMP_ABOVE_110
    def test_a_warning_that_flaps_is_told_and_counted_each_time(self):
        for times in (3, 40):
            result = self.flapping(times)
            self.assertEqual(result.faults(), [(2003 + 20 * i, "EPS_TEMP_ABOVE_110", "warn") for i in range(times)])
            self.assertEqual(result.faults(active=False),
                             [(2013 + 20 * i, "EPS_TEMP_ABOVE_110", "warn") for i in range(times)])
            self.assertEqual(result.summary()["warnings"], times)
            self.assertIn("EPS_TEMP_ABOVE_110  warn  2.003 s   %d times   0.%02d0 s\n" % (times, times), result.stdout)
        self.assertRegex(self.flapping(40, 2900).stdout, r"41 times   1\.49\d s  active at the end\n")

    # Shows: STARTUP_TIMEOUT
    def test_what_is_missing_has_the_same_words_everywhere(self):
        autopilot = edit_payload("vehicle_status", 0, byte(6, 0x80))
        rolls = edit_payload("wheel_speed", 0, lambda data: data.__setitem__(slice(0, 8), (500).to_bytes(4, "little") * 2))
        for edit, missing in ((stop(("vehicle_status",), 0), ["vcu_heartbeat", "trip_cause", "standstill", "manual"]),
                              (stop(EPS, 0), ["eps_heartbeat", "trip_cause", "messages"]),
                              (stop(("steering_status",), 0), ["eps_heartbeat", "trip_cause"]),
                              (stop(("wheel_speed",), 0), ["trip_cause", "standstill", "messages"]),
                              (stop(("gear_status",), 0), ["trip_cause", "messages"]),
                              (autopilot, ["manual"]),
                              (rolls, ["standstill"])):
            for end_ms in (9500, 10500):  # before and after the timeout
                result = self.replay(traffic.log(traffic.frames(end_ms, edit=edit)), "--tail", "0", "--why", "why.json")
                self.assertEqual([event["missing"] for event in result.of("startup")],
                                 [missing] if end_ms > 10000 else [])
                self.assertEqual(json.loads(result.text("why.json"))["not_supervised"], missing)
                text = " ".join(result.stdout[:result.stdout.index("log:")].split())
                self.assertEqual({word for word in missing if word not in text}, set(), text)

    def test_events_on_standard_output(self):
        self.write("log", traffic.log(traffic.frames(100)))
        result = self.run_good("replay", "--events", "-", "log")
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual(lines[-1]["event"], "summary")
        self.assertEqual(self.files(), ["log"])

    def test_a_summary_for_people_unless_standard_output_is_taken(self):
        self.write("log", traffic.log(traffic.frames(100)))
        result = self.run_good("replay", "log")
        self.assertIn("NOT SUPERVISED", result.stdout)
        self.assertIn("tripped     never", result.stdout)
        self.assertNotIn("{", result.stdout)
        self.assertEqual(self.run_good("replay", "--events", "e", "log").stdout, result.stdout)

    def test_what_was_sent_on_standard_output(self):
        self.write("log", traffic.log(traffic.frames(100)))
        result = self.run_good("replay", "--out", "-", "log")
        self.assertEqual([hostsim.Sent(line).us for line in result.stdout.splitlines()][:3], [BASE_US] * 3)


class Counting(hostsim.Case):
    # Shows: INT-2, P15
    def test_what_is_malformed_is_counted_by_its_kind_and_changes_nothing(self):
        frames = traffic.frames(2000)
        odd = ["43F#00", "43F#", "363#00000000000040", "0000043F#0000000000000011", "1FFFFFFF#", "43F#R", "43F#R8",
               "168#R2", "363##10000000000000000", "363##0000000000000000000000000", "20000080#0000000000000000"]
        lines = traffic.log(frames).splitlines(keepends=True)
        extra = ["(1700000001.0%05d) can0 %s\n" % (number, text) for number, text in enumerate(odd)]
        lines = sorted(lines + extra)
        result = self.replay("".join(lines), "--tail", "0")
        self.assertEqual(result.summary()["rejected"], {"length": 3, "extended": 2, "remote": 3, "fd": 2, "error": 1})
        self.assertEqual(result.summary()["received"], len(frames) + len(odd))
        self.assertEqual(result.summary()["final_state"], "STANDBY")
        self.assertEqual(result.of("fault"), [])

    def test_frames_of_no_interest_are_received(self):
        result = self.replay("(1.000000) can0 001#\n(1.000100) can0 7FF#0011223344556677\n", "--tail", "0")
        self.assertEqual(result.summary()["received"], 2)
        self.assertEqual(sum(result.summary()["rejected"].values()), 0)

    def test_sent_is_what_stands_in_the_log(self):
        result = self.replay(traffic.log(traffic.frames(500)))
        self.assertEqual(result.summary()["sent"], len(result.sent()))

    # Shows: TOP-4
    def test_shadow_sends_nothing_and_counts_it(self):
        log = traffic.log(traffic.frames(1000))
        loud = self.replay(log, "--tail", "100")
        shadow = self.replay(log, "--shadow", "--tail", "100")
        self.assertEqual(shadow.sent(), [])
        self.assertEqual(shadow.summary()["sent"], 0)
        self.assertGreater(shadow.summary()["shadowed"], 0)
        self.assertEqual(shadow.trips()[0], loud.trips()[0])
        self.assertIn("shadow: on (default off, WEAKER)", shadow.stderr)


class Controller(hostsim.Case):
    """Error frames act as on a live bus."""

    def with_errors(self, errors, duration_ms=3000, **options):
        frames = traffic.frames(duration_ms, **options)
        lines = traffic.log(frames).splitlines(keepends=True)
        lines += ["%s can0 %s\n" % (traffic.stamp(BASE_US + int(t_ms * US_PER_MS)), text) for t_ms, text in errors]
        return self.replay("".join(sorted(lines)), "--tail", "0")

    # Shows: SUP-7, BUS_OFF
    def test_bus_off_trips_and_lasts_until_the_log_shows_the_restart(self):
        result = self.with_errors([(1000.5, "20000040#0000000000000000"), (2000.5, "20000100#0000000000000000")])
        trip_ms, reason = result.trips()[0]
        self.assertEqual(reason, "BUS_OFF")
        self.assertTrue(1000 <= trip_ms <= 1001)
        sent = [(frame.us - BASE_US) / US_PER_MS for frame in result.sent() if frame.us > BASE_US + 1001 * US_PER_MS]
        self.assertTrue(2000 <= sent[0] <= 2001.5, sent[0])
        ended = [t_ms for t_ms, name, _ in result.faults(active=False) if name == "BUS_OFF"]
        self.assertEqual(len(ended), 1)
        self.assertTrue(2000 <= ended[0] <= 2001)
        first = [frame.can_id for frame in result.sent() if BASE_US + 2 * S <= frame.us < BASE_US + 2002 * US_PER_MS]
        self.assertLessEqual({0x43F, 0x168, 0x075}, set(first))
        self.assertEqual(result.summary()["rejected"]["error"], 2)

    def test_bus_off_is_not_ended_by_less(self):
        result = self.with_errors([(1000.5, "20000040#"), (1100.5, "20000004#0010000000000000"),
                                   (1200.5, "20000004#0004000000000000"), (1300.5, "20000002#00")])
        self.assertEqual([name for _, name, _ in result.faults(active=False)], [])
        self.assertEqual([frame for frame in result.sent() if frame.us > BASE_US + 1001 * US_PER_MS], [])

    def test_error_active_ends_bus_off(self):
        result = self.with_errors([(1000.5, "20000040#"), (1500.5, "20000004#0040000000000000")])
        self.assertEqual([name for _, name, _ in result.faults(active=False)], ["BUS_OFF"])

    # Shows: ERROR_PASSIVE
    def test_error_passive_warns_until_it_is_over(self):
        for passive, over in (("20000004#0010000000000000", "20000004#0040000000000000"),
                              ("20000004#0020000000000000", "20000004#0008000000000000"),
                              ("20000204#0030000000008000", "20000004#0004000000000000"),
                              ("20000004#0010000000000000", "20000100#0000000000000000")):
            result = self.with_errors([(1000.5, passive), (1500.5, over)])
            self.assertEqual([(name, kind) for _, name, kind in result.faults()], [("ERROR_PASSIVE", "warn")])
            self.assertEqual([name for _, name, _ in result.faults(active=False)], ["ERROR_PASSIVE"])
            self.assertEqual(result.trips(), [])

    # Shows: RX_OVERRUN
    def test_an_overrun_warns(self):
        result = self.with_errors([(1000.5, "20000004#0001000000000000")])
        self.assertEqual([(name, kind) for _, name, kind in result.faults()], [("RX_OVERRUN", "warn")])
        self.assertEqual([name for _, name, _ in result.faults(active=False)], ["RX_OVERRUN"])

    def test_other_errors_are_only_counted(self):
        result = self.with_errors([(1000.5, "20000001#0000000000000000"), (1001.5, "20000004#"),
                                   (1002.5, "20000088#0000000800000000"), (1003.5, "20000004#0002000000000000")])
        self.assertEqual(result.of("fault"), [])
        self.assertEqual(result.summary()["rejected"]["error"], 4)


class Interfaces(hostsim.Case):
    def test_on_the_shared_bus_every_interface_is_the_vehicle_side(self):
        lines = traffic.log(traffic.frames(1000)).splitlines(keepends=True)
        lines = [line.replace("can0", "can%d" % (number % 3)) for number, line in enumerate(lines)]
        result = self.replay("".join(lines), "--tail=0")
        self.assertEqual(result.summary()["final_state"], "STANDBY")

    def gateway(self, *arguments, **options):
        options.setdefault("ai_interface", "ai0")
        log = traffic.log(traffic.frames(2000, engage_ms=1000, interface="veh0", **options))
        return self.replay(log, "--topology", "gateway", "--tail=0", *arguments)

    # Shows: TOP-2
    def test_the_gateway_passes_frames_with_their_stamps(self):
        result = self.gateway("--ai-if", "ai0")
        self.assertEqual(result.summary()["final_state"], "ACTIVE")
        self.assertEqual(result.of("fault"), [])
        late = [sent for sent in result.sent() if sent.us >= BASE_US + 1200 * US_PER_MS]
        self.assertEqual({sent.can_id for sent in late if sent.interface == "veh0"}, {0x43F, 0x168, 0x075, 0x065, STATUS})
        self.assertEqual({sent.can_id for sent in late if sent.interface == "ai0"},
                         {IDS[name] for name in VCU + EPS})
        stamps = {BASE_US + frame.t_us for frame in traffic.frames(2000)}
        self.assertTrue(all(sent.us in stamps for sent in late if sent.can_id != STATUS))

    # Shows: FOREIGN_COMMAND_SENDER, SUP-6
    def test_an_interface_that_is_not_the_ai_side_is_the_vehicle_side(self):
        def edit(frame):
            frame.interface = "ai0" if frame.name in AI and frame.t_ms >= 100 else frame.interface
            return frame
        result = self.gateway("--ai-if", "ai1", ai_interface="ai1", edit=edit)
        self.assertEqual(result.summary()["final_state"], "INIT")
        self.assertIn("FOREIGN_COMMAND_SENDER", [name for _, name, _ in result.faults()])

    def test_an_interface_of_the_ai_side_makes_a_gateway(self):
        log = traffic.log(traffic.frames(2000, engage_ms=1000, interface="veh0", ai_interface="ai0"))
        stated = self.replay(log, "--topology", "gateway", "--ai-if", "ai0")
        self.write("c.yaml", "id_set: heading\n")
        for arguments in ((), ("--config", "c.yaml")):
            result = self.replay(log, "--ai-if", "ai0", *arguments)
            self.assertEqual(list(map(str, result.sent())), list(map(str, stated.sent())))


class Restart(hostsim.Case):
    """--reset-cause and --store."""

    # Shows: FSM-7, SUPERVISOR_RESET
    def test_whatever_is_no_power_on_starts_tripped(self):
        log = traffic.log(traffic.frames(100))
        for cause in ("watchdog", "brown-out", "lock-up", "software", "unknown"):
            result = self.replay(log, "--reset-cause", cause, "--tail=0")
            self.assertEqual(result.of("state")[0],
                             {"t_ms": 0, "event": "state", "from": None, "to": "TRIPPED", "reason": "SUPERVISOR_RESET"})
        result = self.replay(log, "--reset-cause", "power-on", "--tail=0")
        self.assertEqual(result.of("state")[0]["to"], "INIT")

    def trip(self, *arguments):
        log = traffic.log(traffic.frames(1500, edit=edit_payload("vehicle_status", 1000, raise_remote_signal_lost)))
        result = self.replay(log, "--store", "store", *arguments)
        self.assertEqual(result.summary()["first_reason"], "REMOTE_SIGNAL_LOST")

    # Shows: FSM-5, FSM-7
    def test_the_first_reason_outlives_a_reset(self):
        self.trip()
        log = traffic.log(traffic.frames(100))
        for _ in range(2):
            result = self.replay(log, "--store", "store", "--reset-cause", "watchdog", "--tail=0")
            self.assertEqual(result.of("state")[0]["to"], "TRIPPED")
            self.assertEqual(result.summary()["first_reason"], "REMOTE_SIGNAL_LOST")
            self.assertNotIn("STORE_INVALID", [name for _, name, _ in result.faults()])
        result = self.replay(log, "--store", "store", "--tail=0")
        self.assertEqual(result.of("state")[0]["to"], "INIT")

    # Each place that may be damaged, and files that are no store: tests/host_sim/io/test_store_file.c
    # Shows: FSM-7, STORE_INVALID
    def test_a_store_that_is_damaged_counts_as_tripped_and_warns(self):
        self.trip()
        log = traffic.log(traffic.frames(1000))
        for cause, state in (("watchdog", "TRIPPED"), ("power-on", "INIT")):
            self.write("store", "")
            result = self.replay(log, "--store", "store", "--reset-cause", cause, "--tail=0")
            self.assertEqual(result.of("state")[0]["to"], state)
            self.assertIn(("STORE_INVALID", "warn"), [(name, kind) for _, name, kind in result.faults()])
        result = self.replay(log, "--store", "store", "--tail=0")
        self.assertNotIn("STORE_INVALID", [name for _, name, _ in result.faults()])


if __name__ == "__main__":
    unittest.main()
