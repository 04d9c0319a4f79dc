"""Other CAN tools on the same bus as host_sim: can-utils as processes, a vehicle as a log for canplayer.

The frames of the tools are known (the log of canplayer, the frame of cansend). All other frames of candump's log are the
supervisor's.
"""
import collections
import functools
import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

import canbus
import in_memory

TOOLS = ("cansend", "candump", "canplayer", "canbusload", "ip", "tc")
TIMEOUT_S = canbus.TIMEOUT

MANUAL, AUTOPILOT = 0x40, 0x80  # 363h byte 7
BUTTON_1 = 0x01  # 363h byte 7
P, D = 8, 1  # 168h and 0A3h byte 1
CENTRE = 9000
STATUS_ID = 0x7F0
STATUS = "status_frame_id: 0x7F0\nstatus_frame_period_ms: 10\n"
# Deadlines that are not looked at are as long as they can be: then a machine that is busy elsewhere trips nothing.
LONGEST_MS = {
    "watchdog_period_ms": 1000, "vcu_heartbeat_timeout_ms": 500, "eps_heartbeat_timeout_ms": 500,
    "ai_heartbeat_timeout_ms": 2000, "gear_command_timeout_ms": 2000, "throttle_command_timeout_ms": 2000,
    "steering_command_timeout_ms": 500, "gear_status_timeout_ms": 1000, "throttle_status_timeout_ms": 500,
    "eps_status_timeout_ms": 500, "steering_position_timeout_ms": 500, "wheel_speed_timeout_ms": 500}
PATIENT = STATUS + "".join("%s: %d\n" % item for item in LONGEST_MS.items())

# Identifier: cycle and phase in milliseconds, sender.
MESSAGES = {0x363: (10, 0, "vcu"), 0x050: (10, 1, "vcu"), 0x101: (10, 2, "vcu"), 0x067: (10, 3, "eps"),
            0x167: (10, 4, "eps"), 0x267: (10, 5, "eps"), 0x0A3: (25, 6, "vcu"), 0x065: (25, 7, "ai"),
            0x43F: (100, 8, "ai"), 0x168: (100, 9, "ai"), 0x075: (100, 12, "ai")}
COMMANDS = (0x43F, 0x168, 0x075, 0x065)

# at: seconds by the kernel; id: 3 digits, or 8 with the flags; data: digits as cansend takes them; text: both
Frame = collections.namedtuple("Frame", "at id data text")


def parse(line):
    """A line of candump -L: interface, frame."""
    stamp, interface, text = line.split(" ")[:3]
    can_id, hash_, data = text.partition("#")
    if len(stamp) != 19 or not hash_:
        raise AssertionError("candump said: " + line)
    return interface, Frame(float(stamp[1:18]), can_id, data, text)


def key(frame):
    """What a frame is on the wire."""
    return frame.text


def of(frames, *ids):
    names = ["%03X" % can_id for can_id in ids]
    return [frame for frame in frames if frame.id in names]


