"""host_sim vehicle on a virtual bus: what it sends, what it obeys, faults by option and typed.

Bytes are written out from docs/protocol.md.
"""
import statistics
import subprocess
import time
import unittest

import canbus

AI = {0x168: 100, 0x075: 100, 0x065: 25}  # milliseconds
VCU = {0x0A3: 25, 0x050: 10, 0x101: 10}
EPS = {0x067: 10, 0x167: 10, 0x267: 10}
HEADING = {**AI, **VCU, **EPS, 0x43F: 100, 0x363: 10}
TABLE = {**AI, **VCU, **EPS, 0x201: 100, 0x203: 10}

MANUAL, AUTOPILOT = 0x40, 0x80  # 363h byte 7
AI_CAN_LOST = 0x08  # 363h byte 5
P, N, D = 8, 4, 1  # 168h and 0A3h byte 1
THROTTLE_30 = 75  # 075h and 050h byte 1: 0.4 % a count
GEAR_P = bytes([8, 0, 0, 0, 0, 0, 0, 0])
THROTTLE_10 = bytes([25, 0, 0, 0, 0, 0, 0, 0])
AUTOPILOT_OFF = bytes([0, 0, 0, 0, 0x40, 0, 0, 0])  # 43Fh byte 5 bit 7, and a counter
SLACK_S = 0.4  # how long this machine may have other things to do


def gaps_ms(frames):
    return [1000 * (b.at - a.at) for a, b in zip(frames, frames[1:])]


class Sends(canbus.Case):
    def check_period(self, frames, can_id, period_ms):
        mine = canbus.of(frames, can_id)
        right = 1000 * (frames[-1].at - frames[0].at) / period_ms
        self.assertAlmostEqual(len(mine), right, delta=0.03 * right + 1, msg="%03Xh" % can_id)
        self.assertAlmostEqual(statistics.median(gaps_ms(mine)), period_ms, delta=0.05 * period_ms, msg="%03Xh" % can_id)

    def check_ids_and_periods(self, periods, *options):
        bus = self.bus()
        vehicle = self.start("vehicle", "--can", "vcan0", "--manual", *options)
        bus.wait_for(0x0A3)
        frames = bus.listen(3)
        self.assertEqual(vehicle.end(), 0)
        self.assertEqual(set(periods), {frame.id for frame in frames})
        self.assertEqual({(8, 0)}, {(len(frame.data), frame.flags) for frame in frames})
        for can_id, period_ms in periods.items():
            self.check_period(frames, can_id, period_ms)
        return frames

    def check_counters(self, frames, places):
        for can_id, byte in places.items():
            values = [frame.data[byte] for frame in canbus.of(frames, can_id)]
            self.assertEqual(values, [(values[0] + i) % 256 for i in range(len(values))], "%03X" % can_id)

    def test_heading_ids_on_their_periods(self):
        frames = self.check_ids_and_periods(HEADING)
        self.check_counters(frames, {0x43F: 7, 0x363: 7, 0x067: 0})
        self.assertEqual({MANUAL}, {frame.data[6] for frame in canbus.of(frames, 0x363)})
        self.assertEqual({N}, {frame.data[0] for frame in canbus.of(frames, 0x168)})

    def test_table_ids_on_their_periods(self):
        frames = self.check_ids_and_periods(TABLE, "--id-set", "table")
        self.check_counters(frames, {0x201: 7, 0x203: 7, 0x067: 0})


