"""Hunts: the same seed gives the same runs, what is found can be played, a checkpoint is gone on from, bad options."""
import re
import signal
import subprocess
import unittest

import hostsim

FOUND = re.compile(r"^HAZARD  (H[1-8]) run (\d+) after \d+ s: (.*); (.*); (\S+)$", re.MULTILINE)
LAST = re.compile(r"^(\d+) runs, (\d+) simulated seconds, took \d+ s; (\d+) runs with a hazard, (\d+) distinct$",
                  re.MULTILINE)

LAST_TOOK = re.compile(r"took \d+ s")


class Hunt(hostsim.Case):
    def hunt(self, *arguments, status=(0, 1)):
        result = self.run_program("hunt", *arguments, timeout=600)
        self.assertIn(result.status, status, result.stdout + result.stderr)
        return result

    def found_in(self, folder):
        return {path.name: path.read_text(encoding="ascii") for path in sorted((self.folder / folder).iterdir())}

    def folders(self, *names):
        for name in names:
            (self.folder / name).mkdir()

    def test_the_same_seed_the_same_runs(self):
        self.folders("a", "b", "c")
        runs = max(100 // hostsim.PART, 20)
        first = self.hunt("--seed", 7, "--runs", runs, "--found", "a")
        second = self.hunt("--seed", 7, "--runs", runs, "--found", "b")
        other = self.hunt("--seed", 8, "--runs", runs, "--found", "c")
        self.assertEqual(self.found_in("a"), self.found_in("b"))
        self.assertEqual(LAST.search(first.stdout)[2], LAST.search(second.stdout)[2])
        self.assertNotEqual(LAST.search(first.stdout)[2], LAST.search(other.stdout)[2])
        self.assertEqual(int(LAST.search(first.stdout)[1]), runs)

    def test_what_is_found_can_be_played(self):
        self.folders("a")
        result = self.hunt("--seed", 1, "--runs", max(150 // hostsim.PART, 40), "--found", "a")
        found = FOUND.findall(result.stdout)
        self.assertEqual(result.status, 1 if found else 0)
        self.assertEqual(len(found), int(LAST.search(result.stdout)[4]))
        self.assertEqual(len(self.found_in("a")), len(found))
        for kind, run, cause, _, path in found:
            played = self.run_program("scenario", path)
            self.assertEqual(played.status, 1, path)
            self.assertRegex(played.stdout, r"no hazard is expected, seen: %s \(%s\) at \d+ ms" % (kind, re.escape(cause)))

    def test_a_checkpoint_is_gone_on_from(self):
        if hostsim.PART > 1:
            return  # a piece takes minutes in a program full of checks
        self.folders("whole", "parts")
        whole = self.hunt("--seed", 3, "--runs", 550, "--found", "whole")
        self.hunt("--seed", 3, "--runs", 500, "--found", "parts", "--checkpoint", "state")
        self.assertRegex(self.interrupted("--checkpoint", "state"),
                         r"^host_sim: interrupted after \d+ runs; the same command resumes from run 500\n$")
        rest = self.hunt("--seed", 3, "--runs", 550, "--found", "parts", "--checkpoint", "state")
        self.assertEqual(LAST.search(rest.stdout)[0].replace(LAST_TOOK.search(rest.stdout)[0], ""),
                         LAST.search(whole.stdout)[0].replace(LAST_TOOK.search(whole.stdout)[0], ""))
        self.assertRegex(rest.stdout, r"(?m)^\d+ s of processor time$")
        self.assertEqual(self.found_in("whole"), self.found_in("parts"))
        bad = self.hunt("--seed", 4, "--runs", 550, "--checkpoint", "state", status=(2,))
        self.assertIn("the checkpoint of another hunt", bad.stderr)
        (self.folder / "state").write_bytes((self.folder / "state").read_bytes()[:-1])
        torn = self.hunt("--seed", 3, "--runs", 550, "--checkpoint", "state", status=(2,))
        self.assertIn("damaged", torn.stderr)

    def interrupted(self, *arguments):
        """What it says when a signal ends it during its first runs."""
        with subprocess.Popen([hostsim.PROGRAM, "hunt", "--seed", "3", "--runs", "100000", *map(str, arguments)],
                              cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.wait_until_it_looks_for_signals(process.pid)
            process.send_signal(signal.SIGINT)
            said = process.communicate(timeout=600)[1]
        self.assertEqual(process.returncode, -signal.SIGINT)
        return said

    def test_an_interrupted_hunt_says_that_nothing_is_saved_yet(self):
        self.assertRegex(self.interrupted(), r"^host_sim: interrupted after \d+ runs\n$")
        self.assertRegex(self.interrupted("--checkpoint", "state"), r"^host_sim: interrupted after \d+ runs; nothing is saved "
                         r"yet: the checkpoint is written after each 500 runs\n$")
        self.assertEqual(self.files(), [])

    def test_a_checkpoint_that_cannot_be_written_is_refused_at_once(self):
        self.assert_refused(self.hunt("--seed", 1, "--runs", 100000, "--checkpoint", "no/where", status=(2,)), "no/where: ")

    def test_files_that_are_no_checkpoint(self):
        self.write("log", "(1.000000) can0 123#00\n" * 90)
        self.write("cut", "agv hunt 2\0")
        for name, said in (("log", "log: not a hunt checkpoint"), ("/dev/full", "/dev/full: not a hunt checkpoint"),
                           ("cut", "cut: a damaged checkpoint; remove it to start over")):
            self.assert_refused(self.hunt("--seed", 1, "--runs", 1, "--checkpoint", name, status=(2,)), said)

    def test_hazards_are_listed(self):
        lines = self.hunt("--list-hazards", status=(0,)).stdout.splitlines()
        self.assertEqual([line[:2] for line in lines[::2]], ["H%d" % number for number in range(1, 9)])

    def test_bad_options(self):
        for arguments, said in (
            ((), "--seed is missing"),
            (("--seed", 1), "--runs or --for-minutes is missing"),
            *((("--list-hazards", option, value), "--list-hazards runs nothing") for option, value in (
                ("--checkpoint", "x"), ("--seed", 1), ("--shard", "1/2"), ("--runs", 1), ("--for-minutes", 1), ("--found", "."))),
            (("--seed", 1, "--runs", 1, "--for-minutes", 1), "give only one of --runs and --for-minutes"),
            (("--seed", 1, "--runs", 0), "--runs: '0' is not a number from 1"),
            (("--seed", 1, "--for-minutes", "x"), "--for-minutes: 'x' is not a time"),
            (("--seed", 1, "--runs", 1, "--shard", "3/2"), "--shard: '3/2'"),
            (("--seed", 1, "--runs", 1, "--found", "nowhere"), "--found: 'nowhere' is not a folder"),
            (("--seed", 1, "--runs", 1, "--found", "/proc"), "--found: the folder '/proc' cannot be written: "),
            (("--seed", 1, "--runs", 1, "--fuond", "x"), "unknown option '--fuond'"),
            (("--seed", 1, "--runs", 1, "more"), "unexpected argument 'more'"),
        ):
            result = self.hunt(*arguments, status=(2,))
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn(said, result.stderr)


if __name__ == "__main__":
    unittest.main()
