"""Traffic of vehicles that have the protocol's messages, but other identifiers and cycles: for tests of the survey.

The vehicle drives: in manual mode first, then in autopilot mode, in which gear, throttle and steering of the vehicle follow
the commands of the AI computer with a delay.
"""
import bisect
import functools
import random

import traffic

CYCLES = {name: cycle for name, cycle, _, _ in traffic.MESSAGES}
SOME_CYCLES = (5, 10, 20, 25, 40, 50, 100)
ENGAGED_MS, MANUAL_MS, END_MS = 6000, 34000, 40000


def course(steps, first=0):
    """The times from which on each value holds, and the values; `first` from the start on."""
    return tuple(zip((0, first), *steps))


class Drive:
    """What the AI computer commands, and what the vehicle does, at a time in ms."""

    def __init__(self, draw, lag_ms):
        self.draw = draw
        self.lag_ms = lag_ms
        self.throttles = course((t, draw.choice((0, 20, 40, 75, 125))) for t in range(7000, MANUAL_MS - 3000, 2500))
        angles = [(t, draw.randrange(-1500, 1500)) for t in range(7500, MANUAL_MS - 2000, 1500)]
        self.angles = course([*angles, (MANUAL_MS - 1500, 0)])
        self.gears = course([(6300, traffic.GEAR_D), (19000, traffic.GEAR_N), (19900, traffic.GEAR_R),
                             (27000, traffic.GEAR_N), (27700, traffic.GEAR_D)], traffic.GEAR_N)
        self.lights = course([(9000, 0x10), (14000, 0), (22000, 0x20), (26000, 0)])

    @staticmethod
    def engaged(t_ms):
        return ENGAGED_MS <= t_ms < MANUAL_MS

    @staticmethod
    def at(steps, t_ms):
        since, values = steps
        return values[bisect.bisect_right(since, t_ms) - 1]

    def command(self, steps, t_ms, idle):
        return self.at(steps, t_ms) if self.engaged(t_ms) else idle

    def gear(self, t_ms):
        if self.engaged(t_ms) and self.engaged(t_ms - self.lag_ms):
            return self.at(self.gears, t_ms - self.lag_ms)
        return traffic.GEAR_D if 2000 <= t_ms < 4500 else traffic.GEAR_P if not self.engaged(t_ms) else traffic.GEAR_N

    @functools.lru_cache(maxsize=2000)
    def throttle(self, t_ms):
        if self.engaged(t_ms):
            return self.command(self.throttles, t_ms - self.lag_ms, 0)
        return 30 if 2500 <= t_ms < 3800 else 0

    def angle(self, t_ms):
        """The wheel turns to each commanded angle in half a second."""
        if not self.engaged(t_ms):
            return 200 if 2600 <= t_ms < 3600 else 0
        asked = t_ms - self.lag_ms
        since, values = self.angles
        step = bisect.bisect_right(since, asked) - 1
        before = values[max(0, step - 1)]
        return round(before + (values[step] - before) * min(1.0, (asked - since[step]) / 500))

    @functools.lru_cache(maxsize=200)
    def speed(self, t_ms):
        """mm/s: the throttle of the last 800 ms."""
        return round(sum(self.throttle(max(0, t_ms - back)) for back in range(0, 800, 100)) * 1.5)


