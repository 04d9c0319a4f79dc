"""Bad input from outside: mutated logs, nested configurations, random options. Never a crash, always exit status 0 or 2, one
line for what is refused, nothing half-written. The seeds are fixed; FUZZ_RUNS in the environment multiplies the runs. Which
lines, configurations and stores are taken: tests/fuzz."""
import os
import random
import re
import unittest

import hostsim
import traffic

RUNS = int(os.environ.get("FUZZ_RUNS", "1"))
STAMP = re.compile(rb"^\((\d{1,12})\.(\d{6}|\d{9})\) ")
SPECIAL = (b"\0", b"\n", b"\r", b"\r\n", b" ", b"#", b"##", b"(", b")", b".", b"R", b"T", b"_", b"-", b"\xff", b"\t",
           b"0" * 300, b"F" * 70, b"8" * 8, b"\xef\xbb\xbf", b"%s%n", b"99999999999999999999", b"20000040#", b":", b"{",
           b"[", b"&a", b"*a", b"- ", b"? ", b"| ", b"!!", b"'", b'"', b"---\n", b"...\n", b"\\0")


def mutate(content, chance):
    """A few random changes of bytes."""
    content = bytearray(content)
    for _ in range(chance.choice((1, 1, 1, 2, 3, 8))):
        at = chance.randrange(len(content) + 1)
        kind = chance.randrange(5)
        if kind == 0 and at < len(content):
            content[at] ^= 1 << chance.randrange(8)
        elif kind == 1:
            content[at:at] = chance.choice(SPECIAL)
        elif kind == 2:
            del content[at:at + chance.choice((1, 1, 2, 10, 100))]
        elif kind == 3:
            length = chance.choice((1, 5, 30))
            content[at:at] = content[at:at + length]
        elif at < len(content):
            content[at] = chance.randrange(256)
    return bytes(content)


def is_short(log):
    """Whether a log spans few seconds: a changed digit of a stamp may mean days, which are valid but take long."""
    seconds = sorted({int(match[1]) for match in map(STAMP.match, log.split(b"\n")) if match})
    return not any(60 < later - earlier < 8640002 for earlier, later in zip(seconds, seconds[1:]))


class Fuzz(hostsim.Case):
    def check(self, result, outputs):
        self.assertIn(result.status, (0, 2), result.stderr)
        if result.status == 2:
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertFalse(set(outputs) & set(self.files()))
        for name in outputs:
            (self.folder / name).unlink(missing_ok=True)

    def replay_both_ways(self, log):
        if not is_short(log):
            return
        self.write("log", log)
        for option in ((), ("--skip-bad-lines",)):
            result = self.run_program("replay", "--out", "out", "--events", "events", *option, "log")
            self.check(result, ("out", "events"))

    def test_mutated_logs(self):
        chance = random.Random(1)
        lines = traffic.log(traffic.frames(60, engage_ms=20)).encode().splitlines(keepends=True)
        lines += [b"(1700000000.060000) can0 0000043F#00\n", b"(1700000000.060000) can0 43F#R8\n",
                  b"(1700000000.060000) can0 43F##10011 R\r\n", b"(1700000000.061000) can0 20000040#0000\n",
                  b"(1700000000.061000) can0 20000100#0000\n", b"(1700000000.061000) can0 43F#0011223344556677_9\n"]
        for _ in range(120 * RUNS):
            some = chance.sample(lines, chance.choice((1, 2, 5, 30)))
            self.replay_both_ways(mutate(b"".join(sorted(some)), chance))

    def test_nested_configurations(self):
        for text in (b"[" * 100000, b"{" * 100000, b"a: " * 100000, b"- " * 100000, b"? " * 10000, b"a:\n b:\n" * 1000,
                     b"".join(b" " * depth + b"a:\n" for depth in range(1200)),
                     b"a: &a [x,x]\n" + b"".join(b"k%d: &k%d [*a,*a]\n" % (n, n) for n in range(1000))):
            self.write("c.yaml", text)
            result = self.run_program("config", "--config", "c.yaml")
            self.assert_refused(result, "c.yaml:")

    def test_random_options(self):
        chance = random.Random(6)
        self.write("log", traffic.log(traffic.frames(5)))
        words = ["replay", "config", "--out", "--events", "--tail", "--start-ms", "--skip-bad-lines", "--ai-if",
                 "--reset-cause", "--store", "--config", "--topology", "--id-set", "--shadow", "--help", "--to-kconfig",
                 "log", "-", "--", "", "1", "gateway", "shared", "table", "watchdog", "can0", "=", "--tail=5", "-x", "o1",
                 "--out=o2", "--start-ms=4294967295", "\n", "%n"]
        for _ in range(100 * RUNS):
            arguments = ["replay"] * chance.randrange(2) + chance.choices(words, k=chance.randrange(7))
            result = self.run_program(*arguments)
            self.assertIn(result.status, (0, 2), arguments)
            if result.status == 2:
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            for name in self.files():
                if name != "log":
                    (self.folder / name).unlink()


if __name__ == "__main__":
    unittest.main()
