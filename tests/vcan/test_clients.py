"""can-utils simulate VCU, EPS and AI computer for host_sim run, and record it. run_clients.py runs this.

Bytes are written out from docs/protocol.md. A moment is a stamp of the kernel's: how long a program took to start, or a
machine stood still, is not the supervisor's. In every run candump saw what the clients sent and what the supervisor says
that it sent, and nothing else (clients.py); nothing left that FSM-6 forbids (oracle.py).
"""
import os
import re
import signal
import subprocess
import time

import clients
from clients import (COMMANDS, NEITHER, REMOTE_SIGNAL_LOST, STATUS, STATUS_ID, Vehicle, gaps, of,
                     overdue)

ALARM = "363#00.00.00.00.01.00.40.EE"  # manual, REMOTE_SIGNAL_LOST, a counter that has changed
GEAR_P, THROTTLE_0 = "0800000000000000", "0000000000000000"
LIGHTS = "00000000700000"
GEAR_D, THROTTLE_30, STEER = "0100000000000000", "4B00000000000000", "8C23000000000000"  # of the AI computer
HELD = "A323000000000000"  # 9123 = +12.3 degrees
STEERED_TO = 9123


def setter(**values):
    """A change of the vehicle: members that get values."""
    def change(vehicle):
        for name, value in values.items():
            setattr(vehicle, name, value)
    return change


def ai_falls_silent(vehicle):
    vehicle.nodes = {"vcu", "eps"}


class Watched(clients.Case):
    """The tools record."""

    # Shows: FSM-2, FSM-6, FSM-8, TIM-1
    def test_init_on_a_silent_bus_sends_the_safe_commands_on_their_cycles(self):
        bus = self.bus()
        self.supervisor("--can", bus)
        time.sleep(2.0)
        sent = self.supervisors_frames(bus)
        self.check_oracle(bus)
        self.assertEqual({frame.id for frame in sent}, {"43F", "168", "075", "7F0"})
        begin = min(frame.at for frame in of(sent, *COMMANDS))
        # FSM-2: all at once, then the next 43Fh 100 ms, 168h 66 ms, 075h 33 ms later; then every 100 ms.
        for can_id, second in ((0x43F, 0.100), (0x168, 0.066), (0x075, 0.033)):
            stamps = [frame.at - begin for frame in of(sent, can_id)]
            self.assertGreaterEqual(len(stamps), 15)
            for place, stamp in enumerate(stamps):
                due = 0 if place == 0 else second + 0.1 * (place - 1)
                self.at_most(0.010, abs(stamp - due), "%03X number %d" % (can_id, place))

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
        self.check_oracle(bus)
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
        self.check_oracle(bus)

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
        self.check_oracle(bus)

    def loads(self, path, bus, count):
        found = re.findall(r"%s@500000\s+(\d+)\s+\d+\s+\d+\s+(\d+)%%" % bus, path.read_text(errors="replace"))
        return [(int(frames), int(percent)) for frames, percent in found] if len(found) >= count else None


class Played(clients.Case):
    """canplayer simulates a vehicle with a part that falls silent; with the default deadlines."""

    def trip(self, log, reason):
        """Run a log, to its end. Gives candump's frames, those of the supervisor, and the first safe command."""
        bus = self.bus()
        supervisor = self.supervisor("--can", bus, config=STATUS)
        player = self.play(log, bus)
        player.wait()
        supervisor.stop()
        frames, sent = self.frames(bus), self.supervisors_frames(bus)
        mine = set(sent)
        late = overdue([frame for frame in frames if frame not in mine])
        story = [(state, why) for state, why in supervisor.story() if why is not None or state != "SAFE"]
        self.assertEqual(story[:4], [("INIT", None), ("STANDBY", None), ("ACTIVE", None), ("TRIPPED", reason)], late)
        self.check_oracle(bus)
        engaged = next(frame for frame in of(frames, 0x363) if frame.data[12:14] == "80")
        self.assertEqual([frame for frame in of(sent, *COMMANDS) if engaged.at < frame.at < engaged.at + 0.4], [])
        first = self.next_of(sent, engaged.at, *COMMANDS)
        return bus, frames, sent, first

    def log(self, at_1500, silent_until=2600, **options):
        """Manual for 0.8 s, engaged and turned to +12.3 degrees, and something at 1.5 s; parked at 2.2 s."""
        def engage(vehicle):
            vehicle.engaged()
            vehicle.angle = STEERED_TO
        return Vehicle().log(silent_until, {800: engage, 1500: at_1500, 2200: Vehicle.parked, **options})


