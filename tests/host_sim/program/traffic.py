"""Traffic of a vehicle on the CAN bus, as lines of a candump log: for tests and for the replay benchmark.

The eleven messages come on their cycles, spread by phase, with running heartbeat counters. Everything stands still with
gear P in manual mode, until `engage_ms`: from there on the VCU reports autopilot mode and the AI computer drives.
What is wrong is said by the test: `edit` is asked for every frame and may change, drop or repeat it.
"""
import itertools

US_PER_MS = 1000

# name, cycle in ms, phase in microseconds, sender
MESSAGES = (
    ("vehicle_status", 10, 0, "vcu"),
    ("throttle_status", 10, 900, "vcu"),
    ("wheel_speed", 10, 1700, "vcu"),
    ("steering_status", 10, 2500, "eps"),
    ("eps_status", 10, 3300, "eps"),
    ("steering_position", 10, 4100, "eps"),
    ("gear_status", 25, 5200, "vcu"),
    ("steering_command", 25, 6100, "ai"),
    ("turn_signal_command", 100, 7000, "ai"),
    ("gear_command", 100, 7900, "ai"),
    ("throttle_command", 100, 8700, "ai"),
)

VCU = ("vehicle_status", "throttle_status", "wheel_speed", "gear_status")
EPS = ("steering_status", "eps_status", "steering_position")
AI = ("steering_command", "turn_signal_command", "gear_command", "throttle_command")

IDS = {
    "turn_signal_command": 0x43F,
    "gear_command": 0x168,
    "throttle_command": 0x075,
    "steering_command": 0x065,
    "vehicle_status": 0x363,
    "gear_status": 0x0A3,
    "throttle_status": 0x050,
    "steering_status": 0x067,
    "eps_status": 0x167,
    "steering_position": 0x267,
    "wheel_speed": 0x101,
}
TABLE_IDS = dict(IDS, turn_signal_command=0x201, vehicle_status=0x203)

MANUAL = 0x40
AUTOPILOT = 0x80
BUTTON_1 = 0x01
GEAR_P, GEAR_R, GEAR_N, GEAR_D = 8, 2, 4, 1


ANGLE = (9000).to_bytes(2, "little")
PAYLOADS = {  # healthy: count is how often the message was sent before
    "vehicle_status": lambda count, engaged: bytes([0, 0, 0, 0, 0, 0, AUTOPILOT if engaged else MANUAL, count & 0xFF]),
    "throttle_status": lambda count, engaged: bytes([10 if engaged else 0, 0, 0, 0, 0, 0, 0, 0]),
    "wheel_speed": lambda count, engaged: (400 if engaged else 0).to_bytes(4, "little") * 2,
    "steering_status": lambda count, engaged: bytes([count & 0xFF, 100]) + ANGLE + bytes(4),
    "eps_status": lambda count, engaged: bytes([0, 0, 0, 1, 0, 0, 0, 0]),
    "steering_position": lambda count, engaged: bytes([0x23, 0x28, 0, 0, 0x46, 0x50, 0, 0]),
    "gear_status": lambda count, engaged: bytes([GEAR_D if engaged else GEAR_P, 0, 0, 0, 0, 0, 0, 0]),
    "steering_command": lambda count, engaged: ANGLE + bytes(6),
    "turn_signal_command": lambda count, engaged: bytes([0, 0, 0, 0, 0x80, 0, 0, count & 0xFF]),
    "gear_command": lambda count, engaged: bytes([GEAR_D if engaged else GEAR_P, 0, 0, 0, 0, 0, 0, 0]),
    "throttle_command": lambda count, engaged: bytes([10 if engaged else 0, 0, 0, 0, 0, 0, 0, 0]),
}


class Frame:
    """One frame: t_us since the start, name of its message, identifier, payload, interface."""

    __slots__ = ("t_us", "name", "can_id", "data", "interface")

    def __init__(self, t_us, name, can_id, data, interface):
        self.t_us = t_us
        self.name = name
        self.can_id = can_id
        self.data = data
        self.interface = interface

    @property
    def t_ms(self):
        return self.t_us / US_PER_MS

    def text(self):
        return "%03X#%s" % (self.can_id, self.data.hex().upper())


def frames(duration_ms, engage_ms=None, ids=None, interface="can0", ai_interface=None, senders=("vcu", "eps", "ai"),
           edit=None):
    """The frames of `duration_ms` of traffic, in the order of time."""
    ids = ids or IDS
    counts = {}
    result = []
    for cycle_start in range(0, duration_ms, 5):
        for name, cycle, phase, sender in MESSAGES:
            t_us = cycle_start * US_PER_MS + phase
            if cycle_start % cycle or sender not in senders:
                continue
            count = counts.get(name, 0)
            counts[name] = count + 1
            engaged = engage_ms is not None and t_us >= engage_ms * US_PER_MS
            side = ai_interface if ai_interface and sender == "ai" else interface
            frame = Frame(t_us, name, ids[name], PAYLOADS[name](count, engaged), side)
            edited = frame if edit is None else edit(frame)
            if edited is None:
                continue
            result.extend(edited if isinstance(edited, list) else [edited])
    result.sort(key=lambda frame: frame.t_us)
    return [frame for frame in result if frame.t_us < duration_ms * US_PER_MS]


def stamp(t_us):
    return "(%010d.%06d)" % divmod(t_us, 1000000)


BASE_US = 1700000000 * 1000000


def log(traffic, base_us=BASE_US):
    """Frames as a candump log."""
    return "".join(["(%010d.%06d) %s %03X#%s\n" %
                    (*divmod(base_us + f.t_us, 1000000), f.interface, f.can_id, f.data.hex().upper()) for f in traffic])


def repeated(text, times):
    """A log of whole seconds, so many times: each time right behind the one before."""
    seconds = [(int(second), "".join(lines))
               for second, lines in itertools.groupby(text.splitlines(keepends=True), lambda line: line[1:11])]
    length = seconds[-1][0] + 1 - seconds[0][0]
    return "".join(lines.replace("(%010d." % second, "(%010d." % (second + number * length))
                   for number in range(times) for second, lines in seconds)


def edit_payload(name, at_ms, change, until_ms=None):
    """An edit for traffic.frames: change the payload (a bytearray) of a message from a moment on."""
    def edit(frame):
        if frame.name == name and frame.t_ms >= at_ms and (until_ms is None or frame.t_ms < until_ms):
            data = bytearray(frame.data)
            change(data)
            frame.data = bytes(data)
        return frame
    return edit


def byte(index, value):
    """A change of the payload, for edit_payload()."""
    return lambda data: data.__setitem__(index, value)


def raise_remote_signal_lost(data):
    """A change of 363h, for edit_payload(): VCU alarm 1."""
    data[4] |= 0x01


def stop(names, at_ms, until_ms=None):
    """An edit: messages that stop."""
    def edit(frame):
        stopped = frame.name in names and frame.t_ms >= at_ms and (until_ms is None or frame.t_ms < until_ms)
        return None if stopped else frame
    return edit
