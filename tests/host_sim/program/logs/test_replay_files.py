"""`host_sim replay`: the log as a file, and files that are written whole or not at all."""
import gzip
import os
import re
import resource
import signal
import subprocess
import time
import unittest

import hostsim
import traffic

LOG = traffic.log(traffic.frames(500))


class StandardInput(hostsim.Case):
    def test_a_log_from_standard_input(self):
        plain = self.replay(LOG)
        texts = plain.text("events.jsonl"), plain.text("out.log")
        piped = self.run_good("replay", "--events", "events.jsonl", "--out", "out.log", "-", stdin=LOG.encode())
        self.assertEqual((piped.text("events.jsonl"), piped.text("out.log")), texts)

    def test_no_input(self):
        for arguments, stdin in (((), b""), (("--skip-bad-lines",), b"nonsense\n" * 5)):
            self.assert_refused(self.run_program("replay", *arguments, "-", stdin=stdin), "standard input: contains no frame")


class Outputs(hostsim.Case):
    def test_nothing_is_left_of_a_run_that_fails(self):
        log = LOG + "nonsense\n"
        self.assert_refused(self.refuse(log), ":356: ")
        for name in hostsim.OUTPUTS.values():
            self.write(name, "agv-store old")
        for bad in (log, "", "\0\1\2", gzip.compress(LOG.encode())[:500]):
            self.assertEqual(self.refuse(bad).status, 2)
            for name in hostsim.OUTPUTS.values():
                self.assertEqual(self.read(name), "agv-store old")

    def test_where_nothing_can_be_written(self):
        self.write("log", LOG)
        for option in ("--out", "--events", "--store", "--why", "--report", "--trace"):
            for path, reason in (("none/file", "No such file or directory"), ("log/file", "Not a directory"),
                                 (".", "Is a directory"), ("/dev/full", "No space left on device")):
                result = self.run_program("replay", option, path, "log")
                self.assert_refused(result, path, reason)
        self.assertEqual(self.files(), ["log"])

    def test_a_pipe_and_a_device_are_written_directly(self):
        self.write("log", LOG)
        os.mkfifo(self.folder / "pipe")
        with subprocess.Popen(["cat", "pipe"], cwd=self.folder, stdout=subprocess.PIPE) as reader:
            try:
                self.run_good("replay", "--out", "pipe", "--events", "/dev/null", "log")
            except BaseException:
                reader.kill()  # it would wait for a writer for ever
                raise
            self.assertIn(b"(1700000000.000000) can0 43F#", reader.communicate()[0])
        self.assertEqual(self.files(), ["log", "pipe"])
        result = self.run_good("replay", "--events", "/dev/stdout", "log")
        self.assertTrue(result.stdout.startswith('{"t_ms": 0'))

    def test_a_file_is_one_also_as_standard_input_or_output(self):
        self.write("log", LOG)
        with open(self.folder / "log", "rb") as log:
            result = subprocess.run([hostsim.PROGRAM, "replay", "--out", "log", "-"], cwd=self.folder, stdin=log,
                                    stderr=subprocess.PIPE, check=False)
            self.assertEqual((result.returncode, b"LOG and --out are the same file" in result.stderr), (2, True))
        with open(self.folder / "both", "wb") as both:
            result = subprocess.run([hostsim.PROGRAM, "replay", "--out", "-", "--events", "both", "log"], cwd=self.folder,
                                    stdout=both, stderr=subprocess.PIPE, check=False)
            self.assertEqual((result.returncode, b"same file" in result.stderr), (2, True), result.stderr)
        self.assertEqual(self.read("log"), LOG)

    def test_a_link_to_nothing_is_not_replaced(self):
        self.write("log", LOG)
        os.symlink("nothing", self.folder / "link")
        self.assert_refused(self.run_program("replay", "--out", "link", "log"), "link: No such file")
        self.assertEqual(os.readlink(self.folder / "link"), "nothing")

    def test_a_signal_leaves_nothing_behind(self):
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))  # for SIGQUIT
        for number, ends_input in ((signal.SIGINT, False), (signal.SIGTERM, False), (signal.SIGHUP, False),
                                   (signal.SIGQUIT, False), (signal.SIGINT, True)):  # Ctrl-C hits both ends of a pipe
            with subprocess.Popen([hostsim.PROGRAM, "replay", "--out", "out", "--events", "events", "-"],
                                  cwd=self.folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as program:
                program.stdin.write(LOG.encode())
                program.stdin.flush()
                deadline = time.monotonic() + 30
                while len(self.files()) < 2 and time.monotonic() < deadline:
                    time.sleep(0.01)
                self.assertEqual(len(self.files()), 2)  # both under their temporary names
                program.send_signal(number)
                if ends_input:
                    program.stdin.close()
                self.assertEqual(program.wait(timeout=30), -number)
                self.assertEqual(program.stderr.read(), b"")
            self.assertEqual(self.files(), [])


class Memory(hostsim.Case):
    def peak_kib(self, seconds):
        """Peak resident set, read when all but the end of the log has gone in."""
        block = traffic.log(traffic.frames(25000))
        with subprocess.Popen([hostsim.PROGRAM, "replay", "--out", "out", "--events", "events", "-"], cwd=self.folder,
                              stdin=subprocess.PIPE) as program:
            program.stdin.write(traffic.repeated(block, seconds // 25).encode())
            program.stdin.flush()
            with open("/proc/%d/status" % program.pid, encoding="ascii") as status:
                peak = int(re.search(r"VmHWM:\s*(\d+) kB", status.read())[1])
            program.stdin.close()
            self.assertEqual(program.wait(timeout=120), 0)
        return peak

    def test_a_longer_log_takes_no_more_memory(self):
        short = self.peak_kib(50)
        long = self.peak_kib(1000)
        self.assertLess(long, short + 512)


if __name__ == "__main__":
    unittest.main()
