"""The part of bench/vcan/run that runs where the interfaces are."""
import argparse
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PYTHON = "/usr/bin/python3"
BLOCK = 10  # trials of a subject before the next subject's turn
P999_FROM = 1000  # samples

# 1 Mbit/s: 8 bytes of data are 108 bits, 3 between frames, and at worst (34 + 64 - 1) / 4 = 24 bits of stuffing: 135 bits.
FULL_LOAD = 1000000 // 135
REGULAR = 710
RATES = (800, 1000, 1250, 1600, 2000, 2500, 3200, 4000, 5000, 6400, 8000, 10000, 12500, 16000, 20000)
LATE_MS = 5  # the self-test
SENDER_SHARE = 0.98  # of the requested rate that must be reached

KINDS = {"frame": "from the fault's frame (167h, EPS fault)", "silence": "from an expired deadline (065h, 125 ms)"}


class Failure(Exception):
    pass


class Subject:
    """A measured program, with the program that simulates the vehicle for it."""

    def __init__(self, name, programs, options, interface, command):
        self.name = name
        self.errors = tempfile.TemporaryFile()
        self.player = subprocess.Popen([programs / "bench_vcan_traffic", *options, interface, *command],
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors, text=True)

    def ask(self, line):
        """The words of each line of the answer."""
        try:
            self.player.stdin.write(line + "\n")
            self.player.stdin.flush()
        except BrokenPipeError:
            pass
        answer = []
        for answered in self.player.stdout:
            if answered == "done\n":
                return answer
            answer.append(answered.split())
        self.errors.seek(0)
        raise Failure("%s, '%s': %s" % (self.name, line, self.errors.read().decode(errors="replace").strip()[-500:]))

    def close(self):
        self.player.stdin.close()
        self.player.wait()


def subjects_of(args, programs):
    """The programs for the shared bus, each on an interface of its own."""
    echo = [programs / "bench_vcan_echo", "vcan2"]
    host_sim = [programs / "host_sim", "run", "--can", "vcan0", "--events", "-", "--config", programs / "fast.yaml"]
    if args.realtime:
        host_sim.append("--realtime")
    peer = [PYTHON, "-B", HERE / "peer_python.py", "--init-hold-ms", "100", "--reset-hold-ms", "10", "vcan1"]
    return [Subject(" ".join(["host_sim run"] + ["--realtime"] * args.realtime), programs, [], "vcan0", host_sim),
            Subject("python-can peer", programs, ["--keep"], "vcan1", peer),
            Subject("C echo", programs, ["--keep", "--stateless"], "vcan2", echo)]


# ---- figures ----

def percentile(values, share):
    """The lowest measured value that this share of the values does not exceed."""
    return sorted(values)[math.ceil(share * len(values)) - 1]


def ms(nanoseconds):
    return "%.3f" % (nanoseconds / 1e6)


def columns(values):
    """Median, p99, p99.9, largest."""
    if not values:
        return ["-"] * 4
    p999 = ms(percentile(values, 0.999)) if len(values) >= P999_FROM else "-"
    return [ms(percentile(values, 0.5)), ms(percentile(values, 0.99)), p999, ms(max(values))]


def row(name, *cells):
    print("  %-22s" % name + "".join("%10s" % cell for cell in cells), flush=True)


def heading(text):
    print("\n" + text, flush=True)


def note(text):
    print("bench/vcan: " + text, file=sys.stderr, flush=True)


# ---- reactions ----

class Reactions:
    def __init__(self):
        self.first, self.gear, self.repeated, self.missed = [], [], 0, 0

    def add(self, answer):
        for words in answer:
            if words[0] == "first":
                self.first.append(int(words[1]))
                self.gear.append(int(words[3]))
            else:
                setattr(self, words[0], getattr(self, words[0]) + int(words[1]))


