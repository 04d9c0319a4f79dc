"""`host_sim recorder`: what a device's flight recorder kept, in each form in which it leaves the device."""
import json
import os
import re
import struct
import unittest
import zlib

import hostsim
import traffic
from traffic import byte, edit_payload, stop

EVENT = 112    # bytes of agv_event_t (firmware/include/agv/recorder.h)
EVENTS = 256   # of the ring at the end of agv_recorder_t


def trip_log():
    return traffic.log(traffic.frames(6000, engage_ms=1000, edit=stop(("steering_command",), 3000, 4000)))


class Recorder(hostsim.Case):
    def setUp(self):
        super().setUp()
        self.write("my.log", trip_log())
        self.run_good("replay", "--store", "store", "--why", "replay.json", "my.log")
        line = next(line for line in self.read("store").splitlines() if line.startswith("recorder "))
        self.image = bytes.fromhex(line.split()[1])
        ring = self.image[-EVENT * EVENTS:]
        events = [ring[at:at + EVENT] for at in range(0, len(ring), EVENT)]
        self.events = [event for event in events if event[8]]  # the kind
        self.assertEqual(len(self.events), 10)
        self.version = []

    def dump(self):
        """What a terminal shows of `agv dump`."""
        lines = ["uart:~$ agv dump"] + self.version + ["agv-event " + event.hex() for event in self.events]
        return "\r\n".join(lines + ["0 events from flash, 10 from RAM; log in flash: ready", "uart:~$ "])

    def recorder(self, content, *arguments):
        self.write("dump", content)
        result = self.run_good("recorder", *arguments, "dump", env=dict(os.environ, TZ="UTC"))
        return result.stdout

    def test_the_text_says_what_happened_and_why(self):
        text = self.recorder(self.dump())
        self.assertEqual(text.splitlines()[:2], ["dump: 10 events of run 0",
                                                 "run 0       10 events, 0.000 s to 4.007 s of its clock"])
        for line in ("tripped     at 3.107 s: STEERING_COMMAND_TIMEOUT",
                     "  why       065h steering_command was silent: last at 2.981 s, deadline 125 ms",
                     "  then      safe state not confirmed",
                     "faults      STEERING_COMMAND_TIMEOUT  trip  3.107 s   1 time   0.900 s",
                     "            SAFE_STATE_UNCONFIRMED    trip  3.607 s   1 time   0.400 s  active at the end"):
            self.assertIn(line + "\n", text)
        self.assertRegex(text, r"3\.107 s +supervisor +=> TRIPPED: STEERING_COMMAND_TIMEOUT +D autopilot 0\.40 m/s\n")

    def test_every_form_tells_the_same(self):
        as_dump = self.recorder(self.dump())
        noise = os.urandom(333)
        for form in (b"".join(self.events), self.image, noise + b"".join(reversed(self.events)) + noise,
                     "\n".join(event.hex().upper() for event in self.events),
                     "\n".join("agv-event " + event.hex() for event in self.events + self.events[:3]),
                     self.read("store")):
            self.assertEqual(self.recorder(form), as_dump)
        again = self.run_good("recorder", "-", stdin=self.dump().encode("ascii")).stdout
        self.assertEqual(again.replace("standard input: ", "dump: ", 1), as_dump)
        stored = self.run_good("recorder", "-", stdin=self.read("store").encode("ascii")).stdout
        self.assertEqual(stored.replace("standard input: ", "dump: ", 1), as_dump)
        why = self.run_good("recorder", "--why", "-", "-", stdin=self.dump().encode("ascii")).stdout
        self.assertEqual(json.loads(why)["log"], "standard input")

    def test_a_single_event(self):
        lines = self.recorder(self.events[0]).splitlines()
        self.assertTrue(lines[0].startswith("dump: 1 event of run 0"), lines)
        self.assertTrue(lines[1].startswith("run 0       1 event, 0.000 s to 0.000 s"), lines)

    def test_why_is_that_of_the_replay(self):
        found = json.loads(self.recorder(self.dump(), "--why", "-"))
        replayed = json.loads(self.read("replay.json"))
        self.assertEqual(set(found), set(replayed))
        same = ("t_ms", "reason", "kind", "message", "id", "cause_ms", "last_good_ms", "limit", "unit")
        self.assertEqual([[trip[key] for key in same] for trip in found["trips"]],
                         [[trip[key] for key in same] for trip in replayed["trips"]])
        self.assertEqual(found["trips"][0]["evidence"],
                         [{"t_ms": None, "if": None, "id": "065", "data": "2823000000000000"}])

    def test_faults_of_other_kinds(self):
        cases = (("eps_status", 7, 0x40, ("EPS_MOTOR_ENCODER", "bit", "eps_status", 3003)),
                 ("eps_status", 3, 0x07, ("EPS_MODE_INVALID", "score", "eps_status", 3003)),
                 ("throttle_command", 0, 251, ("AI_COMMAND_OUT_OF_RANGE", "value", "throttle_command", 3008)),
                 ("throttle_status", 0, 100, ("THROTTLE_DEVIATION", "budget", "throttle_status", 3001)),
                 ("vehicle_status", 6, 0xC0, ("MODE_INVALID", "mode", "vehicle_status", 3001)))
        for message, at, value, expected in cases:
            edit = edit_payload(message, 3000, byte(at, value))
            self.write("x.log", traffic.log(traffic.frames(4000, engage_ms=1000, edit=edit)))
            self.run_good("replay", "--store", expected[0], "x.log")
            trip = json.loads(self.run_good("recorder", "--why", "-", expected[0]).stdout)["trips"][0]
            self.assertEqual((trip["reason"], trip["kind"], trip["message"], trip["cause_ms"]), expected)

    def test_a_cause_whose_time_the_recorder_does_not_know(self):
        def edit(frame):
            if frame.name == "vehicle_status" and 1500 <= frame.t_ms < 3500:
                frame.data = frame.data[:6] + bytes([0x40 if frame.t_ms // 250 % 2 else 0x80]) + frame.data[7:]
            return frame
        self.write("x.log", traffic.log(traffic.frames(4000, engage_ms=1000, edit=edit)))
        self.run_good("replay", "--store", "flapping", "x.log")
        text = " ".join(self.run_good("recorder", "flapping").stdout.split())
        self.assertIn("why 363h vehicle_status changed the mode too often (more than three engagements in 5000 ms, "
                      "or manual that flickered while engaged) then ", text)

    def test_runs(self):
        self.write("short.log", traffic.log(traffic.frames(300)))
        self.run_good("replay", "--store", "store", "--reset-cause", "watchdog", "short.log")
        text = self.run_good("recorder", "store").stdout
        self.assertIn(" of runs 0, 1\n", text)
        self.assertIn("run 0  ", text)  # run 1 only continues its trip
        self.assertIn("tripped     at 3.107 s", text)
        self.assertIn("tripped     at 0.000 s: STEERING_COMMAND_TIMEOUT",
                      self.run_good("recorder", "--run", "1", "store").stdout)
        self.assert_refused(self.run_program("recorder", "--run", "7", "store"), "no event of run 7")

    def test_how_the_run_before_ended(self):
        sequence, time_ms = struct.unpack_from("<II", self.events[-1])
        crash = struct.pack("<II4B", sequence + 1, time_ms + 1, 6, 3, 4, 0) + bytes(2) + self.events[-1][14:16]
        crash += bytes(4) + struct.pack("<II", 0x08001234, 0x08005679) + bytes(80) + bytes([self.events[-1][108], 0])
        crash += struct.pack("<H", (zlib.crc32(crash) ^ 0xFFFFFFFF) >> 16)
        self.events.append(crash)
        text = self.recorder(self.dump(), "--events", "e.jsonl")
        self.assertRegex(text, r"4\.008 s +supervisor +run before: reset by lock-up, stack overflow, PC 08001234, LR 08005679\n")
        self.assertEqual(json.loads(self.read("e.jsonl").splitlines()[-1]),
                         {"t_ms": 4008, "event": "crash", "cause": "lock-up", "end": "stack overflow",
                          "pc": "08001234", "lr": "08005679"})

    def test_the_device_is_named(self):
        checksum = re.search("Checksum: ([0-9A-F]{8})", self.run_good("config").stdout)[1].lower()
        self.version = [f"agv-version 0.1.0+0123456789ab, configuration {checksum}"]
        lines = self.recorder(self.dump()).splitlines()
        self.assertEqual(lines[1], "device      0.1.0+0123456789ab, configuration " + checksum)
        self.assertTrue(lines[2].startswith("run 0 "))
        self.version = ["\x1b[mgarbage agv-version 9 \x07 bell"]
        self.assertIn("\ndevice      9 \nrun 0 ", self.recorder(self.dump()))
        self.version = ["agv-version " + "x" * 500 + ", configuration 12345678"]
        self.assertIn("\ndevice      " + "x" * 119 + "\nrun 0 ", self.recorder(self.dump()))
        self.version = ["agv-version 1.0.0+unknown, configuration 12345678"]
        lines = self.recorder(self.dump()).splitlines()
        self.assertEqual(lines[2], f"            read with configuration {checksum}: --config should name the device's own one")

    def test_a_damaged_event_is_counted(self):
        damaged = bytearray(self.events[3])
        damaged[20] ^= 1
        self.events[3] = bytes(damaged)
        self.assertTrue(self.recorder(self.dump()).startswith("dump: 9 events (1 more is damaged) of run 0\n"))

    def test_a_ring_that_was_overwritten(self):
        self.events = self.events[4:]
        self.assertIn("of its clock; its start was overwritten\n", self.recorder(self.dump()))

    def test_events_that_were_left_out_are_counted(self):
        def edit(frame):  # on and off 20 times in 2 s, and once more 1 s later: 4 events a second are kept
            is_flapping = 3000 <= frame.t_ms < 5000 and frame.t_ms % 100 < 50
            if frame.name == "vehicle_status" and (is_flapping or 6000 <= frame.t_ms < 6050):
                frame.data = frame.data[:5] + b"\x01" + frame.data[6:]
            return frame
        self.write("x.log", traffic.log(traffic.frames(7000, engage_ms=1000, edit=edit)))
        self.run_good("replay", "--store", "flapping", "x.log")
        self.assertIn("  5 times   0.250 s  32 more events left out\n", self.run_good("recorder", "flapping").stdout)

    def test_the_report_the_trace_and_the_events(self):
        self.recorder(self.dump(), "--report", "r.html", "--trace", "t.json", "--events", "e.jsonl")
        self.assertIn("STEERING_COMMAND_TIMEOUT", self.read("r.html"))
        self.assertIn({"t_ms": 3107, "event": "state", "from": "ACTIVE", "to": "TRIPPED",
                       "reason": "STEERING_COMMAND_TIMEOUT"},
                      [json.loads(line) for line in self.read("e.jsonl").splitlines()])
        self.assertGreater(len(json.loads(self.read("t.json"))["traceEvents"]), 10)

    def test_what_is_no_flight_recorder_is_refused(self):
        for content in (b"", b"hello\n", os.urandom(5000), bytes(200000), trip_log().encode("ascii")):
            self.write("dump", content)
            self.assert_refused(self.run_program("recorder", "--why", "w", "dump"), "dump: contains no flight recorder event")
        self.assertNotIn("w", self.files())
        self.assert_refused(self.run_program("recorder", "missing"), "missing: No such file")
        self.assert_refused(self.run_program("recorder", "."), "Is a directory")
        self.assert_refused(self.run_program("recorder", "--why", "store", "store"), "are the same file")
        self.assert_refused(self.run_program("recorder", "/dev/zero", timeout=60), "16 MiB")


if __name__ == "__main__":
    unittest.main()