class Drives(canbus.Case):
    def test_engages_drives_off_and_obeys(self):
        bus = self.bus()
        vehicle = self.start("vehicle", "--can", "vcan0")
        begin = bus.wait_for(0x363).at
        engaged = bus.wait_for(0x363, lambda data: data[6] == AUTOPILOT)
        self.assertAlmostEqual(engaged.at - begin, 1.5, delta=SLACK_S)
        bus.wait_for(0x168, lambda data: data[0] == D)
        bus.wait_for(0x075, lambda data: data[0] == THROTTLE_30)
        bus.wait_for(0x0A3, lambda data: data[0] == D)
        bus.wait_for(0x101, lambda data: data[0] > 0)
        vehicle.wait_line(r"^ +1\.\d{3} s  operator +engage .* P manual +0\.00 m/s$")
        vehicle.wait_line(r"vcu +autopilot .* P autopilot ")
        vehicle.wait_line(r"vcu +gear D ")
        vehicle.wait_line(r"vehicle +moves off ")

        # 075h of somebody else is heard, while its own AI computer sends none
        vehicle.say("ai mute message=throttle_command")
        vehicle.wait_line("ai +mute message=throttle_command ")
        bus.wait_for(0x050, lambda data: data[0] == 0)  # 500 ms later
        for _ in range(5):
            bus.send(0x075, THROTTLE_10)
        bus.wait_for(0x050, lambda data: data[0] == THROTTLE_10[0])

        for counter in range(10):
            bus.send(0x43F, AUTOPILOT_OFF[:7] + bytes([counter]))
            bus.send(0x168, GEAR_P)
            bus.listen(0.05)
        bus.wait_for(0x363, lambda data: data[6] == MANUAL)
        bus.wait_for(0x0A3, lambda data: data[0] == P)
        bus.wait_for(0x101, lambda data: data == bytes(8))
        vehicle.wait_line("vcu +manual ")
        vehicle.wait_line("vcu +gear P ")
        vehicle.wait_line("vehicle +stands still ")
        bus.forget()
        self.assertEqual({MANUAL}, {frame.data[6] for frame in canbus.of(bus.listen(0.8), 0x363)})  # no second try
        self.assertEqual(vehicle.end(), 0)

    def test_the_operator_tries_again_while_autopilot_off_is_commanded(self):
        bus = self.bus()
        vehicle = self.start("vehicle", "--can", "vcan0")
        bus.wait_for(0x363)
        counter = 0
        while "engage: refused" not in vehicle.text():
            self.assertLess(counter, 250)
            bus.send(0x43F, AUTOPILOT_OFF[:7] + bytes([counter]))
            counter += 1
            time.sleep(0.05)
        off_until = time.time()
        engaged = bus.wait_for(0x363, lambda data: data[6] == AUTOPILOT)
        self.assertGreater(engaged.at - off_until, 0.2)  # it counts for 300 ms
        vehicle.wait_line("operator +engage: refused, autopilot off is commanded ")
        vehicle.wait_line("operator +engage  ")
        self.assertEqual(vehicle.end(), 0)


class Faults(canbus.Case):
    def test_by_option(self):
        bus = self.bus()
        vehicle = self.start("vehicle", "--can", "vcan0", "--fault", "eps-freeze_counter@2500", "--fault",
                             "ai-stop@2000", "--fault", "eps-set,field=faults,value=08h@2200", "--fault",
                             "ai-start@3500", "--for", "5000")
        frames = [bus.wait_for(0x363)] + bus.listen(5.2)
        begin = frames[0].at
        of_ai = [frame.at - begin for frame in canbus.of(frames, 0x43F)]
        self.assertGreater(len([at for at in of_ai if at < 2 - SLACK_S]), 10)
        self.assertEqual([at for at in of_ai if 2 + SLACK_S < at < 3.5 - SLACK_S], [])
        self.assertGreater(of_ai[-1], 3.5 - SLACK_S)
        lost = [frame.at - begin for frame in canbus.of(frames, 0x363) if frame.data[4] & AI_CAN_LOST]
        self.assertAlmostEqual(lost[0], 2.95, delta=SLACK_S)  # 1 s after the last 43Fh
        faulty = [frame.at - begin for frame in canbus.of(frames, 0x167) if frame.data[7] == 0x08]
        self.assertAlmostEqual(faulty[0], 2.2, delta=SLACK_S)
        frozen = [frame.data[0] for frame in canbus.of(frames, 0x067) if frame.at - begin > 2.5 + SLACK_S]
        self.assertEqual(len(set(frozen)), 1)
        self.assertEqual(vehicle.end(None), 0)
        vehicle.wait_line(r"^ +2\.\d+ s  ai +stop  .* D autopilot ")
        vehicle.wait_line(r"^ +2\.\d+ s  eps +set field=faults value=08h  ")
        vehicle.wait_line(r"^ +[23]\.\d+ s  eps +freeze_counter  ")
        vehicle.wait_line(r"^ +3\.\d+ s  ai +start  ")
        self.assertRegex(vehicle.text(), r"\n5\.\d{3} s; frames: \d{4} sent, 0 refused by the kernel\n\Z")
        self.assertEqual(vehicle.text("stderr"), "")

    def test_typed(self):
        bus = self.bus()
        vehicle = self.start("vehicle", "--can", "vcan0", "--manual")
        bus.wait_for(0x0A3)
        vehicle.say("eps set field=faults value=08h")
        bus.wait_for(0x167, lambda data: data[7] == 0x08)
        vehicle.say("operator press button=1")
        bus.wait_for(0x363, lambda data: data[6] == MANUAL | 0x01)
        vehicle.say("  bus\tsend id=123h bytes=\"01 02\"  ")
        self.assertEqual(bus.wait_for(0x123).data, b"\x01\x02")
        vehicle.say("vcu mute message=gear_status")
        vehicle.wait_line("mute message=gear_status")
        bus.forget()
        self.assertEqual(canbus.of(bus.listen(0.3), 0x0A3), [])
        vehicle.say("ai explode")
        self.assertEqual(vehicle.wait_line("", "stderr"), "host_sim: 'ai explode': ai: unknown action "
                         "'explode'; docs/scenarios.md lists them\n")
        vehicle.say("")
        vehicle.say("status")
        vehicle.wait_line(r"^gear P, manual, 0\.00 m/s, throttle 0 %, steering 0\.0 deg, alarms: EPS_HARDWARE")
        for _ in range(9):
            vehicle.say("bus send message=gear_command bytes=\"08 00\" every_ms=100")
        vehicle.wait_line("8 rogue nodes are already sending", "stderr")
        vehicle.say("quit")
        self.assertEqual(vehicle.end(None), 0)
        self.assertEqual(len(vehicle.lines["stderr"]), 2, vehicle.text("stderr"))

    def test_the_end_of_standard_input_is_not_the_end(self):
        bus = self.bus()
        vehicle = self.start("vehicle", "--can", "vcan0", "--manual")
        vehicle.process.stdin.write("eps set field=faults value=08h")  # a last line without an end
        vehicle.close_stdin()
        bus.wait_for(0x167, lambda data: data[7] == 0x08)
        self.assertGreater(len(canbus.of(bus.listen(0.5), 0x363)), 25)
        self.assertTrue(vehicle.is_running())
        self.assertEqual(vehicle.end(), 0)
        bus.forget()
        self.assertEqual(bus.listen(0.2), [])

    def test_lines_without_end_do_not_stop_the_vehicle(self):
        bus = self.bus()
        with subprocess.Popen(["yes", "vcu run_counter"], stdout=subprocess.PIPE) as lines:
            try:
                vehicle = self.start("vehicle", "--can", "vcan0", "--manual", stdin=lines.stdout)
                bus.wait_for(0x363)
                bus.forget()
                self.assertGreater(len(canbus.of(bus.listen(0.5), 0x363)), 25)
                self.assertEqual(vehicle.end(), 0)
            finally:
                lines.kill()  # it would be waited for

    def test_standard_input_may_be_a_file(self):
        bus = self.bus()
        path = self.folder / "lines"
        path.write_text("eps stop\r\nstatus\n", encoding="ascii")
        with path.open("rb") as lines:
            vehicle = self.start("vehicle", "--can", "vcan0", "--manual", stdin=lines)
            vehicle.wait_line("^gear P, manual, .*, off: eps$")
        bus.forget()
        self.assertEqual(canbus.of(bus.listen(0.3), 0x067), [])
        self.assertEqual((vehicle.end(), vehicle.text("stderr")), (0, ""))


