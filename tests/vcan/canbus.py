"""A CAN bus for a test: frames with the kernel's stamps, and the program under test as a process on it.

Run by scripts/with-vcan, where vcan0, vcan1 and vcan2 exist. HOST_SIM in the environment is the program's path.
"""
import collections
import fcntl
import os
import pathlib
import pty
import queue
import re
import select
import signal
import socket
import struct
import subprocess
import tempfile
import termios
import threading
import time
import unittest

import in_memory
from on_time import Late, on_time

PROGRAM = os.environ["HOST_SIM"]
if MEMORY := in_memory.folder():
    tempfile.tempdir = MEMORY
    in_memory.bring([PROGRAM], MEMORY)
    PROGRAM = os.path.join(MEMORY, os.path.basename(PROGRAM))

TIMEOUT = 1000  # seconds, for what comes at once when all is well: a clock that is counted leaps (in_memory.py)

FRAME = struct.Struct("=IB3x8s")  # struct can_frame
STAMP = struct.Struct("@qq")  # struct timespec
SO_TIMESTAMPNS = 35
SO_RCVBUFFORCE = 33
BUFFER_SIZE = 8 << 20
ROOM = socket.CMSG_SPACE(STAMP.size)
FLAGS = socket.CAN_EFF_FLAG | socket.CAN_RTR_FLAG | socket.CAN_ERR_FLAG

Frame = collections.namedtuple("Frame", "at id data flags")  # at: seconds, the kernel's


class Bus:
    """A socket on an interface. It receives all frames but its own. It reads seldom, to save processor time."""

    def __init__(self, interface):
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW | socket.SOCK_NONBLOCK, socket.CAN_RAW)
        self.socket.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self.look_every = 0.2  # seconds: so much fits into a buffer of the usual size
        try:
            self.socket.setsockopt(socket.SOL_SOCKET, SO_RCVBUFFORCE, BUFFER_SIZE)
            self.look_every = 3
        except PermissionError:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_SIZE)
        self.socket.bind((interface,))
        self.waiting = collections.deque()

    def close(self):
        self.socket.close()

    def send(self, can_id, data, flags=0):
        self.socket.send(FRAME.pack(can_id | flags, len(data), bytes(data).ljust(8, b"\0")))

    def look(self):
        """Read all frames that have arrived."""
        end = time.time()
        while True:
            try:
                raw, ancillary, _, _ = self.socket.recvmsg(FRAME.size, ROOM)
            except BlockingIOError:
                return
            seconds, nanoseconds = STAMP.unpack(ancillary[0][2])
            can_id, length, data = FRAME.unpack(raw)
            at = seconds + nanoseconds / 1e9
            self.waiting.append(Frame(at, can_id & ~FLAGS, data[:length], can_id & FLAGS))
            if at > end:
                return

    def listen(self, seconds):
        """All frames until then, beginning with those that were not returned yet."""
        end = time.time() + seconds
        looked = 0
        while looked < end:
            time.sleep(max(0, min(self.look_every, end - time.time())))
            looked = time.time()
            self.look()
        frames = [frame for frame in self.waiting if frame.at <= end]
        self.waiting = collections.deque(frame for frame in self.waiting if frame.at > end)
        return frames

    def forget(self):
        """Drop all frames until now."""
        self.look()
        self.waiting.clear()

    def wait_for(self, can_id, matches=lambda data: True, timeout=TIMEOUT):
        """The first frame with this identifier that matches. Those before it are dropped."""
        end = time.monotonic() + timeout
        seen = None
        while time.monotonic() < end:
            while self.waiting:
                frame = self.waiting.popleft()
                if frame.id == can_id:
                    seen = frame
                    if matches(frame.data):
                        return frame
            time.sleep(0.02)
            self.look()
        raise AssertionError("no such %03Xh within %g s, the last one: %s" % (can_id, timeout, seen))


