#!/usr/bin/python3
"""A supervisor with only the compared rules, written with python-can as usual. Not for a vehicle.

It implements the deadlines and alive counters, the EPS faults, the latched safe commands on their cycles, the override of
other senders' commands, and the reset. It blocks in recv until the next frame or the next deadline, and never sleeps. It
prints its state to standard output as `host_sim run --events -` does, and the number of received frames on SIGUSR1 and
SIGTERM.
"""
import argparse
import json
import signal
import sys
import time

import can

TURN_SIGNAL, GEAR, THROTTLE, STEERING = 0x43F, 0x168, 0x075, 0x065
VEHICLE_STATUS, GEAR_STATUS, THROTTLE_STATUS = 0x363, 0x0A3, 0x050
STEERING_STATUS, EPS_STATUS, WHEEL_SPEED = 0x067, 0x167, 0x101

ALWAYS = {VEHICLE_STATUS: 0.050, STEERING_STATUS: 0.050, EPS_STATUS: 0.060, THROTTLE_STATUS: 0.060, WHEEL_SPEED: 0.060,
          GEAR_STATUS: 0.125}
ENGAGED = {TURN_SIGNAL: 0.350, GEAR: 0.350, THROTTLE: 0.350, STEERING: 0.125}
TIMEOUTS = {**ALWAYS, **ENGAGED}
COUNTER_BYTE = {VEHICLE_STATUS: 7, STEERING_STATUS: 0, TURN_SIGNAL: 7}

EPS_FAULTS_AT_ONCE, EPS_FAULTS_COUNTED, EPS_FRAMES = 0xE8, 0x07, 3
MANUAL, AUTOPILOT, BUTTON_1, GEAR_P = 0x40, 0x80, 0x01, 8

SAFE = {THROTTLE: bytes(8), GEAR: bytes([GEAR_P]) + bytes(7), TURN_SIGNAL: bytes([0, 0, 0, 0, 0x70, 0, 0])}
FIRST_CYCLE = {THROTTLE: 0.033, GEAR: 0.066, TURN_SIGNAL: 0.100}
CYCLE, OVERRIDE_GAP = 0.100, 0.005
READY = "ready"


