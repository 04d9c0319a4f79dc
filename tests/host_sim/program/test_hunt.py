"""Hunts: the same seed gives the same runs; one that is interrupted says what is saved; two do not use one
checkpoint."""
import os
import re
import signal
import subprocess
import unittest

import hostsim

LAST = re.compile(r"^\d+ s of processor time\n"
                  r"(\d+) runs?, (\d+) simulated seconds, took \d+ s; (\d+) runs? with a hazard, (\d+) distinct$", re.MULTILINE)


class Case(hostsim.Case):
    def hunt(self, *arguments, status=(0, 1), **options):
        result = self.run_program("hunt", *arguments, timeout=600, **options)
        self.assertIn(result.status, status, result.stdout + result.stderr)
        return result

    def figures(self, *arguments):
        """How many runs, and how long they were in simulated seconds."""
        return tuple(map(int, LAST.search(self.hunt(*arguments).stdout).group(1, 2)))

    def interrupted(self, *arguments, ignored=()):
        """What it says when a signal ends it during its first runs. The caller ignores some signals."""
        def ignore():
            for one in ignored:
                signal.signal(one, signal.SIG_IGN)
        with subprocess.Popen([hostsim.PROGRAM, "hunt", "--seed", "3", "--runs", "100000", *map(str, arguments)],
                              cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              preexec_fn=ignore) as process:
            self.wait_until_it_looks_for_signals(process.pid)
            if signal.SIGHUP in ignored:
                process.send_signal(signal.SIGHUP)
            process.send_signal(signal.SIGINT)
            said = process.communicate(timeout=600)[1]
        self.assertEqual(process.returncode, -signal.SIGINT)
        return said


class Hunt(Case):
    def test_the_same_seed_the_same_runs(self):
        first, second, other = (self.figures("--seed", seed, "--runs", 20) for seed in (7, 7, 8))
        self.assertEqual(first, second)
        self.assertNotEqual(first, other)
        self.assertEqual((first[0], other[0]), (20, 20))

    def test_one_run(self):
        self.assertRegex(self.hunt("--seed", 1, "--runs", 1).stdout, r"(?m)^1 run, \d+ simulated seconds, .*; 0 runs with a hazard")

    def test_an_interrupted_hunt_says_that_nothing_is_saved_yet(self):
        self.assertRegex(self.interrupted(), r"^host_sim: interrupted after \d+ runs?\n$")
        self.assertRegex(self.interrupted("--checkpoint", "state"), r"^host_sim: interrupted after \d+ runs?; nothing is saved "
                         r"yet: the checkpoint is written after each 500 runs\n$")
        self.assertEqual(self.files(), [])

    def test_in_the_background_of_a_script_a_signal_ends_it_too(self):
        """A shell starts it with SIGINT ignored, nohup with SIGHUP ignored: only the latter stays ignored."""
        self.assertRegex(self.interrupted(ignored=(signal.SIGINT, signal.SIGHUP)), r"^host_sim: interrupted after \d+ runs?\n$")

    def test_one_hunt_at_a_time_uses_a_checkpoint(self):
        arguments = ("--seed", 3, "--runs", 1, "--checkpoint")
        with self.in_the_background("hunt", "--seed", 3, "--runs", 100000, "--checkpoint", "state") as process:
            (self.folder / "link").symlink_to("state")
            for name in ("state", "./state", "link"):
                self.assert_refused(self.hunt(*arguments, name, status=(2,)), f"{name}: another hunt or soak is using it; wait")
            self.assertEqual(self.figures(*arguments, "other")[0], 1)
            process.kill()
        # The lock is gone with its owner. On a busy machine that one may have saved more than one run.
        self.assertNotIn("using", self.hunt(*arguments, "state", status=(0, 2)).stderr)

    def test_an_empty_checkpoint_is_none(self):
        """A hunt that is killed before it saves leaves one."""
        self.write("state", "")
        self.assertEqual(self.figures("--seed", 3, "--runs", 1, "--checkpoint", "state")[0], 1)

    def test_a_checkpoint_is_a_regular_file(self):
        os.mkfifo(self.folder / "pipe")
        for name in ("pipe", ".", "/dev/full"):
            self.assert_refused(self.hunt("--seed", 1, "--runs", 1, "--checkpoint", name, status=(2,)), f"{name}: not a hunt checkpoint")

    def test_a_checkpoint_that_cannot_be_written_is_refused_at_once(self):
        self.assert_refused(self.hunt("--seed", 1, "--runs", 100000, "--checkpoint", "no/where", status=(2,)), "no/where: ")

    def test_hazards_are_listed(self):
        lines = self.hunt("--list-hazards", status=(0,)).stdout.splitlines()
        self.assertEqual([line[:2] for line in lines[::2]], ["H%d" % number for number in range(1, 9)])


if __name__ == "__main__":
    unittest.main()
