"""The permitted frames of a supervisor in each state, written from docs/requirements.md and docs/protocol.md (FSM-6,
FSM-8, FSM-10, TOP-1, TOP-2) and not from the code.

The state is read from the supervisor's own status frame on the bus (TOP-3), which it sends every 10 ms here: a frame
between two of them was sent in the state of the one or of the other.
"""
INIT, STANDBY, ACTIVE, TRIPPED, SAFE = 0x0F, 0x33, 0x3C, 0x55, 0x5A
SENDS_SAFE_COMMANDS = {INIT, TRIPPED, SAFE}
GEAR_P = "0800000000000000"
THROTTLE_0 = "0000000000000000"
LIGHTS = "00000000700000"  # both turn signals, autopilot off, headlight on (0); then comes the counter


def is_safe(frame):
    """A safe command, byte for byte; 065h is checked elsewhere."""
    return ((frame.id == "168" and frame.data == GEAR_P) or (frame.id == "075" and frame.data == THROTTLE_0) or
            (frame.id == "43F" and len(frame.data) == 16 and frame.data[:14] == LIGHTS))


def states_around(frames, status_id):
    """For each frame the states in which it may have been sent. Before the first status frame: INIT, as after a power-on."""
    name = "%03X" % status_id
    before, result = INIT, []
    states = [int(frame.data[:2], 16) if frame.id == name else None for frame in frames]
    following = [None] * len(frames)
    after = None
    for place in reversed(range(len(frames))):
        if states[place] is not None:
            after = states[place]
        following[place] = after
    for place, state in enumerate(states):
        if state is not None:
            before = state
        # Behind the last status frame: it may have tripped since.
        result.append({before, following[place]} if following[place] is not None else {before, TRIPPED})
    return result


def valid_angles(everything):
    """Of all 067h on the bus, by stamp: (at, bytes 3 and 4) in range."""
    found = []
    for frame in everything:
        if frame.id == "067" and len(frame.data) == 16:
            if int(frame.data[6:8] + frame.data[4:6], 16) <= 18000:
                found.append((frame.at, frame.data[4:8]))
    return found


class Oracle:
    def __init__(self, everything, gateway):
        self.angles = valid_angles(everything)
        self.gateway = gateway
        self.held = None
        self.counter = None  # of the supervisor's own 43Fh
        self.parking = False  # the first gear P of this trip has left
        self.wrong = []

    def complain(self, why, frame, states):
        self.wrong.append("%s: (%.6f) %s#%s in %s" % (why, frame.at, frame.id, frame.data,
                                                     "/".join("%02X" % state for state in sorted(states))))

    def steering(self, frame, states):
        if not states & {TRIPPED, SAFE}:
            return False
        if len(frame.data) != 16 or frame.data[4:] != "0" * 12:
            return False
        angle = frame.data[:4]
        measured = angle in {text for at, text in self.angles if at <= frame.at}
        if self.held is None and measured and not states & {STANDBY, ACTIVE}:
            self.held = angle
        return measured and self.held in (None, angle)

    def passes(self, frame, states):
        """A gateway: all frames that are not safe commands."""
        if not self.gateway or len(frame.data) != 16:
            return False
        return bool(ACTIVE in states or (STANDBY in states and frame.id == "43F"))

    def judge(self, frame, states):
        if frame.id not in ("43F", "168", "075", "065"):
            self.complain("no identifier of a command", frame, states)
        elif is_safe(frame):
            if not states & SENDS_SAFE_COMMANDS and not self.passes(frame, states):
                self.complain("a safe command where nothing is sent", frame, states)
            elif frame.id == "43F" and not self.passes(frame, states):
                if frame.data[14:] == self.counter:
                    self.complain("an alive counter that stands still", frame, states)
                self.counter = frame.data[14:]
        elif frame.id == "065" and self.steering(frame, states):
            pass
        elif not self.passes(frame, states):
            self.complain("not a safe command", frame, states)
        elif self.parking:
            self.complain("a command of another after the first safe one", frame, states)
        if frame.id == "168" and is_safe(frame) and states & {TRIPPED, SAFE}:
            self.parking = True

    def told(self, state):
        """A status frame."""
        if state in (STANDBY, ACTIVE):
            self.held = None
            self.parking = False


def check(frames, everything, status_id, gateway=False):
    """`frames`: of the supervisor on the vehicle side; `everything` on that bus. Gives what is wrong, as texts."""
    judge = Oracle(everything, gateway)
    states = states_around(frames, status_id)
    for frame, around in zip(frames, states):
        if frame.id == "%03X" % status_id:
            if len(frame.data) != 16:
                judge.complain("a status frame of another length", frame, around)
            judge.told(int(frame.data[:2], 16))
        else:
            judge.judge(frame, around)
    return judge.wrong
