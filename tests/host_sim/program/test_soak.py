"""Soaks: nothing trips, drifts or is miscounted; a supervisor that does nothing is found; a soak that was stopped goes on."""
import json
import shutil
import signal
import subprocess
import time
import unittest

import hostsim


class Soak(hostsim.Case):
    def soak(self, *arguments, status=0, **options):
        result = self.run_program("soak", *arguments, timeout=600, **options)
        self.assertEqual(result.status, status, result.stdout + result.stderr)
        return result

    def figures(self, name):
        figures = json.loads(self.read(name))
        del figures["real_ms"]
        return figures

    # Shows: TIM-1, TIM-2
    def test_half_an_hour_on_each_topology(self):
        for shard, topology in ((1, "shared"), (2, "gateway")):
            self.soak("--hours", 2, "--seed", 1, "--shard", f"{shard}/{4 * hostsim.PART}", "--results", "a")
            figures = self.figures("a")
            self.assertEqual((figures["topology"], figures["ms"], figures["broken"]),
                             (topology, 1800000 // hostsim.PART, False))
            self.assertGreaterEqual(figures["disturbances"], 150 // hostsim.PART)
            self.assertLessEqual(figures["status_late_ms"], 30)

    def test_results_on_standard_output_are_all_that_is_there(self):
        arguments = ("--hours", 2, "--seed", 1, "--shard", "1/60")
        self.soak(*arguments, "--results", "file")
        printed = json.loads(self.soak(*arguments, "--results", "-").stdout)
        del printed["real_ms"]
        self.assertEqual(printed, self.figures("file"))
        broken = self.soak(*arguments, "--results", "-", status=1, program=hostsim.STUBS["mute"])
        self.assertTrue(json.loads(broken.stdout)["broken"])
        self.assertIn("BROKEN: frames received: counted 0", broken.stderr)

    def stopped(self, *arguments):
        """Run it for a tenth of a second of processor time; whether it was stopped."""
        with subprocess.Popen([hostsim.PROGRAM, "soak", *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True) as process:
            self.wait_until_it_looks_for_signals(process.pid)
            while process.poll() is None and hostsim.cpu_s_of(process.pid) < 0.1:
                time.sleep(0.005)
            process.send_signal(signal.SIGINT)
            _, said = process.communicate(timeout=600)
        if process.returncode != 0:
            self.assertIn("the same command resumes", said)
        return process.returncode != 0

    def test_a_soak_that_was_stopped_ends_as_one_that_was_not(self):
        # some seconds long, so that it does not end before the signal when this test is held up
        arguments = ("--hours", "8", "--seed", "3", "--shard", "2/4" if hostsim.PART == 1 else "2/64")
        self.soak(*arguments, "--results", "whole")
        parts = (*arguments, "--results", "parts", "--checkpoint", "checkpoint")
        self.assertTrue(self.stopped(*parts))
        self.stopped(*parts)
        self.soak(*parts)
        self.assertEqual(self.figures("parts"), self.figures("whole"))

    # so long that a soak which is not refused at its start runs into the limit of time
    LONG = ("--hours", 876000, "--seed", 1)

    def test_what_cannot_be_written_is_refused_before_the_soak(self):
        self.write("old", "hello\n")
        self.write("text", "hello\n")
        (self.folder / "folder").mkdir()
        for option in ("--results", "--checkpoint"):
            for name in ("no/where", "folder", "text/file"):
                result = self.run_program("soak", *self.LONG, option, name)
                self.assert_refused(result, name)
                self.assertEqual(result.stdout, "")
        self.assert_refused(self.run_program("soak", *self.LONG, "--results", "old", "--checkpoint", "no/where"), "no/where")
        self.assert_refused(self.run_program("soak", *self.LONG, "--results", "no/where", "--checkpoint", "new"), "no/where")
        self.assert_refused(self.run_program("soak", *self.LONG, "--results", "old", "--checkpoint", "text"), "not a soak checkpoint")
        self.assertEqual(self.read("old"), "hello\n")
        self.assertEqual(self.files(), ["folder", "old", "text"])

    def test_a_folder_that_vanishes(self):
        """What is not lost is there all the same, and nothing goes on without a checkpoint."""
        work = ("--hours", 1, "--seed", 1, "--shard", f"1/{2 * max(1, hostsim.PART // 4)}")
        for arguments, unfinished, stops in (
                ((*work, "--results", "gone/c"), "gone/c?*", False),
                ((*work, "--results", "a", "--checkpoint", "gone/c"), "a?*", False),
                ((*self.LONG, "--results", "b", "--checkpoint", "gone/c"), "b?*", True)):
            (self.folder / "gone").mkdir()
            with subprocess.Popen([hostsim.PROGRAM, "soak", *map(str, arguments)], cwd=self.folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True) as process:
                self.wait_until_it_looks_for_signals(process.pid)
                while not list(self.folder.glob(unfinished)) and process.poll() is None:
                    time.sleep(0.001)
                shutil.rmtree(self.folder / "gone")
                if stops:
                    process.send_signal(signal.SIGINT)
                printed, said = process.communicate(timeout=600)
            self.assertEqual(process.returncode == 2, not stops)
            self.assertEqual(said.count("\n"), 1, said)
            self.assertIn("gone/c: ", said)
            self.assertEqual(" disturbances, status frames at most " in printed, not stops)
        self.assertFalse(self.figures("a")["broken"])

    def test_checkpoints_that_are_none(self):
        self.assertTrue(self.stopped("--hours", "100", "--seed", "1", "--checkpoint", "good"))
        good = (self.folder / "good").read_bytes()
        torn = good[:5000] + bytes([good[5000] ^ 1]) + good[5001:]
        for name, content, says in (("text", b"hello\n", "not a soak checkpoint"),
                                    ("log", b"(1.000000) can0 123#00\n" * 90, "not a soak checkpoint"),
                                    ("hunt", good.replace(b"agv soak ", b"agv hunt ", 1), "not a soak checkpoint"),
                                    ("head", good[:50], "a damaged checkpoint"), ("torn", torn, "a damaged checkpoint"),
                                    ("cut", good[:-1], "a damaged checkpoint"), ("more", good + b"x", "a damaged checkpoint"),
                                    ("old", good.replace(b"agv soak 3", b"agv soak 2", 1), "another build of host_sim")):
            self.write(name, content)
            self.assert_refused(self.run_program("soak", "--hours", 100, "--seed", 1, "--checkpoint", name), name, says)
        device = self.run_program("soak", "--hours", 100, "--seed", 1, "--checkpoint", "/dev/full")
        self.assert_refused(device, "/dev/full: not a soak checkpoint")
        for other in (("--hours", 100, "--seed", 2), ("--hours", 101, "--seed", 1),
                      ("--hours", 100, "--seed", 1, "--shard", "1/2")):
            self.assert_refused(self.run_program("soak", *other, "--checkpoint", "good"), "another soak")

    def test_another_build_does_not_go_on(self):
        self.assertTrue(self.stopped("--hours", "100", "--seed", "1", "--checkpoint", "good"))
        result = self.run_program("soak", "--hours", 100, "--seed", 1, "--checkpoint", "good", program=self.other_build())
        self.assert_refused(result, "good: the checkpoint of another build of host_sim; go on with that one, or remove it")

    def test_one_soak_at_a_time_uses_a_checkpoint(self):
        arguments = ("--hours", "876000", "--seed", "1", "--checkpoint", "state")
        self.write("state", "")  # of one that was killed before it saved
        with self.in_the_background("soak", *arguments) as process:
            self.assert_refused(self.run_program("soak", *arguments), "state: another hunt or soak is using it; wait")
            hunt = self.run_program("hunt", "--seed", 1, "--runs", 1, "--checkpoint", "state")
            self.assert_refused(hunt, "state: another hunt or soak is using it; wait")
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(600), -signal.SIGINT)
        self.assertGreater((self.folder / "state").stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