def measure_reactions(subjects, trials):
    """In blocks, one subject after the other, so that noise hits all alike."""
    results = {(subject.name, kind): Reactions() for subject in subjects for kind in KINDS}
    for subject in subjects:
        subject.ask("frame 1")  # not counted, because all caches are cold
    for done in range(0, trials, BLOCK):
        note("%d of %d trials" % (done, trials))
        for subject in subjects:
            for kind in KINDS:
                results[subject.name, kind].add(subject.ask("%s %d" % (kind, min(BLOCK, trials - done))))
    return results


def print_reactions(subjects, results):
    for kind, what in KINDS.items():
        heading("Reaction, ms, " + what)
        row("to the first safe frame", "trials", "median", "p99", "p99.9", "largest", "repeated", "missed")
        for subject in subjects:
            result = results[subject.name, kind]
            row(subject.name, len(result.first), *columns(result.first), result.repeated, result.missed)
        row("to gear P (168h)")
        for subject in subjects:
            row(subject.name, len(results[subject.name, kind].gear), *columns(results[subject.name, kind].gear))


# ---- gateway ----

def gateway_figures(subject, duration_ms):
    answer = subject.ask("pass %d" % duration_ms)
    subject.close()
    return {name: [int(words[1]) for words in answer if words[0] == name] for name in ("status", "command", "lost")}


def cangw_rules(action):
    for source, sink in (("vcan1", "vcan0"), ("vcan0", "vcan1")):
        subprocess.run(["cangw", action, "-s", source, "-d", sink, "-e"], check=True, capture_output=True, text=True)


def kernel_gateway(programs, duration_ms):
    """(figures, reason without figures)"""
    if shutil.which("cangw") is None:
        return None, "'cangw' is missing (can-utils)"
    try:
        cangw_rules("-A")
    except subprocess.CalledProcessError as error:
        return None, "cangw: " + (error.stderr.strip() or "no rule was accepted: is the module can-gw loaded?")
    try:
        subject = Subject("cangw", programs, ["--stateless", "--ai", "vcan0"], "vcan1", [])
        return gateway_figures(subject, duration_ms), None
    finally:
        cangw_rules("-D")


def measure_gateway(programs, duration_ms):
    command = [programs / "host_sim", "run", "--topology", "gateway", "--can", "vcan1", "--ai-can", "vcan0", "--events",
               "-", "--config", programs / "fast.yaml"]
    own = gateway_figures(Subject("host_sim run", programs, ["--ai", "vcan0"], "vcan1", command), duration_ms)
    kernel, why = kernel_gateway(programs, duration_ms)
    heading("Gateway, ms from one side to the other, %d frames/s, engaged" % REGULAR)
    for name, what in (("status", "101h to the AI side"), ("command", "065h to the vehicle")):
        row(what, "frames", "median", "p99", "p99.9", "largest")
        row("host_sim run", len(own[name]), *columns(own[name]))
        if kernel:
            row("cangw (kernel)", len(kernel[name]), *columns(kernel[name]))
    row("lost", own["lost"][0], *([kernel["lost"][0]] if kernel else []))
    if why:
        print("  no figures for cangw: " + why)


# ---- rates ----

class Flood:
    def __init__(self, subject, rate, duration_ms):
        words = subject.ask("flood %d %d" % (rate, duration_ms))[0]
        said = dict(zip(words[::2], map(int, words[1::2])))
        self.rate = said["sent"] / (said["ns"] / 1e9)
        self.cpu = said["cpu_ns"] / said["ns"]
        self.lost, self.tripped = said["lost"], said["tripped"]
        self.held = self.lost == 0 and not self.tripped


def highest_rate(subject, rates, duration_ms):
    """(highest rate that was held, reason why the next one was not)"""
    low, high, why = -1, len(rates), "end of the list"
    while high - low > 1:
        middle = (low + high) // 2
        flood = Flood(subject, rates[middle], duration_ms)
        said = "at %d frames/s %.0f sent, %d lost%s" % (rates[middle], flood.rate, flood.lost,
                                                              ", tripped" if flood.tripped else "")
        note(subject.name + ": " + said)
        if flood.held and flood.rate >= SENDER_SHARE * rates[middle]:
            low = middle
        else:
            high, why = middle, said
    return rates[low] if low >= 0 else 0, why


