"""The bench of a mutant: the core as a shared object under the test programs, and which test runs which line.

Everything lies in build/mutation: tree (the build tree, preset mutation), core (the object of each file), sanitized (the same
with sanitizers), plan.json (the tests with their times, and the lines that each runs), work-* (a mutant's object).
"""
import collections
import fcntl
import hashlib
import json
import math
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = ROOT / "build/mutation"
TREE = BUILD / "tree"
CORE = BUILD / "core"
SANITIZED = BUILD / "sanitized"
SOURCES = ROOT / "firmware/src"
# What a verdict rests on. Not the equivalents: they are asked for when results are merged.
INPUTS = ("CMakePresets.json", "cmake", "firmware", "hal/include", "hal/sim", "tests/unit", "tests/integration",
          "tests/ports/sim", "tests/ports/template", "tests/support", "tests/fuzz/fuzz_supervisor.c", "tests/fuzz/input.h",
          "tests/proofs/mutation/mutants.py", "tests/proofs/mutation/bench.py",
          "tests/proofs/mutation/stop_at_failure.c")
INCLUDES = [f"-I{ROOT}/firmware/include", f"-I{SOURCES}", f"-I{ROOT}/hal/include"]
COMPILE = ["gcc", "-std=c11", "-w", "-fPIC", "-fno-semantic-interposition", *INCLUDES]
LINK = ["ld", "-shared", "-Bsymbolic"]
SANITIZE = ["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
FOUND = 77  # exit status of a program in which a sanitizer found something
SLOW_SECONDS = 1.0  # which lines such a test runs is not asked: it is taken to run all
QUICK_SECONDS = 0.3  # tests that take longer, and those from other starts of the clock, run last
START_SECONDS, LIKELY = 0.01, 0.3  # of a program; how likely it is to kill when nothing is known
CRASHES, TIMEOUTS = 12, 3  # after so many nobody waits any more for an assertion that fails

# what a test program did: passed, failed (an assertion, by: where), crash, timeout, or sanitizer (one found something)
Run = collections.namedtuple("Run", "verdict by failures")


def digest():
    """Names the state of all that decides on a verdict."""
    total = hashlib.sha256()
    for name in INPUTS:
        path = ROOT / name
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.is_file() and "__pycache__" not in file.parts:
                total.update(f"{file.relative_to(ROOT)}\0".encode() + file.read_bytes())
    return total.hexdigest()[:12]


def call(command, **more):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, **more)


def compile_file(source, output, *options):
    """Whether it compiles."""
    command = [*COMPILE, *(options or ("-O1",)), "-c", str(source), "-o", str(output)]
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def core_files():
    """Of all rooms; a file is named by its name alone, which is there once."""
    return sorted(SOURCES.rglob("*.c"))


