"""The hour of a soak in which the clock wraps: nothing trips, drifts or is miscounted."""
import json
import unittest

import hostsim


class SoakWrap(hostsim.Case):
    # Shows: TIM-2
    def test_the_hour_in_which_the_clock_wraps(self):
        # 4294967.296 s are 1193.05 hours; the last of a thousand parts of 1194 hours begins at 1192.8
        result = self.run_program("soak", "--hours", 1194, "--seed", 1, "--shard", "1000/1000", "--results", "a", timeout=600)
        self.assertEqual(result.status, 0, result.stdout + result.stderr)
        figures = json.loads(self.read("a"))
        self.assertEqual((figures["wraps"], figures["broken"]), (1, False))


if __name__ == "__main__":
    unittest.main()
