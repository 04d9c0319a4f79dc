"""For tests of times: when a busy machine delayed the programs, and only then, a failed test is run again."""
import functools
import os
import subprocess
import threading
import time

TRIES = 8
STALL_S = 0.012  # longer than that, and frames of the vehicle miss their cycle
NAP_S = 0.005


class Late(AssertionError):
    """An upper limit of a time was exceeded: a delayed machine exceeds it once, a wrong program every time."""


class Stalls:
    """Measures the delay on every processor."""

    def __init__(self):
        self.worst_s = 0
        self.ended = threading.Event()
        self.threads = [threading.Thread(target=self.measure, args=(cpu,)) for cpu in os.sched_getaffinity(0)]
        for thread in self.threads:
            thread.start()

    def measure(self, cpu):
        os.sched_setaffinity(threading.get_native_id(), {cpu})
        before = time.monotonic()
        while not self.ended.is_set():
            time.sleep(NAP_S)
            now = time.monotonic()
            self.worst_s = max(self.worst_s, now - before - NAP_S)
            before = now

    def stop(self):
        self.ended.set()
        for thread in self.threads:
            thread.join()
        return self.worst_s


def on_time(test):
    """A test method that is run again when it failed while the machine was delayed, at most TRIES times."""
    @functools.wraps(test)
    def run(self):
        for left in reversed(range(TRIES)):
            stalls = Stalls()
            try:
                test(self)
                self.check_every_run()
                return
            except (AssertionError, subprocess.TimeoutExpired) as failure:
                late_s = stalls.stop()
                if left == 0 or (late_s < STALL_S and not isinstance(failure, Late)):
                    raise
                print("held up for %d ms, again: %s" % (1000 * late_s, str(failure)[:200]), flush=True)
                self.doCleanups()
                self.setUp()
            finally:
                stalls.stop()
    return run