class Supervisor:
    """`due` contains the times of all next events: deadlines of messages, cycles of safe commands, the end of INIT."""

    def __init__(self, bus, init_hold, reset_hold):
        self.bus = bus
        self.init_hold = init_hold
        self.reset_hold = reset_hold
        self.received = 0
        self.counters = {}
        self.sent_at = dict.fromkeys(SAFE, 0.0)
        self.alive_counter = 0
        self.mode = self.gear = None
        self.released = False
        self.pressed_at = None
        self.faulty_frames = 0
        self.state = None
        self.handlers = {VEHICLE_STATUS: self.on_vehicle_status, GEAR_STATUS: self.on_gear_status,
                         EPS_STATUS: self.on_eps_status}
        self.become("INIT", None)
        now = time.monotonic()
        self.due = {READY: now + self.init_hold}
        self.watch(ALWAYS, now)
        self.send_safe(now)

    def become(self, state, reason):
        print(json.dumps({"event": "state", "from": self.state, "to": state, "reason": reason}), flush=True)
        self.state = state

    def run(self):
        while True:
            message = self.bus.recv(max(0.0, min(self.due.values()) - time.monotonic()))
            now = time.monotonic()
            if message is not None:
                self.on_message(message.arbitration_id, message.data, now)
            if now >= min(self.due.values()):
                self.on_time(now)

    def watch(self, timeouts, now):
        self.due.update({can_id: now + timeout for can_id, timeout in timeouts.items()})

    def on_message(self, can_id, data, now):
        self.received += 1
        if len(data) != 8:
            return
        byte = COUNTER_BYTE.get(can_id)
        if byte is None or self.has_changed(can_id, data[byte]):
            if can_id in self.due and can_id in TIMEOUTS and not self.sends(can_id):
                self.due[can_id] = now + TIMEOUTS[can_id]
        handler = self.handlers.get(can_id)
        if handler:
            handler(data, now)
        elif self.sends(can_id) and data[:7] != SAFE[can_id][:7] and now - self.sent_at[can_id] >= OVERRIDE_GAP:
            self.send(can_id, now)
            self.due[can_id] = now + CYCLE / 2

    def has_changed(self, can_id, counter):
        last, self.counters[can_id] = self.counters.get(can_id, counter), counter
        return counter != last

    def sends(self, can_id):
        return self.state in ("INIT", "TRIPPED") and can_id in SAFE

    def on_vehicle_status(self, data, now):
        self.mode = data[6] & (MANUAL | AUTOPILOT)
        if self.state == "INIT" and self.mode != MANUAL:
            self.due[READY] = now + self.init_hold
        elif self.state == "STANDBY" and self.mode == AUTOPILOT:
            self.watch(ENGAGED, now)
            self.become("ACTIVE", None)
        elif self.state == "ACTIVE" and self.mode != AUTOPILOT:
            self.stand_by(now)
        elif self.state == "TRIPPED":
            self.on_button(bool(data[6] & BUTTON_1), now)

    def on_button(self, pressed, now):
        self.released = self.released or not pressed
        if not (pressed and self.released and self.mode == MANUAL and self.gear == GEAR_P):
            self.pressed_at = None
        elif self.pressed_at is None:
            self.pressed_at = now
        elif now - self.pressed_at >= self.reset_hold:
            self.stand_by(now)

    def stand_by(self, now):
        self.due = {}
        self.watch(ALWAYS, now)
        self.become("STANDBY", None)

    def on_gear_status(self, data, _now):
        self.gear = data[0]

    def on_eps_status(self, data, now):
        faults = data[7]
        self.faulty_frames = self.faulty_frames + 1 if faults & EPS_FAULTS_COUNTED else 0
        if faults & EPS_FAULTS_AT_ONCE or self.faulty_frames >= EPS_FRAMES:
            self.trip("EPS_FAULT", now)

    def on_time(self, now):
        for key in [key for key, moment in self.due.items() if moment <= now]:
            if key == READY:
                self.stand_by(now)
                return
            if self.sends(key):
                self.send(key, now)
                self.due[key] = now + CYCLE
            elif key in self.due:
                self.due[key] = now + TIMEOUTS[key]
                self.trip("TIMEOUT_%03X" % key, now)

    def trip(self, reason, now):
        if self.state == "INIT":
            self.due[READY] = now + self.init_hold
        elif self.state != "TRIPPED":
            self.released, self.pressed_at = False, None
            self.due = {}
            self.send_safe(now)
            self.become("TRIPPED", reason)

    def send_safe(self, now):
        for can_id in SAFE:
            self.send(can_id, now)
            self.due[can_id] = now + FIRST_CYCLE[can_id]

    def send(self, can_id, now):
        data = SAFE[can_id]
        if can_id == TURN_SIGNAL:
            self.alive_counter = (self.alive_counter + 1) & 0xFF
            data = data + bytes([self.alive_counter])
        self.bus.send(can.Message(arbitration_id=can_id, is_extended_id=False, data=data))
        self.sent_at[can_id] = now

    def tell(self, number, _frame):
        print(json.dumps({"event": "summary", "received": self.received}), flush=True)
        if number == signal.SIGTERM:
            sys.exit(0)


def main():
    parser = argparse.ArgumentParser(description="A small supervisor with python-can, for comparison.")
    parser.add_argument("interface")
    parser.add_argument("--init-hold-ms", type=int, default=500, metavar="MS")
    parser.add_argument("--reset-hold-ms", type=int, default=1000, metavar="MS")
    arguments = parser.parse_args()
    bus = can.Bus(channel=arguments.interface, bustype="socketcan")
    supervisor = Supervisor(bus, arguments.init_hold_ms / 1000, arguments.reset_hold_ms / 1000)
    signal.signal(signal.SIGUSR1, supervisor.tell)
    signal.signal(signal.SIGTERM, supervisor.tell)
    supervisor.run()


main()
