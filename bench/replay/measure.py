"""The measurement of bench/replay/run. Linux only: the peak memory is read from /proc."""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "host_sim" / "program"))
import traffic  # noqa: E402

BLOCK_MS = 25600  # a multiple of all alive counters' periods, so that the blocks can be joined
RUNS = 5
MEMORY_MARGIN_KIB = 1024
CHUNK = 1 << 20


def make_log(path, seconds):
    """Healthy traffic; returns (frames, seconds)."""
    blocks = -(-seconds * 1000 // BLOCK_MS)
    manual = traffic.frames(BLOCK_MS)
    engaged = traffic.frames(BLOCK_MS, engage_ms=0)
    with open(path, "w", encoding="ascii") as log:
        for number in range(blocks):
            log.write(traffic.log(engaged if number else manual, traffic.BASE_US + number * BLOCK_MS * 1000))
    return len(manual) * blocks, blocks * BLOCK_MS / 1000


def check(process, text):
    if process.returncode != 0 or "tripped     never" not in text or "ACTIVE 0.00" in text:
        sys.exit("bench/replay: the traffic is not healthy:\n" + text)


def replay(program, log):
    """(CPU seconds, elapsed seconds)"""
    begin = os.times().elapsed
    with subprocess.Popen([program, "replay", "--tail", "0", log], stdout=subprocess.PIPE, text=True) as process:
        text = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    check(process, text)
    return usage.ru_utime + usage.ru_stime, os.times().elapsed - begin


def peak_memory(program, log):
    """Peak resident set in KiB, read when all but the end of the log is written."""
    with subprocess.Popen([program, "replay", "--tail", "0", "-"], stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE) as process, open(log, "rb") as source:
        while chunk := source.read(CHUNK):
            process.stdin.write(chunk)
        process.stdin.flush()
        status = pathlib.Path("/proc/%d/status" % process.pid).read_text(encoding="ascii")
        text = process.communicate()[0].decode()
    check(process, text)
    return int(re.search(r"VmHWM:\s*(\d+) kB", status)[1])


def main():
    parser = argparse.ArgumentParser(prog="bench/replay/run", description="Measure host_sim replay.")
    parser.add_argument("--host-sim", default=REPOSITORY / "build/fast/bin/host_sim", metavar="PROGRAM")
    parser.add_argument("--least", type=float, default=2000, metavar="N", help="times real time (2000)")
    parser.add_argument("--seconds", type=int, default=3600, metavar="N", help="length of the log (3600)")
    arguments = parser.parse_args()
    if not os.access(arguments.host_sim, os.X_OK):
        print("bench/replay: %s does not exist: cmake --build --preset fast" % arguments.host_sim, file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="bench_replay.") as folder:
        log = os.path.join(folder, "hour.log")
        frames, seconds = make_log(log, arguments.seconds)
        cpu, elapsed = min(replay(arguments.host_sim, log) for _ in range(RUNS))
        memory = peak_memory(arguments.host_sim, log)
        make_log(log, arguments.seconds * 10)
        long_memory = peak_memory(arguments.host_sim, log)
    print("log        %d frames in %.1f s" % (frames, seconds))
    print("replay     %.2f s CPU, %.2f s elapsed" % (cpu, elapsed))
    print("speed      %.0f times real time, %.2f million frames a second" % (seconds / cpu, frames / cpu / 1e6))
    print("memory     %d KiB; ten times the log: %d KiB" % (memory, long_memory))
    problems = []
    if seconds / cpu < arguments.least:
        problems.append("slower than %.0f times real time" % arguments.least)
    if long_memory > memory + MEMORY_MARGIN_KIB:
        problems.append("memory grows with the log")
    for problem in problems:
        print("bench/replay: " + problem, file=sys.stderr)
    return 1 if problems else 0


sys.exit(main())