class Deadlines(Played):
    # Shows: SUP-3, FSM-2, FSM-10, STEERING_COMMAND_TIMEOUT
    def test_a_silent_ai_computer(self):
        _, frames, sent, first = self.trip(self.log(ai_falls_silent), "STEERING_COMMAND_TIMEOUT")
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

    # Shows: SUP-2, FSM-10, VCU_HEARTBEAT_STUCK
    @clients.long
    def test_a_vcu_that_repeats_its_last_frame(self):
        _, frames, sent, first = self.trip(self.log(setter(frozen=True)), "VCU_HEARTBEAT_STUCK")
        beats = of(frames, 0x363)
        frozen = next(frame for frame in beats if frame.data == "0000000000008007" and frame.at > beats[100].at)
        # The first frozen one still changes the counter.
        self.assertGreater(first.at - frozen.at, 0.050 - 0.0001)
        self.at_most(0.050 + 0.002 + 0.008, first.at - frozen.at, "the reaction to a VCU that is stuck")
        self.assertEqual({frame.data for frame in of(sent, 0x065)}, {HELD})

    # Shows: SUP-2, FSM-10, EPS_HEARTBEAT_LOST
    def test_a_silent_eps_is_not_commanded(self):
        _, frames, sent, first = self.trip(self.log(setter(nodes={"vcu", "ai"})), "EPS_HEARTBEAT_LOST")
        last = of(frames, 0x067)[-1]
        self.assertGreater(first.at - last.at, 0.050 - 0.0001)
        self.at_most(0.050 + 0.002 + 0.008, first.at - last.at, "the reaction to a silent EPS")
        self.assertEqual(of(sent, 0x065), [])


class Replayed(Played):
    # Shows: FSM-3, STEERING_COMMAND_TIMEOUT
    @clients.long
    def test_a_log_of_candump_comes_to_the_same_again(self):
        _, frames, sent, _ = self.trip(self.log(ai_falls_silent), "STEERING_COMMAND_TIMEOUT")
        mine = set(sent)
        recorded = [frame for frame in frames if frame not in mine]
        begin = recorded[0].at
        path = self.folder / "recorded.log"
        path.write_text("".join("(%.6f) vehicle %s\n" % (frame.at, clients.key(frame)) for frame in recorded))
        again = [(round(1000 * (frame.at - begin)), "vehicle", clients.key(frame)) for frame in recorded]
        bus = self.bus()
        supervisor = self.supervisor("--can", bus, config=STATUS, name="again")
        self.play(again, bus).wait()
        supervisor.stop()
        expected = [("INIT", None), ("STANDBY", None), ("ACTIVE", None), ("TRIPPED", "STEERING_COMMAND_TIMEOUT"),
                    ("SAFE", None)]
        self.assertEqual(supervisor.story()[:5], expected)
        self.check_oracle(bus, supervisor)
        # The same log in virtual time.
        events = self.folder / "replay.events"
        self.call(clients.PROGRAM, "replay", "--tail", "0", "--events", events, path)
        replayed = [line for line in events.read_text().splitlines() if '"event": "state"' in line]
        self.assertEqual([re.search(r'"to": "(\w+)", "reason": (?:"(\w+)"|null)', line).groups() for line in replayed],
                         expected)


