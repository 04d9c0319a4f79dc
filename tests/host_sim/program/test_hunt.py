"""Hunts: the same seed gives the same runs, what is found can be played, a checkpoint is gone on from."""
import os
import re
import signal
import subprocess
import unittest

import hostsim

FOUND = re.compile(r"^HAZARD  (H[1-8]) run (\d+) after \d+ s: (.*); (.*); (\S+)$", re.MULTILINE)
LAST = re.compile(r"^\d+ s of processor time\n"
                  r"(\d+) runs?, (\d+) simulated seconds, took \d+ s; (\d+) runs? with a hazard, (\d+) distinct$", re.MULTILINE)


class Hunt(hostsim.Case):
    def hunt(self, *arguments, status=(0, 1), **options):
        result = self.run_program("hunt", *arguments, timeout=600, **options)
        self.assertIn(result.status, status, result.stdout + result.stderr)
        return result

    def figures(self, *arguments):
        """How many runs, and how long they were in simulated seconds."""
        return tuple(map(int, LAST.search(self.hunt(*arguments).stdout).group(1, 2)))

    def test_the_same_seed_the_same_runs(self):
        first, second, other = (self.figures("--seed", seed, "--runs", 20) for seed in (7, 7, 8))
        self.assertEqual(first, second)
        self.assertNotEqual(first, other)
        self.assertEqual((first[0], other[0]), (20, 20))

    def test_what_is_found_can_be_played(self):
        if hostsim.PART > 1:
            return  # there are no seeded faults in a program full of checks
        seeded = os.environ["HOST_SIM_SEEDED"]  # whose supervisor lets a flood through
        (self.folder / "a").mkdir()
        result = self.hunt("--seed", 3, "--runs", 40, "--found", "a", status=(1,), program=seeded)
        found = FOUND.findall(result.stdout)
        self.assertEqual([kind for kind, *_ in found], ["H7"])
        self.assertEqual(os.listdir(self.folder / "a"), [os.path.basename(found[0][4])])
        self.assertEqual(LAST.search(result.stdout)[4], "1")
        kind, _, cause, _, path = found[0]
        played = self.run_program("scenario", path, program=seeded)
        self.assertEqual(played.status, 1, path)
        self.assertRegex(played.stdout, rf"no hazard is expected, seen: {kind} \({re.escape(cause)}\) at \d+ ms")

    def test_one_run(self):
        self.assertRegex(self.hunt("--seed", 1, "--runs", 1).stdout, r"(?m)^1 run, \d+ simulated seconds, .*; 0 runs with a hazard")

    def test_a_checkpoint_is_gone_on_from(self):
        if hostsim.PART > 1:
            return  # a piece takes minutes in a program full of checks
        arguments = ("--seed", 3, "--runs", 520)
        self.assertEqual(self.figures("--seed", 3, "--runs", 20, "--checkpoint", "state")[0], 20)  # done again with the others
        saved = self.figures("--seed", 3, "--runs", 500, "--checkpoint", "state")
        self.assertRegex(self.interrupted("--checkpoint", "state"),
                         r"^host_sim: interrupted after \d+ runs?; the same command resumes from run 500\n$")
        whole = self.figures(*arguments, "--checkpoint", "state")
        rest = self.figures(*arguments, "--shard", "2/2")  # the runs from 500 on
        self.assertEqual((saved[0], rest[0], whole[0]), (500, 20, 520))
        self.assertAlmostEqual(saved[1] + rest[1], whole[1], delta=1)  # each is rounded down
        less = self.hunt("--seed", 3, "--runs", 499, "--checkpoint", "state", status=(2,))
        self.assert_refused(less, "state: its runs go up to 500: give --runs 500 or more, or remove it to start over")
        bad = self.hunt("--seed", 4, "--runs", 520, "--checkpoint", "state", status=(2,))
        self.assertIn("the checkpoint of another hunt", bad.stderr)
        (self.folder / "state").write_bytes((self.folder / "state").read_bytes()[:-1])
        torn = self.hunt(*arguments, "--checkpoint", "state", status=(2,))
        self.assertIn("damaged", torn.stderr)

    def test_runs_of_a_shard_go_up_to_the_end_of_its_last_batch(self):
        if hostsim.PART > 1:
            return
        arguments = ("--seed", 5, "--shard", "2/2", "--checkpoint", "state")
        self.assertEqual(LAST.search(self.hunt(*arguments, "--runs", 1000).stdout)[1], "500")
        self.assertEqual(LAST.search(self.hunt(*arguments, "--runs", 1500).stdout)[1], "500")
        self.assert_refused(self.hunt(*arguments, "--runs", 999, status=(2,)), "state: its runs go up to 1000: give --runs 1000")

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

    def test_an_interrupted_hunt_says_that_nothing_is_saved_yet(self):
        self.assertRegex(self.interrupted(), r"^host_sim: interrupted after \d+ runs?\n$")
        self.assertRegex(self.interrupted("--checkpoint", "state"), r"^host_sim: interrupted after \d+ runs?; nothing is saved "
                         r"yet: the checkpoint is written after each 500 runs\n$")
        self.assertEqual(self.files(), [])

    def test_in_the_background_of_a_script_a_signal_ends_it_too(self):
        """A shell starts it with SIGINT ignored, nohup with SIGHUP ignored: only the latter stays ignored."""
        self.assertRegex(self.interrupted(ignored=(signal.SIGINT, signal.SIGHUP)), r"^host_sim: interrupted after \d+ runs?\n$")

    def test_a_checkpoint_that_cannot_be_written_is_refused_at_once(self):
        self.assert_refused(self.hunt("--seed", 1, "--runs", 100000, "--checkpoint", "no/where", status=(2,)), "no/where: ")

    def test_hazards_are_listed(self):
        lines = self.hunt("--list-hazards", status=(0,)).stdout.splitlines()
        self.assertEqual([line[:2] for line in lines[::2]], ["H%d" % number for number in range(1, 9)])


if __name__ == "__main__":
    unittest.main()
