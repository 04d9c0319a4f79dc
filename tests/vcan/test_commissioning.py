"""The commands of docs/commissioning.md, typed as they stand, on a virtual can0 with a simulated vehicle.

Only the times are shorter, and the lines that set up a real controller are left out.
"""
import pathlib
import re
import shutil
import subprocess
import unittest

import canbus
import in_memory

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/commissioning.md"
SHORTER = {"timeout 1h": "timeout 5s", "--for 8h": "--for 4s"}
PROGRAMS = ("bash", "sh", "sleep", "timeout", "candump")


def commands():
    page = PAGE.read_text(encoding="utf-8")
    for block in re.findall(r"^```sh\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        for command in block.splitlines():
            if not command.startswith("sudo ip link"):
                yield command


class Checklist(canbus.Case):
    def setUp(self):
        super().setUp()
        if canbus.MEMORY:
            in_memory.bring([shutil.which(name) for name in PROGRAMS], canbus.MEMORY)
        subprocess.run("ip link add dev can0 type vcan && ip link set can0 up", shell=True, check=True)
        self.addCleanup(subprocess.run, ["ip", "link", "del", "can0"], check=False)

    def test_its_commands(self):
        ran = 0
        for command in commands():
            listens = "can0" in command
            for long, short in SHORTER.items():
                command = command.replace(long, short)
            vehicle = subprocess.Popen(["sh", "-c", 'sleep 0.3; exec "$0" vehicle --can can0 --for 20s', canbus.PROGRAM],
                                       stdout=subprocess.DEVNULL) if listens else None
            done = subprocess.run(["bash", "-c", command], cwd=self.folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, check=False, text=True)  # no timeout: in_memory.py
            if vehicle:
                vehicle.terminate()
                vehicle.wait()
            expected = 124 if command.startswith("timeout") else 0  # the status of timeout
            self.assertEqual(expected, done.returncode, f"{command}:\n{done.stdout}")
            self.assertNotIn("NOT SUPERVISED", done.stdout, command)
            ran += 1
        self.assertRegex((self.folder / "vehicle.conf").read_text(encoding="utf-8"), r"CONFIG_AGV_ID_SET_HEADING=y")
        self.assertEqual(5, ran)


if __name__ == "__main__":
    unittest.main()