class Disturbed(clients.Case):
    """Removed interfaces, stopped programs, full queues, controllers that report errors."""

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
        self.scene.away.append((time.time(), time.time() + 3600))
        self.ip("link", "set", "dev", bus, "down")
        down_by = time.time()
        supervisor.wait_state("TRIPPED")
        player.stop()  # canplayer ends by itself when its interface is down
        time.sleep(0.5)
        up_from = time.time()
        self.ip("link", "set", "dev", bus, "up")
        up_by = time.time()
        supervisor.wait_for(0, "fault", name="BUS_OFF", active=False)
        known = len(supervisor.events("state"))
        time.sleep(1.1)  # whatever was fresh before is not any more
        self.healthy(bus)
        self.until(lambda: len(supervisor.states()) >= known and supervisor.states()[-1] == "SAFE", "SAFE in the end")
        self.scene.away = [(down_by - 1, time.time())]
        time.sleep(0.5)
        self.check_oracle(bus)
        # It may be SAFE for as long as the last frames are fresh, and is again when the vehicle is back.
        self.assertEqual(supervisor.story()[:3], [("INIT", None), ("STANDBY", None), ("TRIPPED", "BUS_OFF")])
        self.assertEqual(set(supervisor.story()[3:]), {("SAFE", None), ("TRIPPED", None)} & set(supervisor.story()[3:]))
        self.assertEqual(supervisor.states()[-1], "SAFE")
        self.assertEqual(self.outputs(supervisor), [False, True, False])
        sent = self.supervisors_frames(bus)
        self.assertEqual([frame for frame in sent if down_by < frame.at < up_from], [])
        first = [frame for frame in of(sent, *COMMANDS) if frame.at > up_from][:3]
        self.assertEqual({frame.id for frame in first}, {"43F", "168", "075"})
        self.at_most(0.020, first[0].at - up_by, "the first command after the interface was up")
        self.at_most(0.010, first[2].at - first[0].at, "all safe commands")
        self.assertEqual(supervisor.events()[-1]["first_reason"], "BUS_OFF")

    # Shows: TIM-4, TIM-1, STEP_OVERRUN
    @clients.long
    def test_a_supervisor_that_stood_still_for_two_seconds(self):
        bus = self.bus()
        supervisor = self.supervisor("--can", bus, config=STATUS)
        player = self.healthy(bus)
        supervisor.wait_state("STANDBY")
        woken = []
        for state in ("TRIPPED", "SAFE"):
            stopped = time.time()
            supervisor.process.send_signal(signal.SIGSTOP)
            time.sleep(2.0)
            woken.append((stopped, time.time()))
            supervisor.process.send_signal(signal.SIGCONT)
            self.scene.away.append((stopped, time.time() + 0.1))
            supervisor.wait_state(state)
            time.sleep(1.2)
        player.stop()
        self.check_oracle(bus)
        sent = self.supervisors_frames(bus)
        self.assertEqual(supervisor.story()[:3], [("INIT", None), ("STANDBY", None), ("TRIPPED", "STEP_OVERRUN")])
        self.assertEqual(supervisor.events()[-1]["first_reason"], "STEP_OVERRUN")
        for stopped, at in woken:
            self.assertEqual([frame for frame in sent if stopped + 0.005 < frame.at < at], [])
            after = [frame for frame in sent if at <= frame.at]
            commands = of(after, *COMMANDS)
            self.at_most(0.250, commands[0].at - at, "the first command after SIGCONT")
            self.no_burst(after)

    # Shows: SUP-7, TX_STALLED
    def test_a_queue_that_is_full(self):
        self.shaped = True
        bus = self.bus()
        supervisor = self.supervisor("--can", bus)
        player = self.healthy(bus)
        supervisor.wait_state("STANDBY")
        player.stop()
        supervisor.wait_state("TRIPPED")
        self.scene.away.append((0, time.time() + 3600))  # canplayer and status frames do as they can from here on
        # Ten frames of 16 bytes fit into the queue, and one leaves every 2 s.
        self.call("tc", "qdisc", "add", "dev", bus, "root", "tbf", "rate", "64bit", "burst", "16", "limit", "160")
        supervisor.wait_for(0, "fault", name="TX_STALLED", active=True)
        refused = subprocess.run(["cansend", bus, "123#00"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, check=False)
        self.assertIn(b"No buffer space available", refused.stdout)
        stalled_at = time.time()
        time.sleep(1.0)
        self.call("tc", "qdisc", "del", "dev", bus, "root")
        free_at = time.time()
        supervisor.wait_for(0, "fault", name="TX_STALLED", active=False)
        time.sleep(1.0)
        self.healthy(bus)
        supervisor.wait_state("SAFE")
        self.check_oracle(bus)
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
        supervisor.wait_for(0, "fault", name="ERROR_PASSIVE", active=True)
        self.cansend(bus, "20000004#0040000000000000")  # error active again
        supervisor.wait_for(0, "fault", name="ERROR_PASSIVE", active=False)
        self.cansend(bus, "20000004#0001000000000000")  # receive queue overflow
        supervisor.wait_for(0, "fault", name="RX_OVERRUN", active=True)
        self.assertEqual(supervisor.states(), ["INIT", "STANDBY"])
        self.assertEqual(self.outputs(supervisor), [False, True])
        self.cansend(bus, "20000040#0000000000000000")  # bus-off
        supervisor.wait_for(0, "fault", name="BUS_OFF", active=True)
        time.sleep(0.5)
        self.cansend(bus, "20000100#0000000000000000")  # restarted
        supervisor.wait_state("SAFE")
        time.sleep(0.3)
        player.stop()
        frames, sent = self.frames(bus), self.supervisors_frames(bus)
        off, on = [next(frame for frame in frames if frame.id == text) for text in ("20000040", "20000100")]
        self.scene.away.append((off.at, on.at + 0.1))
        self.check_oracle(bus)
        self.states_only(supervisor, ("INIT", None), ("STANDBY", None), ("TRIPPED", "BUS_OFF"), ("SAFE", None))
        self.assertEqual(self.outputs(supervisor), [False, True, False])
        # At most one frame that the controller had already (FSM-2) follows the bus-off; then nothing until it is over.
        self.assertLessEqual(len([frame for frame in sent if off.at < frame.at < off.at + 0.02]), 1)
        self.assertEqual([frame for frame in sent if off.at + 0.02 < frame.at < on.at], [])
        after = [frame for frame in of(sent, *COMMANDS) if frame.at > on.at]
        self.assertEqual({frame.id for frame in after[:3]}, {"43F", "168", "075"})
        self.at_most(0.010, after[2].at - on.at, "all safe commands after the restart")


class Noise(clients.Case):
    """cangen sends random frames."""

    def noise(self, count, ids=None):
        """(text) of frames as cangen makes them: 11-bit, all lengths; some of 29 bits, and remote ones."""
        scratch = "tn%d_%d" % (os.getpid() % 100000, next(clients.Scene.numbers))
        self.ip("link", "add", "dev", scratch, "type", "vcan")
        self.addCleanup(self.ip, "link", "del", "dev", scratch)
        self.ip("link", "set", "dev", scratch, "up")
        dump = clients.Dump(self, scratch)
        kinds = [(["-I", "r", "-L", "r"], count), (["-e", "-I", "r", "-L", "8"], count // 10),
                 (["-R", "-I", "r", "-L", "8"], count // 10)] if ids is None else \
            [(["-I", "%03X" % can_id, "-L", length], count // len(ids) // 2) for can_id in ids for length in ("8", "r")]
        for arguments, number in kinds:
            self.call("cangen", scratch, "-g", "0", "-n", number, "-D", "r", *arguments)
        return [[clients.key(frame) for frame in dump.stop()]]

    def spread(self, texts, begin_ms, end_ms, seed, interface="vehicle"):
        texts = clients.shuffled(texts, seed)
        return [(begin_ms + (end_ms - begin_ms) * place // len(texts), interface, text)
                for place, text in enumerate(texts)]

    # Shows: INT-2, TOP-1
    @clients.long
    def test_noise_beside_healthy_traffic_trips_nothing(self, count=2000, duration_ms=3200, seed=1):
        bus = self.bus()
        used = {"%03X" % can_id for can_id in clients.IN_USE}
        texts = [[text for text in group if text.split("#")[0] not in used] for group in self.noise(count)]
        noise = self.spread(texts, 0, duration_ms, seed)
        supervisor = self.supervisor("--can", bus, config=STATUS)
        healthy = self.play(Vehicle().log(duration_ms, {duration_ms // 2: Vehicle.engaged}), bus)
        other = self.play(noise, bus)
        supervisor.wait_state("ACTIVE")
        self.assertIsNone(healthy.process.poll(), "the noise was there while the autopilot drove")
        time.sleep(duration_ms / 2500)
        supervisor.stop()
        healthy.wait()
        other.wait()
        frames = self.frames(bus)
        late = overdue([frame for frame in frames if frame.id in used])
        if late:
            raise clients.HeldUp("silent in ms: %s" % late)
        self.states_only(supervisor, ("INIT", None), ("STANDBY", None), ("ACTIVE", None))
        self.assertEqual(supervisor.faults(), [])
        standby = next(frame for frame in of(self.supervisors_frames(bus), STATUS_ID) if frame.data[:2] == "33")
        sent = [frame for frame in of(self.supervisors_frames(bus), *COMMANDS) if frame.at > standby.at]
        self.assertEqual(sent, [])
        self.assertGreater(len(of(frames, 0x363)), duration_ms / 10 - 2)

    # Shows: FSM-6, INT-2, TOP-1
    @clients.long
    def test_noise_on_all_identifiers(self, count=1600, duration_ms=2000, seed=2):
        bus = self.bus()
        texts = self.noise(count, ids=sorted(clients.MESSAGES)) + self.noise(count // 4)
        supervisor = self.supervisor("--can", bus)
        log = self.spread(texts, 0, duration_ms, seed)
        self.play(Vehicle().log(duration_ms + 1500, {900: Vehicle.engaged, duration_ms: Vehicle.parked}), bus)
        supervisor.wait_state("ACTIVE")
        self.play(log, bus).wait()
        supervisor.stop()
        self.check_oracle(bus)
        # Among random frames are those that trip, and those of commands that have to be overridden.
        self.assertIn("TRIPPED", supervisor.states())
        self.assertGreater(len(of(self.supervisors_frames(bus), 0x168)), 50)

    # Shows: FSM-6, TOP-2
    @clients.long
    def test_noise_on_both_sides_of_a_gateway(self, count=1000, duration_ms=2000, seed=3):
        vehicle, ai = self.bus(), self.bus()
        ids = sorted(clients.MESSAGES)
        texts = {"vehicle": self.noise(count, ids=ids), "ai": self.noise(count, ids=ids)}
        supervisor = self.supervisor("--can", vehicle, "--ai-can", ai, "--topology", "gateway")
        log = self.spread(texts["ai"], 0, duration_ms, seed, "ai")
        # The AI side first, so that there is noise to pass on, or not to, while the autopilot drives.
        log += self.spread(texts["vehicle"], duration_ms // 4, duration_ms, seed, "vehicle")
        self.play(Vehicle().log(duration_ms + 1500, {900: Vehicle.engaged}), vehicle, ai)
        supervisor.wait_state("ACTIVE")
        self.play(sorted(log), vehicle, ai).wait()
        supervisor.stop()
        self.check_oracle(vehicle, gateway=True)
        self.assertIn("TRIPPED", supervisor.states())
        # Towards the AI computer: status frames as they are on the vehicle side, and nothing else.
        passed = {clients.key(frame) for frame in self.supervisors_frames(ai)}
        on_vehicle = {clients.key(frame) for frame in self.frames(vehicle)}
        self.assertEqual({text for text in passed if text not in on_vehicle}, set())
        self.assertLessEqual({text.split("#")[0] for text in passed}, {"363", "050", "101", "067", "167", "267", "0A3"})


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
        self.check_oracle(vehicle, gateway=True)
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
        self.check_oracle(vehicle, gateway=True)
        self.assertEqual(supervisor.story()[:3], [("INIT", None), ("STANDBY", None),
                                                  ("TRIPPED", "FOREIGN_COMMAND_SENDER")])
        frames, sent = self.frames(vehicle), self.supervisors_frames(vehicle)
        foreign = next(frame for frame in frames if clients.key(frame) == "168#" + GEAR_D)
        answer = self.next_of(frames, foreign.at, 0x168)
        self.assertEqual(answer.data, GEAR_P)
        self.at_once(foreign, answer)
        self.assertEqual(of(self.supervisors_frames(ai), *COMMANDS), [])
        self.assertIn(answer, sent)

    # Shows: SUP-7, AI_BUS_OFF
    @clients.long
    def test_a_full_queue_on_the_ai_side_only_warns(self):
        self.shaped = True
        vehicle, ai = self.bus(), self.bus()
        supervisor = self.supervisor("--can", vehicle, "--ai-can", ai, "--topology", "gateway")
        player = self.play(Vehicle("vcu", "eps").endless(), vehicle, ai, endless=True)
        supervisor.wait_state("STANDBY")
        self.call("tc", "qdisc", "add", "dev", ai, "root", "tbf", "rate", "64bit", "burst", "16", "limit", "160")
        supervisor.wait_for(0, "fault", name="AI_BUS_OFF", active=True, **{"class": "warn"})
        time.sleep(0.5)
        self.call("tc", "qdisc", "del", "dev", ai, "root")
        free = time.time()
        supervisor.wait_for(0, "fault", name="AI_BUS_OFF", active=False)
        time.sleep(0.5)
        player.stop()
        self.check_oracle(vehicle, gateway=True)
        self.states_only(supervisor, ("INIT", None), ("STANDBY", None))
        # The newest are kept: what comes first then is not older than a cycle or two.
        status = of(self.frames(vehicle), 0x363)
        first = self.next_of(self.supervisors_frames(ai), free, 0x363)
        same = next(frame for frame in reversed(status) if clients.key(frame) == clients.key(first) and frame.at <= first.at)
        self.at_most(0.030, first.at - same.at, "what waited: it")


class TwoSupervisors(clients.Case):
    # Shows: TOP-1
    @clients.long
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

    # Shows: TOP-1, FSM-10
    @clients.long
    def test_that_hold_two_angles_do_not_drown_the_bus(self):
        def engage(vehicle):
            vehicle.engaged()
            vehicle.angle = STEERED_TO

        def trip_the_first(vehicle):
            vehicle.silent = {0x267}

        def trip_the_second(vehicle):
            vehicle.alarms = REMOTE_SIGNAL_LOST
        bus = self.bus()
        # One of them trips when 267h is missing, the other does not.
        configs = (clients.PATIENT + "class_steering_position_timeout: trip\n", clients.PATIENT.replace("0x7F0", "0x7F1"))
        one, two = [self.supervisor("--can", bus, name="n%d" % place, config=config)
                    for place, config in enumerate(configs)]
        player = self.play(Vehicle().log(4000, {1000: engage, 1500: trip_the_first, 2100: setter(angle=9300),
                                                2300: trip_the_second, 2500: setter(mode=NEITHER, gear=8)}), bus)
        player.wait()
        frames = self.frames(bus)
        self.assertEqual(one.story()[3], ("TRIPPED", "STEERING_POSITION_TIMEOUT"))
        self.assertEqual(two.story()[3], ("TRIPPED", "REMOTE_SIGNAL_LOST"))
        held = {name: of(self.supervisors_frames(bus, supervisor), 0x065)
                for name, supervisor in (("one", one), ("two", two))}
        self.assertEqual({frame.data for frame in held["one"]}, {HELD})
        self.assertEqual({frame.data for frame in held["two"]}, {"5424000000000000"})
        # Each answers the other, but not more often than every 5 ms (less the jitter of stamps).
        for name, mine in held.items():
            stamps = [gap for gap, _ in gaps(mine)]
            self.assertGreaterEqual(sorted(stamps)[len(stamps) // 20], 0.004, name)
            self.assertLessEqual(len(mine), 1 + 200 * (mine[-1].at - mine[0].at), name)
        self.assertGreater(len(of(frames, 0x363)), 390)


