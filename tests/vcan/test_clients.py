"""can-utils simulate VCU, EPS and AI computer for host_sim run, and record it.

Bytes are written out from docs/protocol.md. A moment is a stamp of the kernel's: how long a program took to start, or a
machine stood still, is not the supervisor's. In every run candump saw what the clients sent and what the supervisor says
that it sent, and nothing else (clients.py).
"""
import re
import subprocess
import time

import canbus
import clients
from clients import COMMANDS, STATUS, STATUS_ID, Vehicle, gaps, of

ALARM = "363#00.00.00.00.01.00.40.EE"  # manual, REMOTE_SIGNAL_LOST, a counter that has changed
GEAR_P, THROTTLE_0 = "0800000000000000", "0000000000000000"
LIGHTS = "00000000700000"
GEAR_D, THROTTLE_30, STEER = "0100000000000000", "4B00000000000000", "8C23000000000000"  # of the AI computer
HELD = "A323000000000000"  # 9123 = +12.3 degrees
STEERED_TO = 9123


class Watched(clients.Case):
    """The tools record."""

    # Shows: FSM-2, FSM-3, TOP-3, REMOTE_SIGNAL_LOST
    def test_a_fault_from_cansend_is_answered_at_once_and_latched(self):
        bus = self.bus()
        supervisor = self.supervisor("--can", bus)
        player = self.play(Vehicle("vcu", "eps").endless(), bus, endless=True)
        supervisor.wait_state("STANDBY")
        time.sleep(0.3)
        self.cansend(bus, ALARM)
        supervisor.wait_state("SAFE")
        time.sleep(2.0)
        player.stop()
        self.states_only(supervisor, ("INIT", None), ("STANDBY", None), ("TRIPPED", "REMOTE_SIGNAL_LOST"), ("SAFE", None))
        frames, sent = self.frames(bus), self.supervisors_frames(bus)
        cause = next(frame for frame in frames if frame.data == "00000000010040EE")
        standby = next(frame for frame in of(sent, STATUS_ID) if frame.data[:2] == "33")
        quiet = [frame for frame in of(sent, *COMMANDS) if standby.at < frame.at < cause.at]
        self.assertEqual(quiet, [])
        last = of(frames, 0x363)[-1].at  # then canplayer was ended
        after = [frame for frame in of(sent, *COMMANDS) if cause.at < frame.at <= last]
        # All three at once; manual is reported, so the steering is not held.
        self.assertEqual({frame.id for frame in after[:3]}, {"43F", "168", "075"})
        for frame in after[:3]:
            self.at_once(cause, frame)
        for can_id, second in ((0x43F, 0.100), (0x168, 0.066), (0x075, 0.033)):
            found = of(after, can_id)
            for place, frame in enumerate(found[1:]):
                self.at_most(0.010, abs(frame.at - found[0].at - second - 0.1 * place), "%03X, again" % can_id)
            self.assertGreaterEqual(len(found), 10 * (last - cause.at) - 2)
        # The status frame: state, rank of the reason (28), output closed, counter.
        told = of(sent, STATUS_ID)
        self.assertEqual({frame.data[:6] for frame in told if cause.at + 0.1 < frame.at <= last}, {"5A1C01"})
        counters = [int(frame.data[6:8], 16) for frame in told]
        self.assertEqual({(b - a) & 0xFF for a, b in zip(counters, counters[1:])}, {1})

    # Shows: TOP-4
    def test_a_shadow_decides_and_sends_nothing(self):
        bus = self.bus()
        shadow = self.supervisor("--can", bus, "--shadow")
        player = self.play(Vehicle("vcu", "eps").endless(), bus, endless=True)
        shadow.wait_state("STANDBY")
        self.cansend(bus, ALARM)
        shadow.wait_state("SAFE")
        time.sleep(0.3)
        player.stop()
        self.assertEqual(self.supervisors_frames(bus), [])
        self.check_all_accounted_for(bus)
        self.assertEqual(shadow.events()[-1]["sent"], 0)
        self.assertGreater(shadow.events()[-1]["shadowed"], 3 * 2)

    # Shows: P15, INT-2
    def test_frames_that_are_malformed_change_nothing_but_counters(self):
        bus = self.bus()
        supervisor = self.supervisor("--can", bus)
        player = self.play(Vehicle().slow().endless(), bus, endless=True)
        supervisor.wait_state("STANDBY")
        time.sleep(0.2)
        # All with the alarm that trips in a frame of 8 bytes.
        self.cansend(bus, "00000363#0000000001004011")
        self.cansend(bus, "363#R8", record="363#R8")
        self.cansend(bus, "363##00000000001004011", record="363##40000000001004011")
        self.cansend(bus, "363#0000000001")
        self.cansend(bus, "363#")
        self.cansend(bus, "20000004#0000000000000000")
        time.sleep(0.2)
        summary = supervisor.stop()
        player.stop()
        self.assertEqual(summary["rejected"], {"length": 2, "extended": 1, "remote": 1, "fd": 1, "error": 1})
        self.states_only(supervisor, ("INIT", None), ("STANDBY", None))
        self.assertEqual(supervisor.faults(), [])

    # Shows: TIM-1, P16
    def test_canbusload_counts_what_the_protocol_says(self):
        bus = self.bus()
        supervisor = self.supervisor("--can", bus)
        player = self.play(Vehicle().endless(), bus, endless=True)
        supervisor.wait_state("STANDBY")
        time.sleep(0.2)
        output = self.folder / "load"
        with open(output, "wb") as file:
            load = self.popen("canbusload", bus + "@500000", stdout=file)
            lines = self.until(lambda: self.loads(output, bus, 4), "four seconds of canbusload")
            load.terminate()
            load.wait()
        player.stop()
        # 6 messages each 10 ms, 2 each 25 ms, 3 each 100 ms, and the status frame each 10 ms; none of the supervisor's own.
        per_second = 600 + 80 + 30 + 100
        for frames, percent in lines[1:4]:
            self.at_most(25, abs(frames - per_second), "a second of canbusload: %d frames, not %d: it" % (frames, per_second))
            # 8 bytes: 44 + 64 bits, 3 between frames, at most 24 of stuffing: 111 to 135 bits at 500 kbit/s.
            self.assertTrue(int(frames * 111 / 5000) <= percent <= frames * 136 / 5000 + 1, (frames, percent))

    def loads(self, path, bus, count):
        found = re.findall(r"%s@500000\s+(\d+)\s+\d+\s+\d+\s+(\d+)%%" % bus, path.read_text(errors="replace"))
        return [(int(frames), int(percent)) for frames, percent in found] if len(found) >= count else None


