"""`host_sim scenario --from LOG`: the file passes as it was made, and trips for the reason of the log."""
import os
import unittest

import hostsim
import traffic
from traffic import AI, EPS, VCU, byte, edit_payload, stop


def log(edit=None, engage_ms=1000, duration_ms=4000, **options):
    return traffic.log(traffic.frames(duration_ms, engage_ms=engage_ms, edit=edit, **options))


def turn(data):
    data[0:2] = (9600).to_bytes(2, "little")


def foreign(frame):
    """A gear command on the side of the vehicle, which no AI computer sends there."""
    if frame.name == "gear_status" and 2000 <= frame.t_ms < 2020:
        return [frame, traffic.Frame(frame.t_us + 500, "foreign", 0x168, bytes([2] + [0] * 7), "can0")]
    return frame


def short(name):
    """One of these commands has seven bytes."""
    def edit(frame):
        if frame.name == name and 2000 <= frame.t_ms < 2020:
            return [traffic.Frame(frame.t_us, frame.name, frame.can_id, bytes(7), frame.interface)]
        return frame
    return edit


# What is in the log: reason, log, options, and the step that stands in the file for it.
LOGS = {
    "the VCU dies": ("VCU_HEARTBEAT_LOST", log(stop(VCU, 2001)), (), "at_ms: 2001, vcu: stop}"),
    "the EPS dies": ("EPS_HEARTBEAT_LOST", log(stop(EPS, 2001)), (), "eps: stop}"),
    "the AI computer dies": ("STEERING_COMMAND_TIMEOUT", log(stop(AI, 2001)), (), "ai: stop}"),
    "a message stops": ("EPS_STATUS_TIMEOUT", log(stop(("eps_status",), 2001)), (), "eps: mute, message: eps_status}"),
    "the AI computer was never there": ("STEERING_COMMAND_TIMEOUT", log(stop(AI, 0)), (), "at_ms: 0, ai: stop}"),
    "a heartbeat never came": ("AI_HEARTBEAT_LOST", log(stop(("turn_signal_command",), 0)), (),
                               "at_ms: 0, ai: mute, message: turn_signal_command}"),
    "a heartbeat stops before the engagement": ("AI_HEARTBEAT_LOST", log(stop(("turn_signal_command",), 400)), (),
                                                "at_ms: 308, ai: mute, message: turn_signal_command}"),
    "a heartbeat stops right before the engagement": ("AI_HEARTBEAT_LOST", log(stop(("turn_signal_command",), 900)), (),
                                                      "at_ms: 808, ai: mute, message: turn_signal_command}"),
    "the AI computer dies before the engagement": ("AI_HEARTBEAT_LOST", log(stop(AI, 600)), (), "ai: stop}"),
    "a command stops before the engagement": ("GEAR_COMMAND_TIMEOUT", log(stop(("gear_command",), 600)), (),
                                              "ai: mute, message: gear_command}"),
    "a counter stops before the engagement": ("AI_HEARTBEAT_STUCK", log(edit_payload("turn_signal_command", 400, byte(7, 7))),
                                              (), "ai: freeze_counter}"),
    "a command stops": ("GEAR_COMMAND_TIMEOUT", log(stop(("gear_command",), 2001)), (), "ai: mute, message: gear_command}"),
    "a counter stops": ("EPS_HEARTBEAT_STUCK", log(edit_payload("steering_status", 2010, byte(0, 7))),
                        (), "eps: freeze_counter}"),
    "a fault bit": ("EPS_MOTOR_ENCODER", log(edit_payload("eps_status", 2000, byte(7, 0x40))),
                    (), "eps: set, field: faults, value: 40h}"),
    "bad supply": ("EPS_UNDER_VOLTAGE", log(edit_payload("eps_status", 2000, byte(7, 1))),
                   (), "eps: set, field: faults, value: 01h}"),
    "an alarm of the VCU in manual": ("REMOTE_SIGNAL_LOST", log(edit_payload("vehicle_status", 2000, byte(4, 1)), None), (),
                                      "vcu: set, field: alarms, value: 01h}"),
    "an EPS mode that is none": ("EPS_MODE_INVALID", log(edit_payload("eps_status", 2000, byte(3, 7))),
                                 (), "eps: set, field: mode, value: 07h}"),
    "a command of another length": ("AI_COMMAND_OUT_OF_RANGE", log(short("steering_command")), (),
                                    'bus: send, id: 065h, bytes: "00 00 00 00 00 00 00"}'),
    "a gear that is none": ("AI_COMMAND_OUT_OF_RANGE", log(edit_payload("gear_command", 2000, byte(0, 3))),
                            (), "ai: set, field: gear, value: 03h}"),
    "a throttle that is none": ("THROTTLE_STATUS_INVALID", log(edit_payload("throttle_status", 2000, byte(0, 0xFB))), (),
                                "vcu: set, field: throttle, value: FBh}"),
    "the steering does not follow": ("STEERING_DEVIATION", log(edit_payload("steering_command", 2000, turn)),
                                     (), "eps: stick}"),
    "both modes at once": ("MODE_INVALID", log(edit_payload("vehicle_status", 2000, byte(6, 0xC0))),
                           (), "vcu: set, field: mode_bits, value: 3h}"),
    "the wrong gear": ("GEAR_DEVIATION", log(edit_payload("gear_status", 2000, byte(0, 2)), duration_ms=6000),
                       (), "vcu: set, field: gear"),
    "a stranger in the gateway": ("FOREIGN_COMMAND_SENDER", log(foreign, ai_interface="can1"),
                                  ("--topology", "gateway", "--ai-if", "can1"), "bus: send, id: 168h"),
    "the other ID set": ("STEERING_COMMAND_TIMEOUT", log(stop(AI, 2001), ids=traffic.TABLE_IDS),
                         ("--id-set", "table"), "ai: stop}"),
    "a warning made a trip": ("EPS_TEMP_ABOVE_110", log(edit_payload("eps_status", 2000, byte(7, 0x10))),
                              ("--config", "c.yaml"), "eps: set, field: faults, value: 10h}"),
    "a fault after a minute and more": ("EPS_MOTOR_ENCODER",
                                        log(edit_payload("eps_status", 90000, byte(7, 0x40)), duration_ms=91000), (),
                                        "eps: set, field: faults, value: 40h}"),
}
CONFIG = "class_eps_temp_above_110: trip\neps_status_timeout_ms: 60\n"