def measure_rates(subjects, rates, duration_ms):
    heading("Frames a second held for %g s: every one received, no trip" % (duration_ms / 1000))
    for subject in subjects:
        rate, why = highest_rate(subject, rates, duration_ms)
        row(subject.name, rate, "   then: " + why)


def measure_load(subjects, duration_ms):
    heading("Share of one core, user and system, in %g s" % (duration_ms / 1000))
    row("", "wanted", "sent/s", "CPU", "lost", "tripped")
    for rate in (REGULAR, FULL_LOAD):
        for subject in subjects:
            flood = Flood(subject, rate, duration_ms)
            row(subject.name, rate, "%.0f" % flood.rate, "%.1f%%" % (flood.cpu * 100), flood.lost,
                "yes" if flood.tripped else "no")


# ---- the run ----

def processor():
    for line in open("/proc/cpuinfo", encoding="ascii", errors="replace"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return os.uname().machine


def print_header(args):
    print("kernel      %s" % os.uname().release)
    print("processor   %s; cores: %d" % (processor(), os.cpu_count()))
    print("vcan        in a %s" % args.provided)
    if "machine" in args.provided:
        print("            figures on vcan in an emulator only compare the programs; they are not those of a controller")


def self_test(programs):
    """The figures must show a subject that answers 5 ms late, and one that never answers."""
    options = ["--keep", "--stateless"]
    echo = Subject("C echo", programs, options, "vcan0", [programs / "bench_vcan_echo", "vcan0"])
    late = Subject("C echo, late", programs, options, "vcan1", [programs / "bench_vcan_echo", "vcan1", str(LATE_MS)])
    never = Subject("never", programs, options, "vcan2", ["sleep", "1000"])
    results = {subject: Reactions() for subject in (echo, late, never)}
    for subject, trials in ((echo, 5), (late, 5), (echo, 5), (late, 5), (never, 1)):
        results[subject].add(subject.ask("frame %d" % trials))
    for subject in results:
        subject.close()
    for subject in (echo, late):
        first = results[subject].first
        print("%-13s %2d reactions, shortest %s ms, median %s ms" % (subject.name, len(first), ms(min(first)),
                                                                     ms(percentile(first, 0.5))))
    print("%-13s %2d missed of 1" % (never.name, results[never].missed))
    seen = min(results[late].first) >= LATE_MS * 1e6 > min(results[echo].first) > 0
    return seen and len(results[echo].first) == len(results[late].first) == 10 and results[never].missed == 1


def measure(args, programs):
    print_header(args)
    subjects = subjects_of(args, programs)
    results = measure_reactions(subjects, args.trials)
    print_reactions(subjects, results)
    subjects.pop().close()  # the echo does not count received frames
    measure_gateway(programs, args.gateway_ms)
    measure_rates(subjects, RATES[::3] if args.quick else RATES, args.rate_ms)
    measure_load(subjects, args.load_ms)
    for subject in subjects:
        subject.close()
    return all(result.missed == 0 for result in results.values())


def main():
    parser = argparse.ArgumentParser(prog="bench/vcan/run")
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("--provided", required=True)
    parser.add_argument("--trials", type=int, default=80)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--realtime", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    args = parser.parse_args()
    args.gateway_ms, args.rate_ms, args.load_ms = (1000, 500, 1000) if args.quick else (10000, 3000, 10000)
    # In memory, because a program starts far faster from there than from the shared folders of a virtual machine.
    with tempfile.TemporaryDirectory(prefix="bench_vcan.", dir="/dev/shm") as folder:
        programs = pathlib.Path(folder)
        for name in ("host_sim", "bench_vcan_traffic", "bench_vcan_echo"):
            if (args.programs / name).exists():
                shutil.copy(args.programs / name, programs)
        (programs / "fast.yaml").write_text("init_hold_ms: 100\n")  # short, because host_sim is started for every trial
        try:
            return 0 if (self_test(programs) if args.self_test else measure(args, programs)) else 1
        except Failure as failure:
            print("bench/vcan: " + str(failure), file=sys.stderr)
            return 2


sys.exit(main())