class Deadlines(clients.Case):
    """canplayer simulates a vehicle with a part that falls silent; with the default deadlines."""

    # Shows: SUP-3, FSM-2, FSM-10, STEERING_COMMAND_TIMEOUT
    def test_a_silent_ai_computer(self):
        def turn(vehicle):
            vehicle.engaged()
            vehicle.angle = STEERED_TO

        def fall_silent(vehicle):
            vehicle.nodes = {"vcu", "eps"}
        bus = self.bus()
        supervisor = self.supervisor("--can", bus, config=STATUS)
        self.play(Vehicle().log(2600, {800: turn, 1500: fall_silent, 2200: Vehicle.parked}), bus).wait()
        supervisor.stop()
        frames, sent = self.frames(bus), self.supervisors_frames(bus)
        self.assertEqual(supervisor.story()[:4], [("INIT", None), ("STANDBY", None), ("ACTIVE", None),
                                                  ("TRIPPED", "STEERING_COMMAND_TIMEOUT")])
        engaged = next(frame for frame in of(frames, 0x363) if frame.data[12:14] == "80")
        first = self.next_of(sent, engaged.at, *COMMANDS)
        last = [frame for frame in of(frames, 0x065) if frame.data == STEER][-1]
        self.assertGreater(first.at - last.at, 0.125 - 0.0001)  # the jitter of two clocks
        self.at_most(0.125 + 0.002 + 0.008, first.at - last.at, "the reaction to a silent AI computer")
        after = [frame for frame in of(sent, *COMMANDS) if frame.at >= first.at]
        self.assertEqual({frame.id for frame in after[:4]}, {"43F", "168", "075", "065"})
        self.at_most(0.010, after[3].at - first.at, "all safe commands")
        # The wheel is held where it was, every 25 ms, until the VCU reports manual.
        holds = of(sent, 0x065)
        self.assertEqual({frame.data for frame in holds}, {HELD})
        manual = next(frame for frame in of(frames, 0x363) if frame.data[12:14] == "40" and frame.at > first.at)
        for gap, _ in gaps(holds):
            self.at_most(0.010, abs(gap - 0.025), "the period of the held angle")
        self.assertGreaterEqual(len(holds), int((manual.at - first.at) / 0.025))
        self.assertLess(holds[-1].at, manual.at + 0.006)