class Vehicle:
    """The frames of VCU, EPS and AI computer as lines of a log: healthy, in manual and at standstill, until changed."""

    def __init__(self, *nodes):
        self.nodes = set(nodes or ("vcu", "eps", "ai"))
        self.silent = set()
        self.pace = 1
        self.mode, self.gear, self.throttle, self.speed, self.angle = MANUAL, P, 0, 0, CENTRE
        self.ai = {0x168: bytes([D]), 0x075: bytes([75]), 0x065: (CENTRE + 100).to_bytes(2, "little")}
        self.lights, self.reserved = 0x80, 0x00  # 43Fh byte 5: headlight off; what stands in reserved bytes of commands

    def endless(self):
        """A log that can be played again and again: it is as long as a counter of the messages each 10 ms."""
        return self.log(2560 * self.pace)

    def slow(self):
        """Four times slower than the protocol, with longer deadlines, for tests of other things."""
        self.pace = 4
        return self

    def engaged(self):
        self.mode, self.gear, self.throttle, self.speed = AUTOPILOT, D, 75, 400

    def parked(self):
        self.mode, self.gear, self.throttle, self.speed = MANUAL, P, 0, 0

    def payload(self, can_id, count):
        count &= 0xFF
        if can_id == 0x363:
            return bytes([0, 0, 0, 0, 0, 0, self.mode, count])
        if can_id == 0x43F:
            return bytes([self.reserved] * 4 + [self.lights, self.reserved, self.reserved, count])
        if can_id in self.ai:
            return self.ai[can_id].ljust(8, bytes([self.reserved]))
        if can_id == 0x067:
            return bytes([count, 100, self.angle & 0xFF, self.angle >> 8, 0, 0, 0, 0])
        if can_id == 0x101:
            return bytes([self.speed & 0xFF, self.speed >> 8, 0, 0] * 2)
        if can_id in (0x050, 0x0A3):
            return bytes([self.throttle if can_id == 0x050 else self.gear, 0, 0, 0, 0, 0, 0, 0])
        return {0x167: bytes([0, 0, 0, 1, 0, 0, 0, 0]), 0x267: bytes([0x23, 0x28, 0, 0, 0x46, 0x50, 0, 0])}[can_id]

    def log(self, duration_ms, changes=None):
        """`changes`: {ms: what is called with the vehicle then}. Gives (ms, interface, frame as cansend takes it)."""
        moments = sorted({0, *(changes or {}), duration_ms})
        assert moments[-1] == duration_ms, "a change after the end"
        counts = collections.Counter()
        lines = []
        for begin, end in zip(moments, moments[1:]):
            (changes or {}).get(begin, lambda vehicle: None)(self)
            for can_id, (cycle, phase, sender) in MESSAGES.items():
                cycle *= self.pace
                if sender not in self.nodes or can_id in self.silent:
                    continue
                side = "ai" if sender == "ai" else "vehicle"
                first = phase + max(0, -(-(begin - phase) // cycle)) * cycle
                for now in range(first, end, cycle):
                    lines.append((now, side, "%03X#%s" % (can_id, self.payload(can_id, counts[can_id]).hex().upper())))
                    counts[can_id] += 1
        lines.sort(key=lambda line: line[0])
        return lines


class Player:
    """canplayer, on a log that was made by the test."""

    def __init__(self, case, lines, name, interfaces, endless):
        self.case, self.lines, self.interfaces, self.endless = case, lines, interfaces, endless
        path = case.folder / ("%s.log" % name)
        path.write_text("".join("(%d.%03d000) %s %s\n" % (1700000000 + ms // 1000, ms % 1000, interface, text)
                                for ms, interface, text in lines))
        self.process = case.popen("canplayer", "-I", path, "-l", "i" if endless else "1",
                                  *("%s=%s" % (interface, side) for side, interface in interfaces.items()))

    def wait(self):
        """Wait for the end of the log."""
        status = self.process.wait(TIMEOUT_S)
        self.case.assertEqual(status, 0, "canplayer")

    def stop(self):
        self.process.terminate()
        self.process.wait(TIMEOUT_S)


class Dump:
    """candump on an interface, error frames too."""

    def __init__(self, case, interface):
        self.case, self.interface = case, interface
        self.path = case.folder / ("%s.candump" % interface)
        self.file = open(self.path, "wb")
        self.before = transmitted(interface)
        self.process = case.popen("candump", "-L", "-D", "-d", "-r", "8000000", interface + ",0:0,#FFFFFFFF",
                                  stdout=self.file)
        case.until(lambda: re.search(r"^\s*%s\s+000 " % interface, rcvlist("all"), re.MULTILINE), "candump listens")
        self.frames = None

    def stop(self):
        """All frames, in their order."""
        if self.frames is None:
            self.process.send_signal(signal.SIGTERM)
            self.process.wait(TIMEOUT_S)
            self.file.close()
            # candump ends a line of its own with an empty one
            lines = [line for line in self.path.read_text().splitlines() if line]
            self.frames = [parse(line)[1] for line in lines]
            self.sent_by_kernel = transmitted(self.interface) - self.before
        return self.frames


def transmitted(interface):
    return int(pathlib.Path("/sys/class/net/%s/statistics/tx_packets" % interface).read_text())


def rcvlist(name):
    return pathlib.Path("/proc/net/can/rcvlist_" + name).read_text()


class Supervisor:
    """host_sim run, with its events and its own log of what it sent, which is not believed but compared."""

    def __init__(self, case, *arguments, config=PATIENT, name="supervisor"):
        self.case = case
        self.paths = {what: case.folder / ("%s.%s" % (name, what)) for what in ("yaml", "events", "out", "stderr")}
        self.paths["yaml"].write_text(config)
        self.errors = open(self.paths["stderr"], "wb")
        self.process = case.popen(canbus.PROGRAM, "run", "--config", self.paths["yaml"], "--events", self.paths["events"],
                                  "--out", self.paths["out"], *arguments, stderr=self.errors)
        self.status, self.log = None, None

    def events(self, kind=None):
        try:
            lines = self.paths["events"].read_text().split("\n")[:-1]
        except FileNotFoundError:
            lines = []
        found = [json.loads(line) for line in lines]
        return [event for event in found if kind is None or event["event"] == kind]

    def states(self):
        return [event["to"] for event in self.events("state")]

    def story(self):
        """(state, reason of the trip)"""
        return [(event["to"], event["reason"]) for event in self.events("state")]

    def faults(self):
        """The faults raised since the end of INIT."""
        events = self.events()
        left = [place for place, event in enumerate(events) if event["event"] == "state" and event["from"] == "INIT"]
        return [event["name"] for event in events[left[0]:] if event["event"] == "fault" and event["active"]]

    def wait_for(self, kind, **expected):
        """The first event of this kind with these values."""
        def look():
            if self.process.poll() is not None:
                raise AssertionError("host_sim ended: " + self.paths["stderr"].read_text())
            return next((event for event in self.events(kind) if all(event[name] == expected[name] for name in expected)), None)
        return self.case.until(look, "%s %s; events:\n%s" % (kind, expected, "\n".join(map(str, self.events()[-12:]))))

    def wait_state(self, state):
        return self.wait_for("state", to=state)

    def stop(self):
        if self.status is None:
            self.process.send_signal(signal.SIGTERM)
            self.status = self.process.wait(TIMEOUT_S)
            self.errors.close()
            self.case.assertEqual(self.status, 0, self.paths["stderr"].read_text())
        return self.events()[-1]

    def sent(self):
        """Interface and frame of everything in its log of sent frames."""
        if self.log is None:
            self.stop()
            self.log = [parse(line) for line in self.paths["out"].read_text().splitlines()]
        return self.log


@functools.cache
def bring_tools():
    """Copy the tools into memory."""
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        raise AssertionError("missing: %s; 'scripts/install-deps vcan' installs them" % ", ".join(missing))
    if canbus.MEMORY:
        in_memory.bring(list(map(shutil.which, TOOLS)), canbus.MEMORY)


class Case(canbus.Case):
    """A test with buses of its own. Ends every process that it started."""

    maxDiff = 4000
    numbers = itertools.count()
    shaped = False  # whether the test changes the queue of a bus

    def setUp(self):
        super().setUp()
        bring_tools()
        self.dumps, self.supervisors, self.players = {}, [], []
        self.records = collections.defaultdict(list)  # interface: frames of the clients, all of which were sent
        self.attributed = {}  # interface: frames of the supervisors
        self.ended_at = 0

    # Processes.
    def popen(self, *command, **options):
        options.setdefault("stdout", subprocess.DEVNULL)
        options.setdefault("stderr", subprocess.DEVNULL)
        process = subprocess.Popen(list(map(str, command)), stdin=subprocess.DEVNULL, **options)

        def end():
            process.kill()
            process.wait()
        self.addCleanup(end)
        return process

    def call(self, *command):
        done = subprocess.run(list(map(str, command)), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=TIMEOUT_S, check=False)
        self.assertEqual(done.returncode, 0, "%s: %s" % (command, done.stdout.decode(errors="replace")))

    def until(self, look, what):
        end = time.monotonic() + TIMEOUT_S
        while time.monotonic() < end:
            found = look()
            if found:
                return found
            time.sleep(0.03)
        raise AssertionError("not seen: " + what)

    # Clients.
    def bus(self):
        interface = "tv%d_%d" % (os.getpid() % 100000, next(Case.numbers))
        canbus.ip("link", "add", "dev", interface, "type", "vcan")
        self.addCleanup(canbus.ip, "link", "del", "dev", interface)
        canbus.ip("link", "set", "dev", interface, "up")
        self.dumps[interface] = Dump(self, interface)
        return interface

    def supervisor(self, *arguments, **options):
        supervisor = Supervisor(self, *arguments, **options)
        self.supervisors.append(supervisor)
        return supervisor

    def play(self, lines, vehicle, ai=None, endless=False):
        """Start canplayer. `endless`: again and again, until it is stopped; else the test waits for its end."""
        player = Player(self, lines, "player%d" % len(self.players), {"vehicle": vehicle, "ai": ai or vehicle}, endless)
        self.players.append(player)
        return player

    def cansend(self, interface, text, record=None):
        self.call("cansend", interface, text)
        self.record(interface, record or text.replace(".", ""))

    def record(self, interface, text):
        """Record that a client sent this."""
        self.records[interface].append(text)

    # What is true of every run.
    def end(self):
        """End all programs; candump gets time to read the remaining frames."""
        if not self.ended_at:
            self.ended_at = time.time()
            for supervisor in self.supervisors:
                supervisor.stop()
            for player in self.players:
                if player.endless:
                    player.stop()
                else:
                    player.wait()
            time.sleep(0.1)

    def frames(self, interface):
        """All frames of a bus, by candump, which ends by that."""
        self.end()
        return self.dumps[interface].stop()

    def supervisors_frames(self, interface):
        """What is left of candump's frames when those of the clients are taken away; with stamps."""
        known = self.attributed.get(interface)
        if known is not None:
            return known
        frames = self.frames(interface)
        seen, claimed = collections.defaultdict(list), collections.defaultdict(list)
        for place, frame in enumerate(frames):
            seen[key(frame)].append(place)
        for supervisor in self.supervisors:
            for where, frame in supervisor.sent():
                if where == interface:
                    claimed[key(frame)].append(frame.at)
        places = []
        for text, stamps in claimed.items():
            self.assertGreaterEqual(len(seen[text]), len(stamps), "the supervisor logged %s, candump did not see it" % text)
            if len(seen[text]) > len(stamps):  # somebody else sent the same: its stamps tell which
                for at in stamps:
                    nearest = min(seen[text], key=lambda place: abs(frames[place].at - at))
                    seen[text].remove(nearest)
                    places.append(nearest)
            else:
                places += seen[text]
        self.attributed[interface] = [frames[place] for place in sorted(places)]
        return self.attributed[interface]

    def check_all_accounted_for(self, interface):
        """candump must have recorded exactly the frames of the clients and of the supervisor."""
        seen = collections.Counter(map(key, self.frames(interface)))
        for frame in self.supervisors_frames(interface):
            seen[key(frame)] -= 1
        surely, often = collections.Counter(self.records[interface]), set()
        for player in self.players:
            mine = [text for _, side, text in player.lines if player.interfaces[side] == interface]
            (often if player.endless else surely).update(mine)
        nobodys = {text: count for text, count in (seen - surely).items() if text not in often}
        # The very last frame of a supervisor may leave unlogged: it ends before it hears that it has left.
        last = [frame for frame in self.frames(interface) if nobodys.get(key(frame)) == 1 and
                frame.at > self.ended_at - 0.02 and frame.id in ("43F", "168", "075", "065", "7F0", "7F1")]
        if len(last) <= len(self.supervisors):
            for frame in last:
                nobodys.pop(key(frame), None)
        self.assertEqual(nobodys, {}, "on %s, sent by nobody that was asked to" % interface)
        self.assertEqual(dict(surely - seen), {}, "sent, and not on %s" % interface)

    def check_every_run(self):
        for interface, dump in self.dumps.items():
            self.check_all_accounted_for(interface)
            if not self.shaped:
                self.assertEqual(len(self.frames(interface)), dump.sent_by_kernel, "frames of candump, and of the kernel")

    def at_once(self, cause, answer, within=0.010):
        """The reaction must follow the cause in time."""
        self.assertGreaterEqual(answer.at, cause.at)
        self.at_most(within, answer.at - cause.at, "from %s to %s" % (key(cause), key(answer)))

    def next_of(self, frames, after, *ids):
        """The first of these identifiers after a moment."""
        found = [frame for frame in of(frames, *ids) if frame.at > after]
        self.assertTrue(found, "none of %s after %.6f" % (["%03X" % can_id for can_id in ids], after))
        return found[0]

    def states_only(self, supervisor, *expected):
        self.assertEqual(supervisor.story(), list(expected))


def gaps(frames):
    """(seconds, end) of the gaps between frames."""
    return [(b.at - a.at, b.at) for a, b in zip(frames, frames[1:])]
