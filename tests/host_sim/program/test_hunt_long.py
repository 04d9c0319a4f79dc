"""Hunts that take minutes in a program full of checks, and one with a seeded fault: what is found can be played, a checkpoint is
gone on from."""
import os
import re
import time
import unittest

from test_hunt import LAST, Case

FOUND = re.compile(r"^HAZARD  (H[1-8]) run (\d+) after \d+ s: (.*); (.*); (\S+)$", re.MULTILINE)


class Found(Case):
    def test_what_is_found_can_be_played(self):
        seeded = os.environ["HOST_SIM_SEEDED"]  # whose supervisor lets a flood through
        (self.folder / "a").mkdir()
        result = self.hunt("--seed", 9, "--runs", 40, "--found", "a", status=(1,), program=seeded)
        found = FOUND.findall(result.stdout)
        self.assertEqual([kind for kind, *_ in found], ["H7"])
        self.assertEqual(os.listdir(self.folder / "a"), [os.path.basename(found[0][4])])
        self.assertEqual(LAST.search(result.stdout)[4], "1")
        kind, _, cause, _, path = found[0]
        played = self.run_program("scenario", path, program=seeded)
        self.assertEqual(played.status, 1, path)
        self.assertRegex(played.stdout, rf"no hazard is expected, seen: {kind} \({re.escape(cause)}\) at \d+ ms")


class Checkpoint(Case):
    def test_a_checkpoint_is_gone_on_from(self):
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
        # one more byte in the program's file, and it is another one
        other = self.hunt(*arguments, "--checkpoint", "state", status=(2,), program=self.other_build())
        self.assert_refused(other, "state: the checkpoint of another build of host_sim; go on with that one, or remove it to start over")
        self.assertEqual(self.figures(*arguments, "--checkpoint", "state"), whole)
        (self.folder / "state").write_bytes((self.folder / "state").read_bytes()[:-1])
        torn = self.hunt(*arguments, "--checkpoint", "state", status=(2,))
        self.assertIn("damaged", torn.stderr)

    def test_a_checkpoint_that_was_replaced_is_still_in_use(self):
        state = self.folder / "state"
        with self.in_the_background("hunt", "--seed", 3, "--runs", 100000, "--checkpoint", state):
            before = state.stat().st_ino
            while state.stat().st_ino == before:
                time.sleep(0.05)
            bad = self.hunt("--seed", 3, "--runs", 1, "--checkpoint", state, status=(2,))
            self.assert_refused(bad, "another hunt or soak is using it")

    def test_runs_of_a_shard_go_up_to_the_end_of_its_last_batch(self):
        arguments = ("--seed", 5, "--shard", "2/2", "--checkpoint", "state")
        self.assertEqual(LAST.search(self.hunt(*arguments, "--runs", 1000).stdout)[1], "500")
        self.assertEqual(LAST.search(self.hunt(*arguments, "--runs", 1500).stdout)[1], "500")
        self.assert_refused(self.hunt(*arguments, "--runs", 999, status=(2,)), "state: its runs go up to 1000: give --runs 1000")


if __name__ == "__main__":
    unittest.main()