class Bench:
    """Prepares what is not prepared yet (one process at a time), and tries."""

    def __init__(self, say=print):
        BUILD.mkdir(parents=True, exist_ok=True)
        with open(BUILD / "lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.digest = digest()
            try:
                self.plan = json.loads((BUILD / "plan.json").read_text(encoding="utf-8"))
            except (OSError, ValueError):
                self.plan = {}
            if self.plan.get("digest") != self.digest:
                self.plan = prepare(self.digest, self.plan, say)
                (BUILD / "plan.json").write_text(json.dumps(self.plan), encoding="utf-8")
        self.tries = collections.defaultdict(collections.Counter)  # of mutants of a function: how often each test ran,
        self.kills = collections.defaultdict(collections.Counter)  # and how often it killed
        self.sources = {path.name: path.read_text(encoding="ascii") for path in core_files()}  # they may change meanwhile
        self.work = pathlib.Path(tempfile.mkdtemp(prefix="work-", dir=BUILD))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.work)

    def build(self, name, text):
        """Make the core with another text of one file; whether it compiles."""
        source = self.work / name
        source.write_text(text, encoding="ascii")
        if not compile_file(source, self.work / "mutant.o"):
            return False
        call([*LINK, str(self.work / "mutant.o"), str(CORE / f"without-{name}.o"), "-o", str(self.work / "libagv_core.so")])
        return True

    def same_code(self, name):
        """Whether the file that was built last is, optimised, the same machine code as the one of the project."""
        original, mutant = self.work / "original.O2", self.work / "mutant.O2"
        reference = self.work / "reference" / name  # an object keeps the name of its source
        reference.parent.mkdir(exist_ok=True)
        reference.write_text(self.sources[name], encoding="ascii")
        compile_file(reference, original, "-O2")
        return compile_file(self.work / name, mutant, "-O2") and original.read_bytes() == mutant.read_bytes()

    def sanitized(self, name, tests):
        """The first of the tests in which a sanitizer finds something, or nothing; of the file that was built last."""
        if not compile_file(self.work / name, self.work / "mutant.san.o", *SANITIZE):
            raise SystemExit(f"{name}: the mutant compiles, but not with sanitizers")
        others = [SANITIZED / f"{path.stem}.o" for path in core_files() if path.name != name]
        link_sanitized([self.work / "mutant.san.o", *others], self.work / "sanitized")
        found = (test["name"] for test in tests if run_sanitized(test, self.work / "sanitized").verdict == "sanitizer")
        return next(found, "")

    def run(self, test, go_on=False):
        return run_test(test, self.work, go_on)

    def tests_for(self, name, lines, function):
        """Those that run one of the lines: first those that kill soonest, by what they did in this function so far."""
        covering = self.plan["lines"].get(name, {})
        indices = set().union(*(covering.get(str(line), ()) for line in range(lines[0], lines[1] + 1)))
        slow = {index for index, test in enumerate(self.plan["tests"]) if test["seconds"] >= SLOW_SECONDS}
        if indices <= slow:
            indices = set(range(len(self.plan["tests"])))  # a table: gcov counts no lines there
        tests = [test for index, test in enumerate(self.plan["tests"]) if index in indices]
        kills, tries = self.kills[name, function], self.tries[name, function]
        return sorted(tests, key=lambda test: (test["seconds"] + START_SECONDS) * (tries[test["name"]] + 1)
                      / (kills[test["name"]] + LIKELY))

    def kill(self, mutant, tests, counts):
        """Run until an assertion fails: where, or nothing."""
        for test in tests:
            run = self.run(test)
            counts[run.verdict] += 1
            self.tries[mutant.file, mutant.function][test["name"]] += 1
            if run.verdict == "failed":
                self.kills[mutant.file, mutant.function][test["name"]] += 1
                return run.by
            if counts["crash"] >= CRASHES or counts["timeout"] >= TIMEOUTS:
                break
        return ""

    def try_mutant(self, mutant, only_quick=False):
        """killed, survived, same, sanitizer, compile, crash or timeout, or open when only quick tests were to run; and by whom."""
        source = self.sources[mutant.file]
        if not self.build(mutant.file, source[:mutant.start] + mutant.text + source[mutant.end:]):
            return "compile", ""
        tests = self.tests_for(mutant.file, mutant.lines, mutant.function)
        quick = [test for test in tests if test["seconds"] < QUICK_SECONDS and not test["environment"]]
        counts = collections.Counter()
        by = self.kill(mutant, quick, counts)
        if not by and not counts["crash"] and not counts["timeout"]:
            if self.same_code(mutant.file):
                return "same", ""
            found_by = self.sanitized(mutant.file, quick)
            if found_by:
                return "sanitizer", found_by
            if only_quick:
                return "open", ""
        by = by or self.kill(mutant, [test for test in tests if test not in quick], counts)
        return "killed" if by else next((kind for kind in ("crash", "timeout") if counts[kind]), "survived"), by


def link_sanitized(objects, folder):
    folder.mkdir(exist_ok=True)
    call(["gcc", "-shared", "-Wl,-Bsymbolic", *SANITIZE, *map(str, objects), "-o", str(folder / "libagv_core.so")])


def run_sanitized(test, library):
    """Only the core has sanitizers. The address sanitizer has to be loaded before all else."""
    loaded = subprocess.run(["gcc", "-print-file-name=libasan.so"], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    return run_test(test, library, more={"LD_PRELOAD": loaded, "ASAN_OPTIONS": f"detect_leaks=0:exitcode={FOUND}",
                                         "UBSAN_OPTIONS": f"exitcode={FOUND}"})


def run_test(test, library, go_on=False, more=None):
    """Limited by its time on the processor, not by that on the wall: others may be at work here."""
    environment = {**os.environ, **test["environment"], "LD_LIBRARY_PATH": str(library), **(more or {})}
    if go_on:
        environment["AGV_MUTATION_GO_ON"] = "1"
    seconds = 1 + math.ceil(5 * test["seconds"])
    done = subprocess.run([test["program"]], env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd=library,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1)))
    failures = [line.split("/")[-1] for line in done.stdout.decode("utf-8", "replace").splitlines() if ":FAIL" in line]
    if failures:
        return Run("failed", failures[0][:200], failures)
    if more and done.returncode == FOUND:
        return Run("sanitizer", "", [])
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return Run("timeout", "", [])
    return Run("crash" if done.returncode else "passed", "", [])