def payload(name, count, t_ms, drive):
    """The payload of a message, `count` times sent before."""
    if name == "gear_command":
        return bytes([drive.command(drive.gears, t_ms, traffic.GEAR_N)]) + bytes(7)
    if name == "gear_status":
        return bytes([drive.gear(t_ms)]) + bytes(7)
    if name == "throttle_command":
        return bytes([drive.command(drive.throttles, t_ms, 0)]) + bytes(7)
    if name == "throttle_status":
        return bytes([drive.throttle(t_ms)]) + bytes(7)
    if name == "steering_command":
        return (9000 + drive.command(drive.angles, t_ms, 0)).to_bytes(2, "little") + bytes(6)
    if name == "steering_status":
        return bytes([count & 0xFF, 98]) + (9000 + drive.angle(t_ms)).to_bytes(2, "little") + bytes(4)
    if name == "turn_signal_command":
        return bytes(4) + bytes([drive.command(drive.lights, t_ms, 0), 0, 0, count & 0xFF])
    if name == "vehicle_status":
        bits = (traffic.AUTOPILOT if drive.engaged(t_ms) else traffic.MANUAL) | drive.command(drive.lights, t_ms, 0)
        return round(drive.speed(t_ms) * 3.6).to_bytes(2, "little") + bytes(4) + bytes([bits, count & 0xFF])
    if name == "eps_status":
        return bytes([0, 0, 0, 1 if drive.engaged(t_ms) and drive.engaged(t_ms - 100) else 0]) + bytes(4)
    if name == "wheel_speed":
        speed = drive.speed(t_ms)
        return speed.to_bytes(4, "little") + (speed + speed // 20).to_bytes(4, "little")
    return bytes([0x23, 0x28, 0x06, 0x40, 0x40, 0x10, 0, 0])


def stranger(kind, count, t_ms, drive):
    """Messages that the protocol does not have, and that look like some that it has."""
    return {"empty": lambda: bytes(8),
            "counter": lambda: bytes(7) + bytes([count & 0xFF]),
            "state": lambda: bytes([4]) + bytes(7),
            "motor": lambda: (drive.speed(t_ms) * 7 // 2).to_bytes(2, "little") + bytes(6),
            "charge": lambda: bytes([max(0, 90 - t_ms // 1000)]) + bytes(7),
            "brake": lambda: bytes([60 if drive.throttle(t_ms) == 0 else 0]) + bytes(7),
            "flag": lambda: bytes([1 if drive.engaged(t_ms) else 0]) + bytes(7),
            "noise": lambda: bytes((count * 37 + at * 101) & 0xFF for at in range(8))}[kind]()


def frames(ids, cycles=None, lag_ms=120, seed=1, silent=(), strangers=(), edit=None):
    """
    The frames of 40 s. ids: of the messages that are sent; cycles: in ms, where they differ; lag_ms: until the vehicle
    obeys; silent: from and to, in ms, of an AI computer that fails; strangers: (kind, identifier, cycle); edit: as in
    traffic.frames().
    """
    draw = random.Random(seed)
    drive = Drive(draw, lag_ms)
    senders = [(name, number, {**CYCLES, **(cycles or {})}[name], payload) for name, number in ids.items()]
    senders += [(kind, number, cycle, stranger) for kind, number, cycle in strangers]
    result = []
    for name, number, cycle, make in senders:
        for count, start_us in enumerate(range(draw.randrange(cycle * 1000), END_MS * 1000, cycle * 1000)):
            t_us = start_us + draw.randrange(cycle * 60)
            if name in traffic.AI and silent and silent[0] <= t_us / 1000 < silent[1]:
                continue
            frame = traffic.Frame(t_us, name, number, make(name, count, t_us // 1000, drive), "can0")
            edited = frame if edit is None else edit(frame)
            result.extend(edited if isinstance(edited, list) else [edited] if edited else [])
    return sorted(result, key=lambda frame: frame.t_us)


def some(seed):
    """A vehicle at random: (arguments of frames(), its identifiers)."""
    draw = random.Random(seed)
    kinds = draw.sample(("empty", "counter", "state", "motor", "charge", "brake", "flag", "noise"), draw.randrange(5))
    numbers = draw.sample(range(0x10, 0x7E0), len(CYCLES) + len(kinds))
    ids = dict(zip(CYCLES, numbers))
    cycles = {name: draw.choice(SOME_CYCLES) for name in CYCLES} if draw.random() < 0.7 else {}
    begin_ms = draw.randrange(10000, 25000)
    return {"ids": ids, "cycles": cycles, "lag_ms": draw.choice((0, 15, 40, 120, 300)), "seed": seed,
            "silent": (begin_ms, begin_ms + draw.choice((400, 900))) if draw.random() < 0.4 else (),
            "strangers": [(kind, number, draw.choice((20, 50, 100))) for kind, number in zip(kinds, numbers[len(CYCLES):])]}
