#!/usr/bin/python3
"""Mutation testing of firmware/src; README.md beside this says what counts.

  mutate list [FILE...]                    the mutants, an id a line
  mutate prepare                           build what all shards need (they do it themselves, the first for all)
  mutate run [--shard i/n] [FILE...]       try those that have no result yet; results are appended to a file of lines
  mutate try ID...                         try some, and tell
  mutate merge [RESULTS...]                sum up; fails when a mutant survived or has no result, below 95 % or above 5 %
  mutate rows [ROW...]                     the stored mutants of seeded.tsv: each breaks its row, and a test notices
"""
import argparse
import collections
import json
import pathlib
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import bench  # noqa: E402
import mutants  # noqa: E402
import rows  # noqa: E402

KILLED_AT_LEAST, EQUIVALENT_AT_MOST = 95.0, 5.0
VERDICTS = ("killed", "crash", "timeout", "sanitizer", "survived")
NAMED = 5  # of many mutants with one problem, so many ids are printed


def say(text):
    print(text, file=sys.stderr, flush=True)


def refuse(text):
    say(f"mutate: {text}")
    sys.exit(2)


def check_files(names):
    known = [path.name for path in bench.core_files()]
    for name in names:
        if name not in known:
            refuse(f"there is no {name} in firmware/src")


def all_mutants(names=()):
    check_files(names)
    arguments = ["-std=c11", *bench.INCLUDES]
    return [mutant for path in bench.core_files() if not names or path.name in names
            for mutant in mutants.find(path, path.name, arguments)]


def read_results(paths):
    """id -> result; of several the last that is not open."""
    results = {}
    for path in paths:
        for result in read_lines(path):
            if result["verdict"] != "open" or result["id"] not in results:
                results[result["id"]] = result
    return results


