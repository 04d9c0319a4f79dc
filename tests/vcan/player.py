"""A healthy VCU, EPS and AI computer on a bus, simulated by the test. Payloads are written by hand from docs/protocol.md.

They do not obey commands. The members change their frames at any time.
"""
import threading
import time

import canbus

P, D = 8, 1  # gears
MANUAL, AUTOPILOT = 0x40, 0x80  # 363h byte 7
NODES = {"vcu": (0x363, 0x050, 0x101, 0x0A3), "eps": (0x067, 0x167, 0x267), "ai": (0x065, 0x43F, 0x168, 0x075)}
# The identifier with its cycle in milliseconds.
CYCLES = {0x363: 10, 0x050: 10, 0x101: 10, 0x067: 10, 0x167: 10, 0x267: 10, 0x0A3: 25, 0x065: 25, 0x43F: 100,
          0x168: 100, 0x075: 100}


class Player:
    """Sends until stop(). `bus` carries VCU and EPS, `ai_bus` the AI computer."""

    def __init__(self, interface="vcan0", ai_interface=None):
        self.bus = canbus.Bus(interface)
        self.ai_bus = canbus.Bus(ai_interface) if ai_interface else self.bus
        self.engaged = False
        self.silent = set()  # identifiers that are not sent
        self.counters = dict.fromkeys(CYCLES, 0)
        self.last_065 = None  # when it was sent, by the time of day
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def payload(self, can_id):
        count = self.counters[can_id] & 0xFF
        drives = self.engaged
        return bytes({
            0x363: [0, 0, 0, 0, 0, 0, AUTOPILOT if drives else MANUAL, count],
            0x050: [10 if drives else 0, 0, 0, 0, 0, 0, 0, 0],
            0x101: [0x90, 0x01, 0, 0, 0x90, 0x01, 0, 0] if drives else [0] * 8,
            0x0A3: [D if drives else P, 0, 0, 0, 0, 0, 0, 0],
            0x067: [count, 100, 0x28, 0x23, 0, 0, 0, 0],
            0x167: [0, 0, 0, 1, 0, 0, 0, 0],
            0x267: [0x23, 0x28, 0, 0, 0x46, 0x50, 0, 0],
            0x065: [0x28, 0x23, 0, 0, 0, 0, 0, 0],
            0x43F: [0, 0, 0, 0, 0x80, 0, 0, count],
            0x168: [D, 0, 0, 0, 0, 0, 0, 0],
            0x075: [10, 0, 0, 0, 0, 0, 0, 0],
        }[can_id])

    def send(self, can_id):
        bus = self.ai_bus if can_id in NODES["ai"] else self.bus
        bus.send(can_id, self.payload(can_id))
        self.counters[can_id] += 1
        if can_id == 0x065:
            self.last_065 = time.time()

    def run(self):
        start = time.monotonic()
        due = {can_id: start + 0.001 * place for place, can_id in enumerate(CYCLES)}
        while not self.ended.is_set():
            now = time.monotonic()
            for can_id, at in due.items():
                if at <= now:
                    due[can_id] = max(at, now - 0.005) + CYCLES[can_id] / 1000  # what is late is not made up for
                    if can_id not in self.silent:
                        self.send(can_id)
            time.sleep(max(0, min(due.values()) - time.monotonic()))

    def fall_silent(self, node):
        self.silent |= set(NODES[node])

    def stop(self):
        if not self.ended.is_set():
            self.ended.set()
            self.thread.join()
            for bus in {self.bus, self.ai_bus}:
                bus.close()