class Process:
    """`host_sim ...` as it runs, with its output line by line."""

    def __init__(self, *arguments, stdin=subprocess.PIPE):
        self.process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdin=stdin, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True, bufsize=1)
        self.lines = {"stdout": [], "stderr": []}
        self.news = {name: queue.Queue() for name in self.lines}
        self.readers = [threading.Thread(target=self.read, args=(name,)) for name in self.lines]
        for reader in self.readers:
            reader.start()

    def read(self, name):
        for line in getattr(self.process, name):
            self.lines[name].append(line)
            self.news[name].put(line)

    def say(self, line):
        """Type a line."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def close_stdin(self):
        self.process.stdin.close()

    def wait_line(self, expression, name="stdout", timeout=TIMEOUT):
        """The next line in which the expression is found."""
        end = time.monotonic() + timeout
        while True:
            try:
                line = self.news[name].get(timeout=max(0, end - time.monotonic()))
            except queue.Empty:
                raise AssertionError("no %r on %s, but:\n%s" % (expression, name, self.text(name))) from None
            if re.search(expression, line):
                return line

    def is_running(self):
        return self.process.poll() is None

    def text(self, name="stdout"):
        return "".join(self.lines[name])

    def end(self, number=signal.SIGTERM, timeout=TIMEOUT):
        """Send a signal, unless it is None, and wait for the end. Gives the exit status."""
        if number is not None and self.is_running():
            self.process.send_signal(number)
        try:
            status = self.process.wait(timeout)
        finally:
            self.process.kill()
            for reader in self.readers:
                reader.join()
            for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
                if stream is not None:
                    stream.close()
        return status


class Terminal:
    """The program on a terminal. What it has written, control sequences included: `seen` since the last key, `written` ever."""

    def __init__(self, *arguments, width=80, height=24, **environment):
        self.ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", height, width, 0, 0))
        self.process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdin=theirs, stdout=theirs,
                                        stderr=subprocess.PIPE, start_new_session=True,
                                        env={**os.environ, "TERM": "xterm", "LANG": "C.UTF-8", **environment})
        os.close(theirs)
        self.seen = self.written = b""

    def read(self, seconds):
        """Read until then. Gives whether there was something."""
        if not select.select([self.ours], [], [], max(0, seconds))[0]:
            return False
        try:
            news = os.read(self.ours, 65536)
        except OSError:  # the other end is closed
            return False
        self.seen += news
        self.written += news
        return True

    def wait_for(self, expression, timeout=TIMEOUT):
        """Read until it is there. Gives the time when it was."""
        end = time.monotonic() + timeout
        while not re.search(expression, self.seen):
            if time.monotonic() > end or (not self.read(end - time.monotonic()) and self.process.poll() is not None):
                raise AssertionError("no %r in %r" % (expression, self.seen[-3000:]))
        return time.monotonic()

    def press(self, keys):
        self.seen = b""
        os.write(self.ours, keys)

    def end(self, timeout=TIMEOUT):
        """Wait for the end. Gives exit status and standard error."""
        deadline = time.monotonic() + timeout
        while self.process.poll() is None and time.monotonic() < deadline:
            self.read(0.05)
        while self.read(0.05):
            pass
        errors = self.process.communicate(timeout=timeout)[1]
        return self.process.returncode, errors.decode()

    def close(self):
        self.process.kill()
        self.process.communicate()
        os.close(self.ours)


class Case(unittest.TestCase):
    """A test that closes what it opens, and has a folder. It is run again when the machine was delayed."""

    def __init_subclass__(cls):
        for name, member in list(vars(cls).items()):
            if name.startswith("test_"):
                setattr(cls, name, on_time(member))

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="host_sim.")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check_every_run(self):
        """What must be true after each test."""

    def at_most(self, limit, measured, what):
        """Of times in seconds."""
        if measured > limit:
            raise Late("%s took %.1f ms, more than %.1f" % (what, 1000 * measured, 1000 * limit))

    def bus(self, interface="vcan0"):
        bus = Bus(interface)
        self.addCleanup(bus.close)
        return bus

    def start(self, *arguments, **options):
        process = Process(*arguments, **options)
        self.addCleanup(process.end, signal.SIGKILL)
        return process

    def terminal(self, *arguments, **options):
        terminal = Terminal(*arguments, **options)
        self.addCleanup(terminal.close)
        return terminal

    def run_to_end(self, *arguments, timeout=TIMEOUT):
        """Exit status, standard output and standard error of a run that ends by itself."""
        done = subprocess.run([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=timeout, check=False, text=True)
        return done.returncode, done.stdout, done.stderr


def ip(*arguments):
    """Change the network: ip("link", "set", "vcan2", "down")."""
    subprocess.run(["ip", *arguments], check=True, timeout=TIMEOUT)


def of(frames, can_id):
    """The frames with this identifier."""
    return [frame for frame in frames if frame.id == can_id]
