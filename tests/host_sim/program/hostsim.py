"""Runs the built program from outside. HOST_SIM in the environment is its path."""
import contextlib
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["HOST_SIM"]
STUBS = {name: os.environ.get("HOST_SIM_" + name.upper()) for name in ("mute", "tripped")}  # with a stub supervisor
PART = int(os.environ.get("HOST_SIM_PART", "1"))  # long runs do so small a part: a program full of checks is ten times slower

SCENARIOS = pathlib.Path(__file__).resolve().parents[3] / "host_sim" / "scenarios"
SHIPPED = sorted(SCENARIOS.glob("*/*.yaml"))
LEAST = 330  # of them; with fewer a test is wrong. Also read by tests/web/test_module.mjs

OUTPUTS = {"--events": "events.jsonl", "--out": "out.log", "--store": "store", "--why": "why.json", "--report": "report.html",
           "--trace": "trace.json"}

SENT = re.compile(r"\((\d{10,})\.(\d{6})\) (\S+) ([0-9A-F]{3})#((?:[0-9A-F]{2})*)")


def cpu_s_of(pid):
    """Processor time of a running process so far, in seconds."""
    with open(f"/proc/{pid}/schedstat", encoding="ascii") as file:
        return int(file.read().split()[0]) / 1e9


class Sent:
    """One line of an OUT log."""

    def __init__(self, line):
        match = SENT.fullmatch(line)
        assert match, line
        self.us = int(match[1]) * 1000000 + int(match[2])
        self.interface = match[3]
        self.can_id = int(match[4], 16)
        self.data = bytes.fromhex(match[5])

    def __repr__(self):
        return "(%d) %s %03X#%s" % (self.us, self.interface, self.can_id, self.data.hex())


class Result:
    """What a run came to."""

    def __init__(self, status, stdout, stderr, folder):
        self.status = status
        self.stdout = stdout
        self.stderr = stderr
        self.folder = folder

    def text(self, name):
        return (self.folder / name).read_text(encoding="ascii")

    def sent(self, name="out.log"):
        return [Sent(line) for line in self.text(name).splitlines()]

    def events(self, name="events.jsonl"):
        return [json.loads(line) for line in self.text(name).splitlines()]

    def of(self, kind):
        return [event for event in self.events() if event["event"] == kind]

    def summary(self):
        return self.events()[-1]

    def trips(self):
        """(t_ms, reason) of every trip."""
        return [(event["t_ms"], event["reason"]) for event in self.of("state") if event["reason"]]

    def faults(self, active=True):
        return [(event["t_ms"], event["name"], event["class"]) for event in self.of("fault")
                if event["active"] == active]


class Case(unittest.TestCase):
    """A test with a folder of its own, in which the program runs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="host_sim.")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
        return path

    def read(self, name):
        return (self.folder / name).read_text(encoding="utf-8")

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def run_program(self, *arguments, stdin=b"", timeout=120, program=PROGRAM, **options):
        options.setdefault("stdout", subprocess.PIPE)
        done = subprocess.run([program, *map(str, arguments)], input=stdin, stderr=subprocess.PIPE, timeout=timeout,
                              cwd=self.folder, check=False, **options)
        stdout = (done.stdout or b"").decode("utf-8", "replace")
        return Result(done.returncode, stdout, done.stderr.decode("utf-8", "replace"), self.folder)

    def run_good(self, *arguments, **options):
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.status, 0, result.stderr)
        return result

    def least_cpu_s(self, limit, *arguments):
        """Processor time of a good run, in seconds. Up to three runs, while it exceeds the limit: other programs make it more."""
        least = float("inf")
        for _ in range(3):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            self.run_good(*arguments)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            least = min(least, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
            if least < limit:
                break
        return least

    def commands(self):
        """The names of all commands."""
        commands = re.findall(r"^  ([a-z]+) {2,}\S", self.run_good("--help").stdout, re.MULTILINE)
        self.assertGreater(len(commands), 10)
        return commands

    def wait_until_it_looks_for_signals(self, pid):
        """A program that is still being loaded would be killed without a word."""
        for _ in range(1000):
            with open(f"/proc/{pid}/status", encoding="ascii") as status:
                blocked = int(re.search(r"^SigBlk:\s+(\w+)$", status.read(), re.MULTILINE)[1], 16)
            if blocked & (1 << (signal.SIGINT - 1)) != 0:
                return
            time.sleep(0.05)
        self.fail("it does not look for SIGINT")

    def wait_until_it_has_a_lock(self, pid):
        for _ in range(1000):
            for about in pathlib.Path(f"/proc/{pid}/fdinfo").iterdir():
                try:
                    if "FLOCK" in about.read_text(encoding="ascii"):
                        return
                except FileNotFoundError:  # closed meanwhile
                    pass
            time.sleep(0.05)
        self.fail("it has no lock")

    @contextlib.contextmanager
    def in_the_background(self, *arguments):
        """A run that has locked its checkpoint. It is killed at the end."""
        with subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            try:
                self.wait_until_it_has_a_lock(process.pid)
                yield process
            finally:
                process.kill()

    def other_build(self):
        """A program that does the same and is another file."""
        other = self.write("other_build", pathlib.Path(PROGRAM).read_bytes() + b"\0")
        other.chmod(0o755)
        return other

    def assert_refused(self, result, *parts):
        """Exit status 2, and one line on standard error that names the thing."""
        self.assertEqual(result.status, 2, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.endswith("\n"))
        for part in parts:
            self.assertIn(part, result.stderr)

    def replay(self, log, *arguments, name="log", **options):
        """Replay a log, with all outputs; must succeed."""
        self.write(name, log)
        return self.run_good("replay", "--events", "events.jsonl", "--out", "out.log", *arguments, name, **options)

    def refuse(self, log, *arguments, **options):
        """Replay a log that is refused: nothing is written."""
        self.write("log", log)
        before = self.files()
        others = [word for option, file in OUTPUTS.items() if option not in arguments for word in (option, file)]
        result = self.run_program("replay", *others, *arguments, "log", **options)
        self.assertEqual(self.files(), before)
        return result
