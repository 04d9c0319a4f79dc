#!/usr/bin/python3
"""Long tests with other CAN tools: noise for minutes, with many seeds. Started by hand:

  HOST_SIM=build/host/bin/host_sim scripts/with-vcan tests/vcan/long_clients.py [--seeds N] [--seconds N] [--first SEED]

Each seed is three runs (beside healthy traffic, on all identifiers, on both sides of a gateway), each of --seconds.
The seed is that of the order; the frames are cangen's, which are others every time. So, to look into a failure, set
CLIENTS_KEEP to a folder: it gets the logs that were played and recorded.
"""
import argparse
import io
import os
import pathlib
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
FRAMES_A_SECOND = 600
NAMES = ("test_noise_beside_healthy_traffic_trips_nothing", "test_noise_on_all_identifiers",
         "test_noise_on_both_sides_of_a_gateway")


def make(name, seconds, seed):
    """The test with a length and a seed of its own."""
    import test_clients

    def test_long(self):
        getattr(test_clients.Noise, name).short(self, count=FRAMES_A_SECOND * seconds, duration_ms=1000 * seconds, seed=seed)
    return type(name, (test_clients.clients.Case,), {
        "noise": test_clients.Noise.noise, "spread": test_clients.Noise.spread, "test_long": test_long})("test_long")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first", type=int, default=100)
    parser.add_argument("--seconds", type=int, default=60)
    args = parser.parse_args()
    if not os.access(os.environ.get("HOST_SIM", ""), os.X_OK):
        sys.exit("long_clients: HOST_SIM in the environment must be a program")
    import run_clients
    run_clients.bring_programs()
    ran = failed = 0
    for seed in range(args.first, args.first + args.seeds):
        for name in NAMES:
            begin = time.monotonic()
            result = unittest.TextTestRunner(stream=io.StringIO(), verbosity=0).run(make(name, args.seconds, seed))
            wrong = "".join(text for _, text in result.failures + result.errors)
            ran += result.testsRun
            failed += bool(wrong)
            print("%-6s seed %d %s %.0f s" % ("FAILED" if wrong else "ok", seed, name, time.monotonic() - begin), flush=True)
            print(wrong, end="", flush=True)
    print("%d Tests %d Failures 0 Ignored" % (ran, failed))
    sys.exit(1 if failed or ran != len(NAMES) * args.seeds or ran == 0 else 0)


if __name__ == "__main__":
    main()