def prepare(key, old, say):
    """The plan: tests with their times, and the lines that they run. What is known of a program that stands is kept."""
    say("preparing: the build tree")
    call(["cmake", "--preset", "mutation"], cwd=ROOT)
    call(["cmake", "--build", str(TREE), "--target", "tests/unit/all", "tests/integration/all", "tests/ports/sim/all",
          "tests/ports/template/all", "tests/ports/stm32/all"])
    CORE.mkdir(exist_ok=True)
    for path in core_files():
        if not compile_file(path, CORE / f"{path.stem}.o"):
            raise SystemExit(f"{path} does not compile")
    objects = {path.name: str(CORE / f"{path.stem}.o") for path in core_files()}
    call([*LINK, *objects.values(), "-o", str(CORE / "libagv_core.so")])
    for name in objects:
        others = [path for other, path in objects.items() if other != name]
        call(["ld", "-r", *others, "-o", str(CORE / f"without-{name}.o")])
    tests = read_tests()
    prepare_sanitized()
    with tempfile.TemporaryDirectory(dir=BUILD) as folder:
        programs = measure(tests, old.get("programs", {}), pathlib.Path(folder), say)
    for test in tests:
        test["seconds"] = programs[test["name"].split("_wrap_in_")[0]]["seconds"]
    return {"digest": key, "tests": tests, "programs": programs, "lines": invert(tests, programs)}


def prepare_sanitized():
    SANITIZED.mkdir(exist_ok=True)
    objects = [SANITIZED / f"{path.stem}.o" for path in core_files()]
    for path, output in zip(core_files(), objects):
        compile_file(path, output, *SANITIZE)
    link_sanitized(objects, SANITIZED)


def measure(tests, old, folder, say):
    """Name of a program -> what it was when measured (sum), its time, and the lines that it runs (None: take it for all)."""
    build_covered(folder)
    core = (CORE / "libagv_core.so").read_bytes()
    programs = {}
    for test in tests:
        if test["environment"]:  # another start of the clock hardly runs other lines, or longer
            continue
        name = test["name"]
        total = hashlib.sha256(core + pathlib.Path(test["program"]).read_bytes()).hexdigest()
        programs[name] = old.get(name, {})
        if programs[name].get("sum") != total:
            say(f"preparing: {name}")
            seconds = time_test(test)
            if seconds < QUICK_SECONDS and run_sanitized(test, SANITIZED).verdict != "passed":
                raise SystemExit(f"{name} fails with sanitizers without any mutant")
            lines = covered_lines(test, folder) if seconds < SLOW_SECONDS else None
            programs[name] = {"sum": total, "seconds": seconds, "lines": lines}
    return programs


def time_test(test):
    """On the processor."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = run_test(test, CORE)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.verdict != "passed":
        raise SystemExit(f"{test['name']} fails without any mutant: {run}")
    return round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 3)


def invert(tests, programs):
    """file -> line -> indices of the tests that run it."""
    lines = {path.name: collections.defaultdict(list) for path in core_files()}
    for index, test in enumerate(tests):
        covered = programs[test["name"].split("_wrap_in_")[0]]["lines"]
        for path in core_files():
            count = path.read_bytes().count(b"\n")
            for number in range(1, count + 1) if covered is None else covered.get(path.name, ()):
                lines[path.name][str(number)].append(index)
    return lines


def read_tests():
    """What ctest would run of the folders unit and integration."""
    listed = subprocess.run(["ctest", "--show-only=json-v1", "-L", "unit$|integration$"], cwd=TREE, check=True,
                            stdout=subprocess.PIPE).stdout
    tests = []
    for test in json.loads(listed)["tests"]:
        properties = {item["name"]: item["value"] for item in test["properties"]}
        if {"unit", "integration"} & set(properties["LABELS"]):
            environment = dict(item.split("=", 1) for item in properties.get("ENVIRONMENT", ())
                               if item.startswith("AGV_TEST_"))
            tests.append({"name": test["name"], "program": test["command"][0], "environment": environment, "seconds": 30})
    return tests


def build_covered(folder):
    for path in core_files():
        compile_file(path, folder / f"{path.stem}.o", "-O0", "--coverage")
    objects = [str(folder / f"{path.stem}.o") for path in core_files()]
    call(["gcc", "-shared", "-Wl,-Bsymbolic", "--coverage", *objects, "-o", str(folder / "libagv_core.so")])


def covered_lines(test, folder):
    """file -> lines that it runs, by gcov."""
    for data in folder.glob("*.gcda"):
        data.unlink()
    run_test(test, folder)
    data = [path.name for path in folder.glob("*.gcda")]
    if not data:
        return {}  # nothing of the core
    out = subprocess.run(["gcov", "--json-format", "--stdout", *data], cwd=folder, check=True, stdout=subprocess.PIPE,
                         stderr=subprocess.DEVNULL).stdout
    covered = collections.defaultdict(list)
    known = {path.name for path in core_files()}
    for document in out.splitlines():
        for file in json.loads(document)["files"] if document.strip() else ():
            covered[pathlib.Path(file["file"]).name] += [line["line_number"] for line in file["lines"] if line["count"]]
    return {name: numbers for name, numbers in covered.items() if name in known}
