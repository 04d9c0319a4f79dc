"""host_sim monitor on a virtual bus: a flood, keys, an interface that goes away, recording; the screen of run and vehicle.

Bytes are written out from docs/protocol.md.
"""
import re
import signal
import subprocess
import threading
import time
import unittest

import canbus

FLOOD = 8000  # frames a second
KEY_S = 0.1
CPU = 0.10  # of a core


def seconds_used(number):
    """Processor time of a process, exact to the nanosecond: /proc/PID/stat counts ticks that find it running."""
    with open("/proc/%d/schedstat" % number, encoding="ascii") as file:
        return int(file.read().split()[0]) / 1e9


class Flood(threading.Thread):
    """Sends 8,000 frames a second: a healthy vehicle's identifiers among others."""

    IDS = [0x363, 0x067, 0x167, 0x267, 0x101, 0x050] + list(range(0x500, 0x50A))

    def __init__(self, bus):
        super().__init__()
        self.bus = bus
        self.sent = 0
        self.goes_on = True

    def run(self):
        begin = time.monotonic()
        while self.goes_on:
            due = int((time.monotonic() - begin) * FLOOD)
            for _ in range(min(due - self.sent, 200)):
                can_id = self.IDS[self.sent % len(self.IDS)]
                counter = (self.sent // len(self.IDS)) % 256
                self.bus.send(can_id, bytes([counter if can_id == 0x067 else 0, 100, 0x28, 0x23, 0, 0, 0x40, counter]))
                self.sent += 1
            time.sleep(0.005)


class Case(canbus.Case):
    def flood(self):
        flood = Flood(self.bus())
        flood.start()

        def stop():
            flood.goes_on = False
            flood.join()

        self.addCleanup(stop)
        return flood

    def say_until(self, monitor, bus, can_id, data, expression):
        """Send a frame until the monitor, which may just be starting, prints this."""
        for _ in range(100):
            bus.send(can_id, data)
            try:
                return monitor.wait_line(expression, timeout=0.2)
            except AssertionError:
                pass
        raise AssertionError("no %r but:\n%s" % (expression, monitor.text()))


class InAFlood(Case):
    """When another program takes the processor, it is measured again (canbus.Case)."""

    def test_processor_time_and_keys_on_80_by_24(self):
        self.measure(80, 24)

    def test_processor_time_and_keys_on_160_by_50(self):
        self.measure(160, 50)

    def measure(self, width, height):
        flood, terminal = self.flood(), self.terminal("monitor", "--can", "vcan0", width=width, height=height)
        terminal.wait_for(rb"INIT")
        begin, used, sent = time.monotonic(), seconds_used(terminal.process.pid), flood.sent
        while time.monotonic() < begin + 10:
            terminal.read(0.1)
        took = time.monotonic() - begin
        used = seconds_used(terminal.process.pid) - used
        rate = (flood.sent - sent) / took
        answers = []
        for expected in [rb"back", rb"help"] * 5:
            time.sleep(0.13)
            pressed = time.monotonic()
            terminal.press(b"h")
            answers.append(terminal.wait_for(expected) - pressed)
        print("\n%d frames/s: %.1f %% of a core; keys answered within %.0f ms" % (rate, 100 * used / took, 1000 * max(answers)))
        self.assertGreater(rate, 0.9 * FLOOD)
        self.at_most(CPU * took, used, "the monitor's work of %.0f s" % took)
        self.at_most(KEY_S, max(answers), "the answer to a key")
        terminal.press(b"q")
        self.assertEqual(terminal.end(), (0, ""))
        self.assertEqual(re.findall(rb"[^\x1b]*lost[^\x1b]*", terminal.written), [])


class Interface(Case):
    def test_it_goes_down_and_is_removed_and_comes_back(self):
        canbus.ip("link", "add", "dev", "vcan9", "type", "vcan")
        self.addCleanup(subprocess.run, ["ip", "link", "delete", "vcan9"], stderr=subprocess.DEVNULL, check=False)
        canbus.ip("link", "set", "vcan9", "up")
        monitor = self.start("monitor", "--can", "vcan9")
        self.say_until(monitor, self.bus("vcan9"), 0x123, [1], "vcan9 +123h received, no message of the protocol")
        canbus.ip("link", "set", "vcan9", "down")
        monitor.wait_line("vcan9 .*the interface is down")
        canbus.ip("link", "set", "vcan9", "up")
        monitor.wait_line("vcan9 .*the interface is up again")
        self.bus("vcan9").send(0x168, [8, 0, 0, 0, 0, 0, 0, 0])
        monitor.wait_line("168h gear_command silent: no frame for 350 ms")
        canbus.ip("link", "delete", "vcan9")
        monitor.wait_line("vcan9 .*the interface is down")
        canbus.ip("link", "add", "dev", "vcan9", "type", "vcan")
        canbus.ip("link", "set", "vcan9", "up")
        monitor.wait_line("vcan9 .*the interface is up again")
        self.bus("vcan9").send(0x168, [8, 0, 0, 0, 0, 0, 0, 0])
        monitor.wait_line("168h gear_command back after")
        self.assertEqual((monitor.end(), monitor.text("stderr")), (0, ""))


class Record(Case):
    def test_a_recording_holds_every_frame_and_is_readable(self):
        path = self.folder / "new.log"
        monitor = self.start("monitor", "--can", "vcan0", "--record", path)
        bus = self.bus()
        self.say_until(monitor, bus, 0x7FF, [1], "7FFh received")
        bus.send(0x168, [8, 0, 0, 0, 0, 0, 0, 0])
        bus.send(0x1ABCDE, [1, 2, 3], flags=canbus.socket.CAN_EFF_FLAG)
        bus.send(0x168, [], flags=canbus.socket.CAN_RTR_FLAG)
        monitor.wait_line("168h in another form")
        self.assertEqual(monitor.end(), 0)
        lines = path.read_text(encoding="ascii").splitlines()
        lines = [line for line, after in zip(lines, lines[1:] + [""]) if line[20:] != after[20:]]  # 7FFh may be there twice
        self.assertEqual([line.split(" ", 1)[1] for line in lines],
                         ["vcan0 7FF#01", "vcan0 168#0800000000000000", "vcan0 001ABCDE#010203", "vcan0 168#R0"])
        self.assertRegex(lines[0], r"^\(\d{10}\.\d{6}\) ")
        status, _, errors = self.run_to_end("replay", path)
        self.assertEqual((status, errors), (0, ""))

    def test_it_sends_nothing(self):
        bus = self.bus()
        monitor = self.start("monitor", "--can", "vcan0", "--shadow")
        monitor.wait_line("shadow +INIT")
        bus.send(0x363, [0, 0, 0, 0, 0, 0, 0x40, 1])
        monitor.wait_line("363h vehicle_status late")
        self.assertEqual(bus.listen(1), [])
        self.assertEqual(monitor.end(), 0)


class Gateway(Case):
    def test_both_sides_are_heard_and_nothing_is_sent(self):
        vehicle, ai = self.bus("vcan0"), self.bus("vcan1")
        monitor = self.start("monitor", "--can", "vcan0", "--ai-can", "vcan1", "--shadow")
        self.say_until(monitor, vehicle, 0x123, [1], "vcan0 +123h received, no message of the protocol")
        ai.send(0x124, [1])
        monitor.wait_line("vcan1 +124h received, no message of the protocol")
        vehicle.send(0x363, [0, 0, 0, 0, 0, 0, 0x40, 1])  # a gateway that sends would pass it on
        ai.send(0x168, [8, 0, 0, 0, 0, 0, 0, 0])
        monitor.wait_line("363h vehicle_status late")
        monitor.wait_line("ai +168h gear_command silent: no frame for 350 ms")
        vehicle.send(0x168, [8, 0, 0, 0, 0, 0, 0, 0])  # on the AI side it would be a command
        monitor.wait_line("shadow .*FOREIGN_COMMAND_SENDER")
        self.assertEqual((vehicle.listen(1), ai.listen(1)), ([], []))
        self.assertEqual((monitor.end(), monitor.text("stderr")),
                         (0, "host_sim: not the default: topology: gateway (default shared)\n"))


class StatusFrame(Case):
    def test_the_state_comes_from_it_and_from_a_shadow_without_it(self):
        monitor = self.start("monitor", "--can", "vcan0")
        monitor.wait_line("supervisor +no status frame: a supervisor in this program listens")
        monitor.wait_line("shadow +INIT")
        node = self.start("run", "--can", "vcan0")
        monitor.wait_line("supervisor +its status frame 7F0h is received")
        monitor.wait_line("supervisor +INIT$")
        self.assertEqual(node.end(), 0)
        monitor.wait_line("supervisor +no status frame any more: a supervisor in this program listens")
        monitor.wait_line("shadow +INIT")
        self.assertEqual(monitor.end(signal.SIGINT), 0)


class ScreenOfANode(Case):
    def test_run(self):
        terminal = self.terminal("run", "--can", "vcan0", "--screen", width=100)
        terminal.wait_for(rb"host_sim run")
        terminal.wait_for(rb"output open")
        terminal.wait_for(rb"frames/s")
        terminal.press(b"q")
        self.assertEqual(terminal.end(), (0, ""))
        self.assertRegex(terminal.seen, rb"final state: INIT, first reason: none")

    def test_vehicle_takes_typed_lines(self):
        bus = self.bus()
        terminal = self.terminal("vehicle", "--can", "vcan0", "--screen", "--manual", width=100)
        terminal.wait_for(rb"host_sim vehicle")
        bus.wait_for(0x168)
        terminal.press(b":ai stop\r")
        terminal.wait_for(rb"silent: no frame for 350 ms")
        terminal.press(b":quit\r")
        self.assertEqual(terminal.end(), (0, ""))
        self.assertRegex(terminal.seen, rb"frames: \d+ sent")

    def test_where_there_is_no_terminal_it_is_as_without(self):
        status, output, errors = self.run_to_end("run", "--can", "vcan0", "--screen", "--for", "300")
        self.assertEqual((status, errors), (0, ""))
        self.assertRegex(output, r"^vcan0: 0\.\d{3} s\n")


if __name__ == "__main__":
    unittest.main()
