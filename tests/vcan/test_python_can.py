"""python-can simulates an AI computer and a VCU that react to host_sim run."""
import threading
import time

import can

import clients
from clients import COMMANDS, STATUS_ID, Vehicle, of
from test_clients import ALARM, GEAR_D, GEAR_P, LIGHTS, THROTTLE_0, THROTTLE_30


class Node:
    """A node of python-can on a bus. What it sends is recorded for the test."""

    def __init__(self, case, interface, hears=()):
        self.case, self.interface = case, interface
        filters = [{"can_id": can_id, "can_mask": 0x7FF, "extended": False} for can_id in hears]
        self.bus = can.interface.Bus(interface="socketcan", channel=interface, can_filters=filters or None)
        case.addCleanup(self.bus.shutdown)

    def send(self, can_id, data):
        data = bytes.fromhex(data) if isinstance(data, str) else bytes(data)
        self.bus.send(can.Message(arbitration_id=can_id, data=data, is_extended_id=False))
        self.case.record(self.interface, "%03X#%s" % (can_id, data.hex().upper()))


class Override(clients.Case):
    def tripped(self):
        bus = self.bus()
        self.play(Vehicle("vcu", "eps").slow().endless(), bus, endless=True)
        supervisor = self.supervisor("--can", bus)
        supervisor.wait_state("STANDBY")
        self.cansend(bus, ALARM)
        supervisor.wait_state("SAFE")
        time.sleep(0.1)
        return bus, supervisor, Node(self, bus, hears=(0x43F, 0x168, 0x075, 0x065))

    # Shows: TOP-1, FSM-6
    def test_each_command_of_the_ai_computer_is_answered_by_the_safe_one(self):
        bus, supervisor, ai = self.tripped()
        unsafe = {0x168: GEAR_D, 0x075: THROTTLE_30, 0x43F: "0000000080000011"}
        for count in range(12):
            for can_id, data in unsafe.items():
                ai.send(can_id, data)
                time.sleep(0.007)
        ai.send(0x065, "8C23000000000000")  # manual is reported: the steering is not held, and nobody answers
        self.cansend(bus, "168#01")  # short, and yet a VCU may obey it
        time.sleep(0.02)
        ai.send(0x168, GEAR_P)  # no difference: no answer
        ai.send(0x43F, LIGHTS + "11")  # the counter is none
        time.sleep(0.3)
        frames, sent = self.frames(bus), self.supervisors_frames(bus)
        mine = set(sent)
        answers = {0x168: {GEAR_P}, 0x075: {THROTTLE_0}}
        delays = []
        for can_id, data in [*unsafe.items(), (0x168, "01")]:
            said = [frame for frame in of(frames, can_id) if frame.data == data and frame not in mine]
            self.assertEqual(len(said), 1 if data == "01" else 12)
            for frame in said:
                # What follows it on the bus with this identifier is the safe command.
                answer = self.next_of(frames, frame.at, can_id)
                self.assertIn(answer, mine)
                self.assertTrue(answer.data in answers.get(can_id, ()) or answer.data[:14] == LIGHTS, answer)
                delays.append(answer.at - frame.at)
        # At once; or 5 ms after the override before it (override_gap_ms), which was 21 ms ago.
        self.at_most(0.003, sorted(delays)[len(delays) // 2], "half of the overrides")
        self.at_most(0.015, max(delays), "an override")
        self.assertEqual(of(sent, 0x065), [])
        # What differs in nothing is not answered: 20 ms after the override before it the next periodic one is 30 ms away.
        for can_id, data in ((0x168, GEAR_P), (0x43F, LIGHTS + "11")):
            same = next(frame for frame in of(frames, can_id) if frame.data == data and frame not in mine)
            self.assertGreater(self.next_of(sent, same.at, can_id).at - same.at, 0.003)
        # After an override the next periodic one is due half a cycle later.
        short = next(frame for frame in frames if clients.key(frame) == "168#01")
        answer, following = [frame for frame in of(sent, 0x168) if frame.at > short.at][:2]
        self.at_most(0.010, abs(following.at - answer.at - 0.050), "the next 168h after an override")


class Vcu(threading.Thread):
    """Reports and obeys: P on command, and manual when autopilot off is commanded."""

    def __init__(self, case, interface):
        super().__init__()
        self.node = Node(case, interface, hears=(0x43F, 0x168))
        self.mode, self.gear, self.buttons, self.count = clients.MANUAL, clients.P, 0, 0
        self.ended = threading.Event()
        self.start()
        case.addCleanup(self.end)

    def engage(self):
        self.mode, self.gear = clients.AUTOPILOT, clients.D

    def run(self):
        places = 0
        while not self.ended.is_set():
            self.obey(time.monotonic() + 0.02)
            self.count += 1
            self.node.send(0x363, [0, 0, 0, 0, 0, 0, self.mode | self.buttons, self.count & 0xFF])
            places += 1
            if places % 2 == 0:
                self.node.send(0x0A3, [self.gear, 0, 0, 0, 0, 0, 0, 0])

    def obey(self, until):
        while (left := until - time.monotonic()) > 0:
            heard = self.node.bus.recv(left)
            if heard is None:
                continue
            if heard.arbitration_id == 0x43F and heard.data[4] & 0x40:
                self.mode = clients.MANUAL
            if heard.arbitration_id == 0x168 and heard.data[0] == 8 and self.gear != clients.P:
                self.gear = clients.P

    def end(self):
        self.ended.set()
        self.join()


class Reset(clients.Case):
    # Shows: FSM-1, FSM-3, FSM-4
    def test_a_vcu_obeys_and_its_operator_resets(self):
        bus = self.bus()
        vcu = Vcu(self, bus)
        rest = Vehicle("vcu", "eps").slow()
        rest.silent = {0x363, 0x0A3}
        self.play(rest.endless(), bus, endless=True)
        ai = self.play(Vehicle("ai").slow().endless(), bus, endless=True)
        supervisor = self.supervisor("--can", bus)
        supervisor.wait_state("STANDBY")
        vcu.engage()
        supervisor.wait_state("ACTIVE")
        ai.stop()
        supervisor.wait_state("SAFE")
        for hold_s, result in ((0.4, None), (1.3, "STANDBY")):
            vcu.buttons = clients.BUTTON_1
            time.sleep(hold_s)
            vcu.buttons = 0
            time.sleep(0.3)
            self.assertEqual(supervisor.states()[-1], result or "SAFE")
        time.sleep(0.3)
        vcu.end()
        self.assertEqual(supervisor.story()[:6], [
            ("INIT", None), ("STANDBY", None), ("ACTIVE", None), ("TRIPPED", "STEERING_COMMAND_TIMEOUT"), ("SAFE", None),
            ("STANDBY", None)])
        self.assertEqual([(event["accepted"], event["why"]) for event in supervisor.events("reset")], [(True, [])])
        self.assertEqual([event["closed"] for event in supervisor.events("safety_output")][:2], [False, True])
        frames, sent = self.frames(bus), self.supervisors_frames(bus)
        beats = of(frames, 0x363)
        pressed = [b for a, b in zip(beats, beats[1:]) if (int(a.data[12:14], 16), int(b.data[12:14], 16)) == (0x40, 0x41)]
        released = [b for a, b in zip(beats, beats[1:]) if (int(a.data[12:14], 16), int(b.data[12:14], 16)) == (0x41, 0x40)]
        self.assertEqual((len(pressed), len(released)), (2, 2))
        told = of(sent, STATUS_ID)
        standby = next(frame for frame in told if frame.at > pressed[0].at and frame.data[:2] == "33")
        self.assertGreater(standby.at - released[1].at, -0.001)
        self.at_most(0.020, standby.at - released[1].at, "the reset")
        self.assertEqual(standby.data[2:6], "FF01")  # no reason any more; output closed
        last = [frame for frame in of(sent, *COMMANDS) if frame.at > pressed[1].at][-1]
        self.assertLess(last.at, standby.at + 0.001)