def read_lines(path):
    """The results of a file. A line that was cut off when a run was stopped counts for nothing."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    results = [result for result in map(read_line, lines) if result]
    if len(lines) > 1 and not results:
        refuse(f"{path} is not a file of results")
    if len(results) < len(lines):
        say(f"{path.name}: {len(lines) - len(results)} broken lines are left out")
    return results


def read_line(line):
    """The result, or nothing."""
    try:
        result = json.loads(line)
    except ValueError:
        return None
    return result if isinstance(result, dict) and {"id", "verdict"} <= result.keys() else None


def results_folder(key):
    return bench.BUILD / "results" / key


def try_all(wanted, at, out, arguments):
    """Append a result a mutant to the open file."""
    equivalents = read_equivalents({mutant.id for mutant in wanted}, [])
    counts = collections.Counter()
    for number, mutant in enumerate(wanted, 1):
        begin = time.monotonic()
        verdict, by = at.try_mutant(mutant, only_quick=arguments.quick or mutant.id in equivalents)
        counts[verdict] += 1
        result = {"id": mutant.id, "verdict": verdict, "by": by, "seconds": round(time.monotonic() - begin, 2)}
        out.write(json.dumps(result) + "\n")
        out.flush()
        if number % 100 == 0:
            say(f"{number} of {len(wanted)}: {dict(counts)}")


def command_list(arguments):
    for mutant in all_mutants(arguments.names):
        print(mutant.id)


def command_prepare(arguments):
    if arguments.names:
        refuse("prepare takes no name")
    with open_bench(arguments):
        pass


def open_bench(arguments):
    at = bench.Bench(say)
    at.plan["tests"] = [test for test in at.plan["tests"] if test["name"].split("_wrap_in_")[0] not in arguments.without]
    return at


def command_run(arguments):
    shard, shards = arguments.shard
    check_files(arguments.names)
    with open_bench(arguments) as at:
        folder = arguments.results or results_folder(at.digest)
        folder.mkdir(parents=True, exist_ok=True)
        done = read_results(sorted(folder.glob("*.jsonl")))
        wanted = [mutant for mutant in all_mutants(arguments.names)[shard - 1::shards]
                  if mutant.id not in done or (done[mutant.id]["verdict"] == "open" and not arguments.quick)]
        say(f"shard {shard}/{shards}: {len(wanted)} mutants")
        with open(folder / f"{shard}-of-{shards}.jsonl", "a", encoding="utf-8") as out:
            try_all(wanted, at, out, arguments)


def command_try(arguments):
    if not arguments.names:
        refuse("try needs the id of a mutant")
    found = {mutant.id: mutant for mutant in all_mutants()}
    for key in arguments.names:
        if key not in found:
            refuse(f"there is no mutant {key}")
    with open_bench(arguments) as at:
        for key in arguments.names:
            print(f"{key}  {found[key].text!r}  {' '.join(map(str, at.try_mutant(found[key])))}", flush=True)


def read_equivalents(found, problems):
    """The ids that the file equivalents lists, separated by commas, with an argument behind them."""
    listed = set()
    for line in (HERE / "equivalents").read_text(encoding="utf-8").splitlines():
        keys, _, argument = line.partition(" ")
        if not keys or keys.startswith("#"):
            continue
        if not argument.strip():
            problems.append(f"equivalents: no argument for {keys}")
            continue
        listed.update(keys.split(","))
    problems += [f"equivalents: there is no mutant {key}" for key in sorted(listed - found)]
    return listed & found


def table(found, verdicts):
    """Mutants by operator and verdict."""
    columns = ("mutants", *VERDICTS, "equivalent", "same", "compile")
    print(f"{'operator':12}" + "".join(f"{name:>11}" for name in columns))
    for operator in (*mutants.OPERATORS, "all"):
        of = [verdicts[key] for key, mutant in found.items() if key in verdicts and operator in (mutant.operator, "all")]
        print(f"{operator:12}{len(of):11}" + "".join(f"{of.count(name):11}" for name in columns[1:]))


def judge(found, results, equivalents, problems):
    """id -> verdict. An equivalent was tried too: with the quick tests, which leave it open."""
    verdicts = {}
    for key in found:
        verdict = results[key]["verdict"] if key in results else ""
        if key in equivalents and verdict in ("survived", "open"):
            verdict = "equivalent"
        elif key in equivalents and verdict:
            problems.append(f"equivalents: {key} is {verdict}")
        verdicts[key] = verdict or "open"
    return verdicts


def name_some(verdicts, verdict, what, problems):
    """One line for all mutants of a verdict that none may have."""
    keys = [key for key in verdicts if verdicts[key] == verdict]
    if keys:
        problems.append(f"{len(keys)} {what}: {' '.join(keys[:NAMED])}{' ...' if len(keys) > NAMED else ''}")


def sum_up(verdicts, problems):
    """The figures as one line."""
    name_some(verdicts, "open", "without a result", problems)
    name_some(verdicts, "survived", "survived", problems)
    of = collections.Counter(verdicts.values())
    counted = sum(of[name] for name in VERDICTS)
    killed = 100.0 * of["killed"] / max(counted, 1)
    share = 100.0 * of["equivalent"] / max(counted + of["equivalent"], 1)
    if killed < KILLED_AT_LEAST:
        problems.append(f"only {killed:.2f} % are killed by an assertion, {KILLED_AT_LEAST} % are asked for")
    if share > EQUIVALENT_AT_MOST:
        problems.append(f"{share:.2f} % are equivalent, {EQUIVALENT_AT_MOST} % are allowed")
    return (f"{counted} mutants, {of['killed']} killed by an assertion ({killed:.2f} %), {of['crash']} crashed, "
            f"{of['timeout']} timed out, {of['sanitizer']} found by a sanitizer, {of['survived']} survived; "
            f"not counted: {of['equivalent']} equivalent ({share:.2f} %), {of['same']} of the same machine code, "
            f"{of['compile']} that do not compile")


def record(verdicts):
    """The figures of each file, which docs/evidence.md shows."""
    columns = (*VERDICTS, "equivalent")
    of_file = collections.defaultdict(collections.Counter)
    for key, verdict in verdicts.items():
        of_file[key.split(":")[0]][verdict] += 1
    lines = ["# Mutants of each file, written by mutate.py merge --record.", "\t".join(("# file", *columns))]
    lines += ["\t".join((file, *(str(of_file[file][name]) for name in columns))) for file in sorted(of_file)]
    (HERE / "figures.tsv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def command_merge(arguments):
    folder = arguments.results or results_folder(bench.digest())
    paths = [pathlib.Path(name) for name in arguments.names] or sorted(folder.glob("*.jsonl"))
    for path in paths:
        if not path.is_file():
            refuse(f"{path} is not a file of results")
    results = read_results(paths)
    found = {mutant.id: mutant for mutant in all_mutants()}
    problems = []
    equivalents = read_equivalents(set(found), problems)
    verdicts = judge(found, results, equivalents, problems)
    table(found, verdicts)
    for key, verdict in verdicts.items():
        if verdict in VERDICTS[1:]:
            print(f"{verdict:9} {key}")
    line = sum_up(verdicts, problems)
    for problem in problems[:20]:
        say(problem)
    if len(problems) > 20:
        say(f"... and {len(problems) - 20} more problems")
    if arguments.record and not problems:
        record(verdicts)
    print(line)
    return 1 if problems else 0


def command_rows(arguments):
    wanted = subprocess.run([bench.ROOT / "scripts/tools/traceability.py"], stdout=subprocess.PIPE, check=True, text=True).stdout
    unknown = set(arguments.names) - rows.read_shown(wanted).keys()
    if unknown:
        refuse(f"there is no row {sorted(unknown)[0]}")
    with open_bench(arguments) as at:
        return rows.check(at, rows.read_shown(wanted), arguments.names)


def shard_of(text):
    """i/n, with i from 1 to n."""
    shard, _, shards = text.partition("/")
    if not (shard.isdecimal() and shards.isdecimal() and 1 <= int(shard) <= int(shards)):
        raise argparse.ArgumentTypeError(f"there is no shard {text}: it is i/n, with i from 1 to n")
    return int(shard), int(shards)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = {"list": command_list, "prepare": command_prepare, "run": command_run, "try": command_try,
                "merge": command_merge, "rows": command_rows}
    parser.add_argument("command", choices=commands)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--shard", default="1/1", type=shard_of, metavar="i/n")
    parser.add_argument("--quick", action="store_true", help="only the quick tests: what they do not kill stays open")
    parser.add_argument("--without", action="append", default=[], metavar="TEST", help="leave out a test program")
    parser.add_argument("--record", action="store_true", help="merge: write figures.tsv, if nothing failed")
    parser.add_argument("--results", type=pathlib.Path, help="folder of the results, instead of one named by the sources")
    arguments = parser.parse_intermixed_args()
    return commands[arguments.command](arguments)


sys.exit(main())
