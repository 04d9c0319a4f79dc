#!/usr/bin/python3
"""Make a page of the atlas of double faults, from what `host_sim atlas --results` wrote.

    atlas-page.py [--partial] RESULTS... -o atlas.html

RESULTS are the files of all shards; with --partial some of them are enough. The last line has the figures.
"""
import argparse
import collections
import json
import pathlib
import sys

TEMPLATE = pathlib.Path(__file__).with_name("atlas.html")
HALVES = ("both", "first_alone", "second_alone")
SLOWER_US = 30000


class Problem(Exception):
    pass


class Index(dict):
    """Numbers for words, in the order in which they come."""

    def __missing__(self, word):
        self[word] = len(self)
        return self[word]


def ms(time_us):
    return "" if time_us is None else str(round(time_us / 1000))


def counted(number, word):
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


class Atlas:
    def __init__(self):
        self.words = Index()
        self.rows = []
        self.shards = collections.Counter()
        self.wanted = 0
        self.weaker = collections.Counter()
        self.slower = 0
        self.head = None

    def read(self, path):
        try:
            self.read_lines(path)
        except OSError as error:
            raise Problem(f"{path}: {error.strerror}") from error
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise Problem(f"{path} holds no results of host_sim atlas, or is damaged") from error

    def read_lines(self, path):
        with open(path, encoding="ascii") as lines:
            head = json.loads(next(lines, "{}"))
            if head.get("atlas") != 1:
                raise Problem(f"{path} holds no results of host_sim atlas")
            if self.head is not None and {**head, "shard": 0} != self.head:
                raise Problem(f"{path} is not of the same atlas as the files before it")
            self.head = {**head, "shard": 0}
            self.shards[head["shard"]] += 1
            for number, line in enumerate(lines, 2):
                if not line.endswith("\n"):
                    raise Problem(f"{path}:{number}: the line is incomplete")
                self.take(json.loads(line))

    def take(self, case):
        times = [case[name]["safe_us"] for name in HALVES]
        quicker = min((time for time in times[1:] if time is not None), default=None)
        slower = quicker is not None and (times[0] is None or times[0] > quicker + SLOWER_US)
        self.slower += slower
        self.rows.append(";".join(
            [str(case["case"])] + [str(self.words[case[key]]) for key in ("topology", "in", "first", "second")] + [str(case["distance_ms"])] +
            [",".join([str(self.words[half["reason"] or "-"]), str(self.words[half["state"]]), ms(half["safe_us"]),
                       ms(half["open_us"]), ms(half["stop_us"]), half["hazard"] or ""])
             for half in (case[name] for name in HALVES)] + [case["weaker"] or "", case["known"] or "", "slow" if slower else ""]))
        if case["weaker"]:
            self.weaker[case["weaker"]] += 1

    def check_whole(self):
        twice = [shard for shard, count in self.shards.items() if count > 1]
        if twice:
            raise Problem(f"shard {twice[0]} is given twice")
        missing = set(range(1, self.head["shards"] + 1)) - set(self.shards)
        if missing:
            raise Problem(f"shard {min(missing)} of {self.head['shards']} is missing; --partial makes a page without it")

    def page(self):
        data = "\n".join([" ".join(self.words), *self.rows])
        text = TEMPLATE.read_text(encoding="utf-8")
        return text.replace("@VERSION@", self.head["version"]).replace("@DATA@", data)

    def figures(self):
        weak = ", ".join(f"{count} {name}" for name, count in sorted(self.weaker.items())) or "none"
        faults = {fault for row in self.rows for fault in row.split(";")[3:5]}
        return (f"{counted(len(self.rows), 'case')} of {counted(len(faults), 'fault')}, weaker than their worse baseline: {weak}; "
                f"first safe frame later than in the quicker baseline: {self.slower}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", metavar="RESULTS", help="a file that host_sim atlas --results wrote")
    parser.add_argument("-o", "--out", required=True, metavar="FILE", help="the page to write, replaced if it exists")
    parser.add_argument("--partial", action="store_true", help="make the page although results of some shards are missing")
    arguments = parser.parse_args()
    atlas = Atlas()
    try:
        for path in arguments.results:
            atlas.read(path)
        if not arguments.partial:
            atlas.check_whole()
        pathlib.Path(arguments.out).write_text(atlas.page(), encoding="utf-8")
    except Problem as problem:
        print(f"atlas-page: {problem}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"atlas-page: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    print(atlas.figures())
    return 0


sys.exit(main())
