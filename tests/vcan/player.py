"""A healthy VCU, EPS and AI computer on a bus, simulated by the test: those of clients.py, frame by frame.

They do not obey commands. The members change their frames at any time.
"""
import threading
import time

import canbus
from clients import MESSAGES, Vehicle

CYCLES = {can_id: cycle for can_id, (cycle, _, _) in MESSAGES.items()}  # in milliseconds


class Player:
    """Sends until stop(). `bus` carries VCU and EPS, `ai_bus` the AI computer."""

    def __init__(self, interface="vcan0", ai_interface=None):
        self.bus = canbus.Bus(interface)
        self.ai_bus = canbus.Bus(ai_interface) if ai_interface else self.bus
        self.vehicle = Vehicle()
        self.silent = set()  # identifiers that are not sent
        self.counters = dict.fromkeys(CYCLES, 0)
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def engage(self):
        self.vehicle.engaged()

    def send(self, can_id):
        bus = self.ai_bus if MESSAGES[can_id][2] == "ai" else self.bus
        bus.send(can_id, self.vehicle.payload(can_id, self.counters[can_id]))
        self.counters[can_id] += 1

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

    def stop(self):
        if not self.ended.is_set():
            self.ended.set()
            self.thread.join()
            for bus in {self.bus, self.ai_bus}:
                bus.close()