class Disturbed(clients.Case):
    """Removed interfaces, full queues, controllers that report errors."""

    def healthy(self, bus):
        return self.play(Vehicle("vcu", "eps").slow().endless(), bus, endless=True)

    def outputs(self, supervisor):
        return [event["closed"] for event in supervisor.events("safety_output")]

    def no_burst(self, frames):
        """Missed frames are not sent later: one is sent at once, the next at its place in the cycle (TIM-1)."""
        for can_id in (0x43F, 0x168, 0x075):
            stamps = [frame.at for frame in of(frames, can_id)]
            self.assertGreaterEqual(len(stamps), 5, "%03X" % can_id)
            for cycles in (1, 2, 4):
                early = [stamp for stamp in stamps if stamp < stamps[0] + 0.1 * cycles - 0.006]
                self.assertLessEqual(len(early), cycles + 1, "a burst of %03X: %s" % (can_id, stamps[:8]))

    # Shows: SUP-7, FSM-4, BUS_OFF
    def test_an_interface_that_is_set_down_and_up(self):
        bus = self.bus()
        supervisor = self.supervisor("--can", bus)
        player = self.healthy(bus)
        supervisor.wait_state("STANDBY")
        canbus.ip("link", "set", "dev", bus, "down")
        down_by = time.time()
        supervisor.wait_state("TRIPPED")
        player.stop()  # canplayer ends by itself when its interface is down
        time.sleep(0.5)
        up_from = time.time()
        canbus.ip("link", "set", "dev", bus, "up")
        up_by = time.time()
        supervisor.wait_for("fault", name="BUS_OFF", active=False)
        time.sleep(1.1)  # whatever was fresh before is not any more
        self.assertEqual(supervisor.states()[-1], "TRIPPED")
        self.healthy(bus)
        self.until(lambda: supervisor.states()[-1] == "SAFE", "SAFE in the end")
        time.sleep(0.5)
        # It may be SAFE for as long as the last frames are fresh, and is again when the vehicle is back.
        self.assertEqual(supervisor.story()[:3], [("INIT", None), ("STANDBY", None), ("TRIPPED", "BUS_OFF")])
        self.assertIn(supervisor.story()[3:], ([("SAFE", None)], [("SAFE", None), ("TRIPPED", None), ("SAFE", None)]))
        self.assertEqual(self.outputs(supervisor), [False, True, False])
        sent = self.supervisors_frames(bus)
        self.assertEqual([frame for frame in sent if down_by < frame.at < up_from], [])
        first = [frame for frame in of(sent, *COMMANDS) if frame.at > up_from][:3]
        self.assertEqual({frame.id for frame in first}, {"43F", "168", "075"})
        self.at_most(0.020, first[0].at - up_by, "the first command after the interface was up")
        self.at_most(0.010, first[2].at - first[0].at, "all safe commands")
        self.assertEqual(supervisor.events()[-1]["first_reason"], "BUS_OFF")

    # Shows: SUP-7, TX_STALLED
    def test_a_queue_that_is_full(self):
        self.shaped = True
        bus = self.bus()
        supervisor = self.supervisor("--can", bus)
        player = self.healthy(bus)
        supervisor.wait_state("STANDBY")
        player.stop()
        supervisor.wait_state("TRIPPED")
        # Ten frames of 16 bytes fit into the queue, and one leaves every 2 s.
        self.call("tc", "qdisc", "add", "dev", bus, "root", "tbf", "rate", "64bit", "burst", "16", "limit", "160")
        supervisor.wait_for("fault", name="TX_STALLED", active=True)
        refused = subprocess.run(["cansend", bus, "123#00"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, check=False)
        self.assertIn(b"No buffer space available", refused.stdout)
        stalled_at = time.time()
        time.sleep(1.0)
        self.call("tc", "qdisc", "del", "dev", bus, "root")
        free_at = time.time()
        supervisor.wait_for("fault", name="TX_STALLED", active=False)
        time.sleep(1.0)
        self.healthy(bus)
        supervisor.wait_state("SAFE")
        self.assertEqual(supervisor.story()[2:3], [("TRIPPED", "VCU_HEARTBEAT_LOST")])
        sent = self.supervisors_frames(bus)
        self.assertLessEqual(len([frame for frame in sent if stalled_at < frame.at < free_at - 0.05]), 2)
        self.no_burst([frame for frame in sent if frame.at > free_at])
        self.assertFalse(self.outputs(supervisor)[-1])

    # Shows: SUP-7, FSM-4, BUS_OFF, ERROR_PASSIVE, RX_OVERRUN
    def test_error_frames_from_cansend(self):
        bus = self.bus()
        supervisor = self.supervisor("--can", bus)
        player = self.healthy(bus)
        supervisor.wait_state("STANDBY")
        self.cansend(bus, "20000004#0010000000000000")  # receiver error passive
        supervisor.wait_for("fault", name="ERROR_PASSIVE", active=True)
        self.cansend(bus, "20000004#0040000000000000")  # error active again
        supervisor.wait_for("fault", name="ERROR_PASSIVE", active=False)
        self.cansend(bus, "20000004#0001000000000000")  # receive queue overflow
        supervisor.wait_for("fault", name="RX_OVERRUN", active=True)
        self.assertEqual(supervisor.states(), ["INIT", "STANDBY"])
        self.assertEqual(self.outputs(supervisor), [False, True])
        self.cansend(bus, "20000040#0000000000000000")  # bus-off
        supervisor.wait_for("fault", name="BUS_OFF", active=True)
        time.sleep(0.5)
        self.cansend(bus, "20000100#0000000000000000")  # restarted
        supervisor.wait_state("SAFE")
        time.sleep(0.3)
        player.stop()
        frames, sent = self.frames(bus), self.supervisors_frames(bus)
        off, on = [next(frame for frame in frames if frame.id == text) for text in ("20000040", "20000100")]
        self.states_only(supervisor, ("INIT", None), ("STANDBY", None), ("TRIPPED", "BUS_OFF"), ("SAFE", None))
        self.assertEqual(self.outputs(supervisor), [False, True, False])
        # At most one frame that the controller had already (FSM-2) follows the bus-off; then nothing until it is over.
        self.assertLessEqual(len([frame for frame in sent if off.at < frame.at < off.at + 0.02]), 1)
        self.assertEqual([frame for frame in sent if off.at + 0.02 < frame.at < on.at], [])
        after = [frame for frame in of(sent, *COMMANDS) if frame.at > on.at]
        self.assertEqual({frame.id for frame in after[:3]}, {"43F", "168", "075"})
        self.at_most(0.010, after[2].at - on.at, "all safe commands after the restart")


class Gateway(clients.Case):
    def start(self, log, **options):
        vehicle, ai = self.bus(), self.bus()
        supervisor = self.supervisor("--can", vehicle, "--ai-can", ai, "--topology", "gateway")
        return vehicle, ai, supervisor, self.play(log, vehicle, ai, **options)

    # Shows: TOP-2, P14, AI_COMMAND_OUT_OF_RANGE
    def test_between_two_buses(self):
        def too_much(vehicle):
            vehicle.ai = {**vehicle.ai, 0x075: bytes([251])}
        healthy = Vehicle()
        healthy.reserved, healthy.lights = 0xFF, 0x8F  # the reserved bits are all set
        log = healthy.log(4000, {1000: Vehicle.engaged, 2500: too_much, 3000: Vehicle.parked})
        vehicle, ai, supervisor, player = self.start(log)
        player.wait()
        supervisor.stop()
        self.assertEqual(supervisor.story()[:4], [("INIT", None), ("STANDBY", None), ("ACTIVE", None),
                                                  ("TRIPPED", "AI_COMMAND_OUT_OF_RANGE")])
        said, sent = self.frames(ai), self.supervisors_frames(vehicle)
        culprit = next(frame for frame in of(said, 0x075) if frame.data[:2] == "FB")
        standby = next(frame for frame in of(sent, STATUS_ID) if frame.data[:2] == "33").at
        engaged = next(frame for frame in of(sent, STATUS_ID) if frame.data[:2] == "3C").at

        def between(frames, begin, end, *ids):
            return [frame for frame in of(frames, *ids) if begin < frame.at < end]
        # STANDBY: lights only, the reserved bits as 0. A margin for what was on its way when the state changed.
        passed = between(sent, standby + 0.002, engaged - 0.012, *COMMANDS)
        self.assertEqual({frame.id for frame in passed}, {"43F"})
        # ACTIVE: all four.
        said_then = between(said, engaged, culprit.at, *COMMANDS)
        passed = between(sent, engaged, culprit.at, *COMMANDS)
        self.assertEqual({clients.key(frame)[:18] for frame in passed},
                         {"43F#" + "00000000800000", "168#" + GEAR_D[:14], "075#" + THROTTLE_30[:14], "065#" + STEER[:14]})
        self.assertEqual([frame.data[14:] for frame in of(passed, 0x43F)],
                         [frame.data[14:] for frame in of(said_then, 0x43F)])
        # Each identifier in its order; of those that wait behind a frame in flight the lowest goes first.
        for can_id in COMMANDS:
            causes, answers = of(said_then, can_id), of(passed, can_id)
            self.assertEqual(len(answers), len(causes), can_id)
            for cause, answer in zip(causes, answers):
                self.at_once(cause, answer)
        # And then the safe ones, in the handling of that very frame; the culprit has not passed, and nothing does.
        after = [frame for frame in of(sent, *COMMANDS) if frame.at > culprit.at]
        self.assertEqual({clients.key(frame)[:18] for frame in after[:4]},
                         {"43F#" + LIGHTS, "168#" + GEAR_P[:14], "075#" + THROTTLE_0[:14], "065#" + "2823" + "0" * 10})
        self.at_once(culprit, after[3])
        self.assertEqual({clients.key(frame)[:18] for frame in after},
                         {"43F#" + LIGHTS, "168#" + GEAR_P[:14], "075#" + THROTTLE_0[:14], "065#" + "2823" + "0" * 10})
        # Status frames: each, once, in the order of its identifier, at once, whatever the state; nothing else.
        status, handed = self.frames(vehicle), self.supervisors_frames(ai)
        ids = (0x363, 0x050, 0x101, 0x067, 0x167, 0x267, 0x0A3)
        self.assertEqual(len(of(handed, *ids)), len(handed))
        for can_id in ids:
            here, there = of(status, can_id), of(handed, can_id)
            self.assertGreater(len(there), 3.5 * 1000 / clients.MESSAGES[can_id][0])
            causes = here[len(here) - len(there):]  # the supervisor may have come a little later than the vehicle
            self.assertEqual([frame.data for frame in there], [frame.data for frame in causes])
            for cause, answer in zip(causes, there):
                self.at_once(cause, answer)

    # Shows: SUP-6, TOP-1, TOP-2, FOREIGN_COMMAND_SENDER
    def test_a_foreign_sender_on_the_vehicle_side(self):
        vehicle, ai, supervisor, player = self.start(Vehicle().endless(), endless=True)
        supervisor.wait_state("STANDBY")
        self.cansend(vehicle, "168#" + GEAR_D)
        supervisor.wait_state("SAFE")
        time.sleep(0.2)
        player.stop()
        self.assertEqual(supervisor.story()[:3], [("INIT", None), ("STANDBY", None),
                                                  ("TRIPPED", "FOREIGN_COMMAND_SENDER")])
        frames, sent = self.frames(vehicle), self.supervisors_frames(vehicle)
        foreign = next(frame for frame in frames if clients.key(frame) == "168#" + GEAR_D)
        answer = self.next_of(frames, foreign.at, 0x168)
        self.assertEqual(answer.data, GEAR_P)
        self.at_once(foreign, answer)
        self.assertEqual(of(self.supervisors_frames(ai), *COMMANDS), [])
        self.assertIn(answer, sent)

class TwoSupervisors(clients.Case):
    # Shows: TOP-1
    def test_on_one_bus_they_end_their_exchange(self):
        bus = self.bus()
        both = [self.supervisor("--can", bus, name=name, config=clients.PATIENT.replace("0x7F0", status))
                for name, status in (("one", "0x7F0"), ("two", "0x7F1"))]
        player = self.play(Vehicle("vcu", "eps").endless(), bus, endless=True)
        for supervisor in both:
            supervisor.wait_state("STANDBY")
        self.cansend(bus, ALARM)
        for supervisor in both:
            supervisor.wait_state("SAFE")
        time.sleep(0.3)
        # The AI computer insists, 20 times; each is answered by each supervisor at most once.
        babble = [(20 * count, "ai", "168#" + GEAR_D) for count in range(20)]
        self.play(babble, bus).wait()
        ended = time.time() + 0.1
        time.sleep(1.2)
        player.stop()
        sent = self.supervisors_frames(bus)
        frames = self.frames(bus)
        for supervisor in both:
            self.assertEqual(supervisor.story()[2:], [("TRIPPED", "REMOTE_SIGNAL_LOST"), ("SAFE", None)])
        gear = of(frames, 0x168)
        said = [frame for frame in gear if frame.data == GEAR_D]
        self.assertEqual(len(said), 20)
        for one, following in zip(said, [*said[1:], None]):
            end = following.at if following else one.at + 0.020
            answers = [frame for frame in of(sent, 0x168) if one.at < frame.at < end]
            self.assertTrue(answers, "no answer to %s" % (one,))
            self.assertLessEqual(len(answers), 4)  # two answers, and perhaps a periodic one of each
            self.at_once(one, answers[0])
        # Then it is over: each sends every 100 ms, and nothing on top.
        last = of(frames, 0x363)[-1].at
        for can_id in (0x43F, 0x168, 0x075):
            rest = [frame for frame in of(sent, can_id) if ended < frame.at < last]
            self.assertLessEqual(len(rest), 2 * (10 * (last - ended) + 1), "%03X" % can_id)
            self.assertGreaterEqual(len(rest), 2 * (10 * (last - ended) - 1.5), "%03X" % can_id)
