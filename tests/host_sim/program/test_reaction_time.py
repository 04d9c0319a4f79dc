"""Derived reaction times: frame lengths against stuffing worked out by hand, the page against the code, planted mistakes."""
import json
import pathlib
import random
import subprocess
import unittest

import hostsim

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCRIPT = ROOT / "scripts/tools/reaction-time.py"
PAGE = ROOT / "docs/reaction-time.md"


def crc15(bits):
    crc = 0
    for bit in bits:
        crc = (crc << 1) ^ (0x4599 if bit ^ (crc >> 14) else 0)
        crc &= 0x7FFF
    return crc


def number(value, width):
    return [value >> (width - 1 - bit) & 1 for bit in range(width)]


def stuff_bits(bits):
    """How many stuff bits a row of bits needs: one after five equal ones, which may begin with a stuff bit."""
    count, run, last = 0, 0, None
    for bit in bits:
        run = run + 1 if bit == last else 1
        last = bit
        if run == 5:
            count, run, last = count + 1, 1, 1 - bit
    return count


def standard_frame(can_id, data):
    """The bits of a frame with an 11-bit identifier that are stuffed, its CRC included."""
    bits = [0] + number(can_id, 11) + [0, 0, 0] + number(len(data), 4)
    for byte in data:
        bits += number(byte, 8)
    return bits + number(crc15(bits), 15)


def frame_length(can_id, data):
    bits = standard_frame(can_id, data)
    return len(bits) + stuff_bits(bits) + 10  # CRC delimiter, acknowledge slot and delimiter, end of frame


class Stuffing(hostsim.Case):
    def tables(self):
        return json.loads(self.run_good("campaign", "--tables").stdout)

    def test_worked_out_by_hand(self):
        # Start bit, then 078h = 00001111000, RTR, IDE, r0 = 000: 0 0000 | 1111 | 000 00 | 0
        # five 0 -> 1; that 1 and 1111 -> 0; that 0 and 000 0 (RTR) -> 1; then 00 and 1000 of DLC 8: none
        head = [0] + number(0x078, 11) + [0, 0, 0] + number(8, 4)
        self.assertEqual(stuff_bits(head), 3)
        # The worst there is: five equal bits, then four of the other kind, again and again.
        # 98 bits: the first five, then 23 times four = 97: 24 stuff bits, and one bit is left.
        worst = [0] * 5
        while len(worst) < 98:
            worst += [1 - worst[-1]] * 4
        self.assertEqual(stuff_bits(worst[:98]), 24)
        self.assertEqual(stuff_bits([0, 1] * 49), 0)
        # 43Fh, 00 00 00 00 70 00 00 00, what is sent is sure up to its CRC:
        # 0 10000111111 000 1000 | 32 x 0 | 0111 0000 | 24 x 0
        # 01 0000 11111 -> 0 (1); 1 000 100 0 and 32 x 0: 35 -> 1 after each five, which breaks the row: 35 zeros need 7 (8);
        # the 0 of 70h goes on from there: 1 zero, 111, then 0000 and 24 x 0: 28 zeros need 5 (13)
        known = [0] + number(0x43F, 11) + [0, 0, 0] + number(8, 4)
        for byte in (0, 0, 0, 0, 0x70, 0, 0, 0):
            known += number(byte, 8)
        self.assertEqual(stuff_bits(known), 13)

    def test_the_lengths_of_the_simulated_bus_are_these(self):
        # 44 bits and 8 a byte, the most stuff bits of 34 + 8 n: (34 + 8 n - 1) / 4. Written out, from 0 to 8 bytes.
        self.assertEqual(self.tables()["standard_bits"], [52, 62, 72, 82, 92, 102, 112, 122, 132])
        self.assertEqual(self.tables()["extended_bits"], [77, 87, 97, 107, 117, 127, 137, 147, 157])
        self.assertEqual(self.tables()["interframe_bits"], 3)

    def test_no_frame_is_longer(self):
        chance = random.Random(1)
        limit = self.tables()["standard_bits"]
        identifiers = [message["heading_id"] for message in self.tables()["messages"]]
        longest = 0
        for _ in range(5000):
            data = [chance.choice((0, 0xFF, 0x0F, 0xF0, 0x1E, 0x87, chance.randrange(256))) for _ in range(8)]
            length = frame_length(chance.choice(identifiers), data)
            longest = max(longest, length)
            self.assertLessEqual(length, limit[8])
        self.assertGreater(longest, 120)


class Page(hostsim.Case):
    def script(self, *arguments):
        return subprocess.run([SCRIPT, "--host-sim", hostsim.PROGRAM, *map(str, arguments)], cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def test_the_page_is_what_the_code_says(self):
        done = self.script("--check")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def assert_noticed(self, done, text):
        self.assertEqual(done.returncode, 1)
        self.assertIn(text, done.stderr)

    def test_a_wrong_figure_is_noticed(self):
        page = PAGE.read_text(encoding="utf-8")
        row = next(line for line in page.splitlines() if line.startswith("| `VCU_HEARTBEAT_LOST`"))
        first, *cells, _ = row.split(" | ")
        derived, measured = cells[1].split(" / ")
        unmeasured = [cell.split(" / ")[0] + " / -" if " / " in cell else cell for cell in cells]
        for changed, said in ((row.replace(cells[1], f"{float(derived) - 1:.1f} / {measured}", 1), "out of date"),
                              (row.replace(cells[1], f"{derived} / 999.9", 1), "measured above derived"),
                              (" | ".join([first, *unmeasured, "- |"]), "no measurements")):
            with self.subTest(said):
                self.assert_noticed(self.script("--check", "--page", self.write("page.md", page.replace(row, changed))), said)

    def changed_tables(self, name, by):
        tables = json.loads(self.run_good("campaign", "--tables").stdout)
        tables["settings"][name] += by
        return self.write("tables.json", json.dumps(tables))

    def test_a_changed_timeout_is_noticed(self):
        tables = self.changed_tables("vcu_heartbeat_timeout_ms", 20)
        self.assert_noticed(self.script("--check", "--tables", tables), "out of date")

    def test_a_run_that_takes_longer_than_derived_is_noticed(self):
        self.run_good("campaign", "--runs", 60, "--seed", 1, "--fault", "VCU_HEARTBEAT_LOST", "--results", "results")
        done = self.script("--compare", "results")
        self.assertEqual(done.returncode, 0, done.stdout)
        tables = self.changed_tables("vcu_heartbeat_timeout_ms", -20)
        done = self.script("--compare", "results", "--tables", tables)
        self.assertEqual(done.returncode, 1)
        self.assertIn("VCU_HEARTBEAT_LOST, shared, 500 kbit/s: first safe frame measured", done.stdout)


if __name__ == "__main__":
    unittest.main()