class Sides(canbus.Case):
    def test_in_the_gateway_every_node_is_on_its_side(self):
        vehicle_side, ai_side = self.bus("vcan0"), self.bus("vcan1")
        vehicle = self.start("vehicle", "--can", "vcan0", "--ai-can", "vcan1")
        vehicle_side.wait_for(0x0A3)
        vehicle.say("bus send side=ai id=123h bytes=AA")
        vehicle.say("bus send id=124h bytes=BB")
        self.assertEqual({frame.id for frame in vehicle_side.listen(0.5)}, {*VCU, *EPS, 0x363, 0x124})
        self.assertEqual({frame.id for frame in ai_side.listen(0.1)}, {*AI, 0x43F, 0x123})
        ai_side.send(0x363, bytes([0, 0, 0, 0, 0, 0, AUTOPILOT, 1]))
        ai_side.wait_for(0x168, lambda data: data[0] == D)
        self.assertEqual(vehicle.end(), 0)


class Interfaces(canbus.Case):
    def test_down_up_and_gone(self):
        canbus.ip("link", "set", "dev", "vcan2", "down")
        vehicle = self.start("vehicle", "--can", "vcan2", "--manual")
        vehicle.wait_line("vcan2 +the interface is down ")
        canbus.ip("link", "set", "dev", "vcan2", "up")
        vehicle.wait_line("vcan2 +the interface is up again ")
        self.bus("vcan2").wait_for(0x0A3)
        canbus.ip("link", "set", "dev", "vcan2", "down")
        vehicle.wait_line("vcan2 +the interface is down ")
        canbus.ip("link", "del", "dev", "vcan2")
        try:
            self.assertEqual(vehicle.end(None), 2)
        finally:
            canbus.ip("link", "add", "dev", "vcan2", "type", "vcan")
            canbus.ip("link", "set", "dev", "vcan2", "up")
        self.assertEqual(vehicle.text("stderr"), "host_sim: vcan2: the interface is gone\n")
        self.assertRegex(vehicle.text(), r" sent, [1-9]\d* refused by the kernel\n\Z")


if __name__ == "__main__":
    unittest.main()