class Skeleton(hostsim.Case):
    def trips(self, *arguments):
        """The reason of the first trip, by the events of a command."""
        return self.run_good(*arguments, "--events", "events.jsonl").trips()[0][1]

    def check(self, reason, path, options, step):
        self.write("c.yaml", CONFIG)
        self.assertEqual(self.trips("replay", *options, path), reason)
        result = self.run_good("scenario", "--from", path, *options, "-o", "made.yaml")
        self.assertEqual(result.stdout, "")
        text = self.read("made.yaml")
        self.assertIn(step, text)
        self.assertRegex(text, f"reason: {reason}, after: (fault|engages), within: ")
        self.assertEqual(self.trips("scenario", "made.yaml"), reason)  # which also passes
        (self.folder / "made.yaml").unlink()
        return text

    def test_logs_of_every_kind(self):
        for name, (reason, content, options, step) in LOGS.items():
            with self.subTest(name):
                self.write("my.log", content)
                text = self.check(reason, "my.log", options, step)
                self.assertNotIn("more trip", text)  # what a recording cannot obey is none, as replay says

    def test_what_it_says_of_a_long_log_and_of_more_trips(self):
        def edit(frame):
            if frame.name == "vehicle_status":
                data = bytearray(frame.data)
                data[4] = 0x01 if frame.t_ms % 4000 >= 3900 else 0
                data[6] |= traffic.BUTTON_1 if 1000 <= frame.t_ms % 4000 < 2500 else 0
                frame.data = bytes(data)
            return frame

        self.write("my.log", log(edit, engage_ms=None, duration_ms=12000))
        text = self.check("REMOTE_SIGNAL_LOST", "my.log", (), "{name: fault, at_ms: 3900, ")
        self.assertIn("  It has 2 more trips, which are not shown here.\n", text)
        self.write("my.log", LOGS["a fault after a minute and more"][1])
        text = self.check("EPS_MOTOR_ENCODER", "my.log", (), "name: fault, at_ms: 11000, ")
        self.assertIn("  The log is longer: the time before the fault was cut.\n", text)

    def test_a_log_with_an_odd_name(self):
        self.write('#1: "my" log', LOGS["the EPS dies"][1])
        self.check("EPS_HEARTBEAT_LOST", '#1: "my" log', (), "eps: stop}")

    def test_logs_without_a_trip(self):
        def refused(content, *options):
            self.write("my.log", content)
            result = self.run_program("scenario", "--from", "my.log", "-o", "made.yaml", *options)
            self.assertEqual((result.status, result.stdout, "made.yaml" in self.files()), (1, "", False))
            return result.stderr

        self.assertEqual(refused(log()), "host_sim: my.log: no fault to replay: the supervisor did not trip\n")
        self.assertEqual(refused(log(engage_ms=0)), "host_sim: my.log: no fault to replay: nothing was supervised; host_sim "
                                                    "replay says why\n")


if __name__ == "__main__":
    os.environ.setdefault("HOST_SIM", "build/host/bin/host_sim")
    unittest.main()
