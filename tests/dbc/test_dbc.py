#!/usr/bin/python3
"""protocol/agv.dbc, read by canmatrix, the C codec, and docs/protocol.md say the same.

canmatrix knows nothing of the C code, and the C code nothing of the DBC file: what both agree on was written twice.
Every comparison runs for all messages and both identifier sets, on boundaries and on random values.

usage: test_dbc.py --dbc FILE --codec PROGRAM --status PROGRAM --document FILE [--seed N] [--random N]
"""
import argparse
import contextlib
import io
import logging
import random
import re
import subprocess
import sys
import unittest
from decimal import Decimal

logging.disable(logging.CRITICAL)  # on import, canmatrix tells which other formats it cannot read
try:
    import canmatrix.formats
except ImportError as error:
    sys.exit(f"test_dbc: canmatrix is missing ({error}): apt-get install python3-canmatrix, "
             "which belongs to /usr/bin/python3")
logging.disable(logging.NOTSET)

OPTIONS = argparse.Namespace(compared=0)

# The DBC file has each message once an identifier; the second one of these has this ending.
TABLE_SUFFIX = "_table"

STATUS_FRAME = "supervisor_status"

# By hand, from the protocol document. AI commands may also come from the supervisor.
SENDERS = {
    "turn_signal_command": ["AI", "Supervisor"],
    "gear_command": ["AI", "Supervisor"],
    "throttle_command": ["AI", "Supervisor"],
    "steering_command": ["AI", "Supervisor"],
    "vehicle_status": ["VCU"],
    "gear_status": ["VCU"],
    "throttle_status": ["VCU"],
    "steering_status": ["EPS"],
    "eps_status": ["EPS"],
    "steering_position": ["EPS"],
    "wheel_speed": ["VCU"],
}
UNITS = {
    "speed_m_per_h": "m/h",
    "throttle_pct": "%",
    "angle_deg": "deg",
    "supply_pct_of_12v": "%",
    "left_mm_s": "mm/s",
    "right_mm_s": "mm/s",
}
VALUE_NAMES = {
    "gear": {1: "D", 2: "R", 4: "N", 8: "P"},
    "mode": {0: "steering assist", 1: "angle control", 2: "speed control", 3: "torque control", 255: "off"},
    "headlight_off": {0: "on", 1: "off"},
    "autopilot_off": {0: "no request", 1: "disable autopilot"},
}


class Codec:
    """The C codec, at the other end of a pipe."""

    def __init__(self, program):
        self.program = program
        self.fields = {}  # name -> {field: (lowest, highest value that its type holds)}
        self.constants = {}
        self.messages = {}  # name -> (identifier in the heading set, in the table set, cycle time)
        for line in self.ask(["info"]):
            kind, *words = line.split()
            if kind == "fields":
                ranges = (word.split(":") for word in words[1:])
                self.fields[words[0]] = {field: (int(low), int(high)) for field, low, high in ranges}
            elif kind == "constant":
                self.constants[words[0]] = int(words[1])
            elif kind == "message":
                self.messages[words[0]] = tuple(int(word) for word in words[1:])

    def ask(self, requests):
        run = subprocess.run([self.program], input="\n".join(requests) + "\n", text=True, capture_output=True,
                             check=False)
        if run.returncode != 0 or run.stderr:
            raise RuntimeError(f"{self.program} ended with {run.returncode}: {run.stderr}")
        return run.stdout.splitlines()

    def unpack(self, name, payloads):
        """[(valid, {field: value})], one a payload."""
        lines = self.ask([f"unpack {name} {payload.hex()}" for payload in payloads])
        answers = []
        for line in lines:
            verdict, *words = line.split()
            fields = {field: int(value) for field, value in (word.split("=") for word in words)}
            answers.append((verdict == "valid", fields))
        return answers

    def pack(self, name, values):
        """[payload, or None where the codec refused], one a list of field values."""
        lines = self.ask([f"pack {name} " + " ".join(str(value) for value in row) for row in values])
        return [None if line == "refused" else bytes.fromhex(line) for line in lines]


def flags(codec, prefix):
    """The bits of a C flag field: {DBC signal: mask}. AGV_VCU_ALARM_X is the signal alarm_x."""
    kind = prefix.split("_")[-1].lower()
    return {f"{kind}_{name[len(prefix) + 1:].lower()}": mask for name, mask in codec.constants.items()
            if name.startswith(prefix + "_")}


def to_field(codec, field, signals):
    """The value of a C field from the physical values of the DBC signals, and the names of those that it used."""
    if field == "headlight_on":
        return 1 - signals["headlight_off"], ["headlight_off"]
    if field == "throttle_permille":
        return signals["throttle_pct"] * 10, ["throttle_pct"]
    if field == "angle_ddeg":
        return signals["angle_deg"] * 10, ["angle_deg"]
    if field in ("level1_alarms", "faults"):
        bits = flags(codec, "AGV_VCU_ALARM" if field == "level1_alarms" else "AGV_EPS_FAULT")
        return sum(mask for name, mask in bits.items() if signals[name]), list(bits)
    return signals[field], [field]


def to_signals(codec, field, value):
    """The other way: physical values of the DBC signals that carry a C field."""
    if field == "headlight_on":
        return {"headlight_off": 1 - value}
    if field == "throttle_permille":
        return {"throttle_pct": Decimal(value) / 10}
    if field == "angle_ddeg":
        return {"angle_deg": Decimal(value) / 10}
    if field in ("level1_alarms", "faults"):
        bits = flags(codec, "AGV_VCU_ALARM" if field == "level1_alarms" else "AGV_EPS_FAULT")
        return {name: int(value & mask != 0) for name, mask in bits.items()}
    return {field: value}


def is_valid(frame, signals):
    """What the DBC file says about physical values: in the range, and in the value table where there is one."""
    for signal in frame.signals:
        value = signals[signal.name]
        if not signal.min <= value <= signal.max or (signal.values and value not in signal.values):
            return False
    return True


def raw_range(signal):
    if signal.is_signed:
        return -(1 << (signal.size - 1)), (1 << (signal.size - 1)) - 1
    return 0, (1 << signal.size) - 1


def payloads_to_try(frame, generator, count):
    """Boundary payloads of a frame and random ones."""
    payloads = [bytes(8), bytes([0xFF] * 8)]
    payloads += [(1 << bit).to_bytes(8, "little") for bit in range(64)]
    payloads += [((1 << 64) - 1 - (1 << bit)).to_bytes(8, "little") for bit in range(64)]
    payloads += [bytes([value] * 8) for value in range(256)]
    payloads += [bytes(range(start, start + 8)) for start in (0x01, 0x12, 0x7C, 0xF0)]
    # Around every boundary of every signal, with other bits clear, set and random.
    for signal in frame.signals:
        lowest, highest = raw_range(signal)
        edges = {lowest, lowest + 1, -1, 0, 1, highest - 1, highest}
        for limit in (signal.min, signal.max):
            raw = int((limit - signal.offset) / signal.factor)
            edges |= {raw - 1, raw, raw + 1}
        for raw in sorted(edge for edge in edges if lowest <= edge <= highest):
            for background in (bytes(8), bytes([0xFF] * 8), generator.randbytes(8)):
                payloads.append(place(signal, raw, background))
    payloads += [generator.randbytes(8) for _ in range(count)]
    # Random payloads seldom hit a valid gear, mode or angle: as many that do.
    for _ in range(count):
        payload = generator.randbytes(8)
        for signal in frame.signals:
            if signal.values:
                payload = place(signal, generator.choice(sorted(signal.values)), payload)
            elif signal.max < signal.offset + signal.factor * raw_range(signal)[1]:
                limit = int((signal.max - signal.offset) / signal.factor)
                payload = place(signal, generator.randint(0, limit), payload)
        payloads.append(payload)
    return payloads


def place(signal, raw, payload):
    """The payload with one signal set. Own arithmetic (canmatrix's start bit is the most significant bit, counted
    from the front, for big-endian signals)."""
    raw &= (1 << signal.size) - 1
    order = "little" if signal.is_little_endian else "big"
    shift = signal.start_bit if signal.is_little_endian else 64 - signal.start_bit - signal.size
    mask = ((1 << signal.size) - 1) << shift
    number = int.from_bytes(payload, order) & ~mask | raw << shift
    return number.to_bytes(8, order)


def values_to_try(codec, frame, name, generator, count):
    """Field values around every boundary, and random ones."""
    fields = codec.fields[name]
    ranges = list(fields.values())
    good = [good_values(codec, frame, field, span) for field, span in fields.items()]
    rows = []
    for index, (lowest, highest) in enumerate(ranges):
        edges = {lowest, lowest + 1, -1, 0, 1, highest - 1, highest}
        edges |= {edge + step for edge in good[index] for step in (-1, 0, 1)}
        if highest <= 255:
            edges |= set(range(256))
        for edge in sorted(edge for edge in edges if lowest <= edge <= highest):
            row = [generator.choice(values) for values in good]
            row[index] = edge
            rows.append(row)
    for _ in range(count):
        rows.append([generator.randint(*span) for span in ranges])
        rows.append([generator.choice(values) if len(values) > 2 else generator.randint(min(values), max(values))
                     for values in good])
    return rows


def good_values(codec, frame, field, span):
    """Valid values of a field: those of the value table, else the two ends of the valid range."""
    names = list(to_signals(codec, field, 0))
    signal = frame.signal_by_name(names[0])
    if len(names) > 1:
        return list(span)
    if signal.values and field != "headlight_on":
        return sorted(signal.values)
    ends = [to_field(codec, field, {signal.name: limit})[0] for limit in (signal.min, signal.max)]
    return [int(min(ends)), int(max(ends))]


def document_rows(text, heading):
    """The cells of the table rows below a heading of docs/protocol.md, header and rule left out."""
    section = re.split(r"^#+ ", text.split(f"# {heading}\n", 1)[1], maxsplit=1, flags=re.MULTILINE)[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in section.splitlines() if line[:1] == "|"]
    return rows[2:]


def documented_signal(cell):
    """The DBC signal of a cell such as `faults`: `UNDER_VOLTAGE`, or `gear`."""
    field, _, bit = cell.replace("`", "").partition(": ")
    if bit:
        return {"level1_alarms": "alarm_", "faults": "fault_"}[field] + bit.lower()
    return {"headlight_on": "headlight_off", "throttle_permille": "throttle_pct", "angle_ddeg": "angle_deg"}.get(
        field, field)


def documented_bits(byte, bit):
    """The bits of cells such as `5`, `7 (Bit6)` or `1..2`, `LE`: a mask over the payload, low byte first."""
    first, last = (int(number) for number in (byte.split("..") * 2)[:2])
    if bit in ("1..4", "5..8"):
        return (0x0F if bit == "1..4" else 0xF0) << 8 * (first - 1)
    if bit.strip("*") in ("LE", "BE", "1..8"):
        return sum(0xFF << 8 * (n - 1) for n in range(first, last + 1))
    return 1 << (8 * (first - 1) + int(bit.split()[0]) - 1)


class DbcAgainstCodec(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.codec = Codec(OPTIONS.codec)
        with open(OPTIONS.document, encoding="utf-8") as document:
            cls.document = document.read()
        lines = subprocess.run([OPTIONS.status], text=True, capture_output=True, check=True).stdout.splitlines()
        cls.status = [line.split() for line in lines]
        complaints = io.StringIO()
        handler = logging.StreamHandler(complaints)
        logging.getLogger().addHandler(handler)
        with contextlib.redirect_stdout(complaints), contextlib.redirect_stderr(complaints):
            cls.dbc = canmatrix.formats.loadp_flat(OPTIONS.dbc)
        logging.getLogger().removeHandler(handler)
        cls.complaints = complaints.getvalue()

    def pairs(self):
        """(name in C, identifier set, DBC frame): every message of both sets."""
        for id_set in (0, 1):
            for name, row in self.codec.messages.items():
                frame = self.dbc.frame_by_id(canmatrix.ArbitrationId(row[id_set], extended=False))
                yield name, id_set, frame

    def frames(self):
        """(name in C, DBC frame): each frame of the DBC file once."""
        seen = set()
        for name, _, frame in self.pairs():
            if frame is not None and frame.name not in seen:
                seen.add(frame.name)
                yield name, frame

    def generator(self, frame):
        """Random numbers of a frame's own: they do not depend on what ran before."""
        return random.Random(f"{OPTIONS.seed} {frame.name}")

    # Shows: P1, P17
    def test_identifiers(self):
        ids = set()
        for name, id_set, frame in self.pairs():
            with self.subTest(message=name):
                self.assertIsNotNone(frame, f"{name}: identifier {self.codec.messages[name][id_set]:X}h is not there")
                other = id_set == 1 and self.codec.messages[name][0] != self.codec.messages[name][1]
                self.assertEqual(frame.name, name + (TABLE_SUFFIX if other else ""))
                self.assertEqual(self.codec.ask([f"from_id {frame.arbitration_id.id} {id_set}"]), [name])
                ids.add(frame.arbitration_id.id)
        of_protocol = [frame for frame in self.dbc.frames if frame.name != STATUS_FRAME]
        self.assertEqual(sorted(ids), sorted(frame.arbitration_id.id for frame in of_protocol))
        self.assertEqual(len(of_protocol), 13)

    # Shows: TOP-3
    def test_status_codes(self):
        frame = self.dbc.frame_by_name(STATUS_FRAME)
        words = {kind: [row[1:] for row in self.status if row[0] == kind] for kind in ("id", "period", "state", "reason")}
        self.assertEqual([[str(frame.arbitration_id.id)], [str(frame.cycle_time)]], words["id"] + words["period"])
        self.assertEqual(frame.size, 8)
        self.assertEqual(frame.transmitters, ["Supervisor"])
        self.assertEqual(frame.signal_by_name("state").values, {int(code): name for name, code in words["state"]})
        reasons = {int(code): name for name, code in words["reason"]} | {255: "none"}
        self.assertEqual(frame.signal_by_name("first_reason").values, reasons)

    # Shows: TOP-3
    def test_status_frames(self):
        frame = self.dbc.frame_by_name(STATUS_FRAME)
        seen, counters = set(), []
        for payload, state, reason, output, checksum in (row[1:] for row in self.status if row[0] == "frame"):
            signals = frame.decode(bytes.fromhex(payload))
            names = {name: signal.named_value for name, signal in signals.items()}
            self.assertEqual((names["state"], names["first_reason"], names["safety_output"]), (state, reason, output))
            self.assertEqual(signals["config_checksum"].raw_value, int(checksum), payload)
            counters.append(signals["alive_counter"].raw_value)
            seen.add((state, reason, output))
        self.assertEqual(counters, [*range(len(counters) // 2)] * 2)
        fault = "EPS_OVER_CURRENT_SHUTDOWN"
        self.assertEqual(seen, {("INIT", "none", "open"), ("STANDBY", "none", "closed"), ("ACTIVE", "none", "closed"),
                                ("TRIPPED", fault, "closed"), ("SAFE", fault, "closed"), ("TRIPPED", fault, "open")})

    # Shows: TOP-3, HW-6
    def test_status_pages(self):
        frame = self.dbc.frame_by_name(STATUS_FRAME)
        for payload, expected in (("33FF110001020300", {"page": 1, "version_major": 1, "version_minor": 2, "version_patch": 3}),
                                  ("33FF2000EFCDAB89", {"page": 2, "revision": 0x89ABCDEF, "safety_output": 0})):
            signals = {name: signal.raw_value for name, signal in frame.decode(bytes.fromhex(payload)).items()}
            self.assertEqual(signals, signals | expected)
            self.assertNotIn("config_checksum", signals)

    # Shows: TOP-3
    def test_status_document(self):
        frame = self.dbc.frame_by_name(STATUS_FRAME)
        rows = document_rows(self.document, f"{frame.arbitration_id.id:X}h {STATUS_FRAME}")
        self.assertEqual([row[2].strip("`") for row in rows], [signal.name for signal in frame.signals])
        for byte, bit, field, _ in rows:
            ones = int.from_bytes(place(frame.signal_by_name(field.strip("`")), -1, bytes(8)), "little")
            self.assertEqual(documented_bits(byte, bit), ones, field)
        states = {f"{code:02X}h {name}" for code, name in frame.signal_by_name("state").values.items()}
        self.assertEqual(set(rows[0][3].split(", ")), states)

    # Shows: P16
    def test_cycle_times(self):
        for name, frame in self.frames():
            with self.subTest(message=frame.name):
                self.assertEqual(frame.cycle_time, self.codec.messages[name][2])

    # Shows: P3, P15
    def test_frames(self):
        for name, frame in self.frames():
            with self.subTest(message=frame.name):
                self.assertEqual(frame.size, 8)
                self.assertFalse(frame.arbitration_id.extended or frame.is_fd or frame.is_multiplexed)
                self.assertEqual(frame.transmitters, SENDERS[name])
                used = [0] * 64
                for signal in frame.signals:
                    ones = int.from_bytes(place(signal, -1, bytes(8)), "little")
                    used = [count + (ones >> bit & 1) for bit, count in enumerate(used)]
                self.assertLessEqual(max(used), 1, "signals overlap")

    # Shows: P2, P5, P6, P7, P8, P9, P10, P11, P12, P18
    def test_signals(self):
        for name, frame in self.frames():
            with self.subTest(message=frame.name):
                ones = {signal.name: 1 for signal in frame.signals}
                used = [signal for field in self.codec.fields[name] for signal in to_field(self.codec, field, ones)[1]]
                self.assertEqual(sorted(used), sorted(ones), "C fields and DBC signals")
                for signal in frame.signals:
                    self.assertEqual(signal.unit, UNITS.get(signal.name, ""), signal.name)
                    if signal.name in VALUE_NAMES:
                        self.assertEqual(signal.values, VALUE_NAMES[signal.name], signal.name)
                    if signal.size == 1:
                        self.assertEqual(sorted(signal.values), [0, 1], signal.name)
                    self.assertEqual(signal.is_signed, name == "wheel_speed", signal.name)
                    self.assertLessEqual(signal.min, signal.initial_value, signal.name)
                    self.assertGreaterEqual(signal.max, signal.initial_value, signal.name)
                    if signal.name == "gear":
                        self.assertEqual(signal.initial_value, 8)
                    if signal.name == "angle_deg":
                        self.assertEqual(signal.initial_value, 0)

    # Shows: P1, P16
    def test_document_messages(self):
        rows = document_rows(self.document, "All messages")
        self.assertEqual(len(rows), len(self.codec.messages))
        for ids, link, sender, cycle, _ in rows:
            name = re.match(r"\[(\w+)\]", link)[1]
            with self.subTest(message=name):
                numbers = [int(number, 16) for number in re.findall(r"([0-9A-F]{3})h", ids)]
                self.assertEqual((numbers[0], numbers[-1], int(cycle.split()[0])), self.codec.messages[name])
                self.assertEqual(sender, SENDERS[name][0])
                anchor = re.search(r"\(#(.*)\)", link)[1]
                anchors = [re.sub(r"[^\w -]", "", line.lower()).replace(" ", "-")
                           for line in re.findall(r"^#+ (.*)$", self.document, re.MULTILINE)]
                self.assertIn(anchor, anchors)

    # Shows: P3, P4
    def test_document_fields(self):
        headings = re.findall(r"^### (.*)$", self.document, re.MULTILINE)
        for name, frame in self.frames():
            with self.subTest(message=frame.name):
                heading = next(line for line in headings if name in re.findall(r"\w+", line))
                rows = document_rows(self.document, heading)
                self.assertEqual(sorted(documented_signal(row[2]) for row in rows),
                                 sorted(signal.name for signal in frame.signals))
                for byte, bit, field, _, valid in rows:
                    signal = frame.signal_by_name(documented_signal(field))
                    self.assertEqual(documented_bits(byte, bit),
                                     int.from_bytes(place(signal, -1, bytes(8)), "little"), field)
                    if signal.size > 8:
                        self.assertEqual(bit.strip("*"), "LE" if signal.is_little_endian else "BE", field)
                    self.assertEqual(valid.split(" (")[0], self.valid_in_words(signal), field)

    @staticmethod
    def valid_in_words(signal):
        if signal.values and signal.size > 1:
            return {4: "these four", 5: "these five"}[len(signal.values)]
        lowest, highest = (int((limit - signal.offset) / signal.factor) for limit in (signal.min, signal.max))
        return "all" if (lowest, highest) == raw_range(signal) else f"{lowest}..{highest}"

    # Shows: P17
    def test_file_is_read_without_complaint(self):
        self.assertEqual(self.complaints, "")
        self.assertEqual(self.dbc.load_errors, [])
        self.assertEqual([ecu.name for ecu in self.dbc.ecus], ["AI", "VCU", "EPS", "Supervisor"])
        names = [frame.name for frame in self.dbc.frames]
        names += [signal.name for frame in self.dbc.frames for signal in frame.signals]
        for name in names:
            self.assertRegex(name, re.compile(r"^[A-Za-z_][A-Za-z0-9_]{0,31}$"), "readers allow 32 characters")

    # Shows: P2, P3, P4, P5, P6, P7, P8, P9, P10, P11, P12, P13, P14, P18
    def test_decode(self):
        for name, frame in self.frames():
            with self.subTest(message=frame.name):
                payloads = payloads_to_try(frame, self.generator(frame), OPTIONS.random)
                answers = self.codec.unpack(name, payloads)
                self.assertEqual(len(answers), len(payloads))
                OPTIONS.compared += len(payloads)
                verdicts = set()
                for payload, (valid, fields) in zip(payloads, answers):
                    signals = {key: signal.phys_value for key, signal in frame.decode(payload).items()}
                    expected = {field: to_field(self.codec, field, signals)[0] for field in fields}
                    self.assertEqual(fields, expected, f"payload {payload.hex()}")
                    self.assertEqual(valid, is_valid(frame, signals), f"payload {payload.hex()}: valid or not")
                    verdicts.add(valid)
                self.assertIn(True, verdicts)

    # Shows: P2, P3, P4, P5, P6, P7, P8, P9, P10, P11, P12, P13, P14, P18
    def test_encode(self):
        for name, frame in self.frames():
            with self.subTest(message=frame.name):
                rows = values_to_try(self.codec, frame, name, self.generator(frame), OPTIONS.random)
                payloads = self.codec.pack(name, rows)
                self.assertEqual(len(payloads), len(rows))
                OPTIONS.compared += len(rows)
                packed = 0
                for row, payload in zip(rows, payloads):
                    signals = {}
                    for field, value in zip(self.codec.fields[name], row):
                        signals.update(to_signals(self.codec, field, value))
                    raw = {signal.name: signal.phys2raw(signals[signal.name]) for signal in frame.signals}
                    expected = bytes(frame.signals_to_bytes(raw)) if is_valid(frame, signals) else None
                    self.assertEqual(payload, expected, f"values {row}: {hexed(payload)}, DBC {hexed(expected)}")
                    packed += payload is not None
                self.assertGreater(packed, OPTIONS.random // 2)


def hexed(payload):
    return "refused" if payload is None else payload.hex()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--dbc", required=True)
    parser.add_argument("--codec", required=True)
    parser.add_argument("--status", required=True)
    parser.add_argument("--document", required=True)
    parser.add_argument("--seed", type=int, default=20261121)
    parser.add_argument("--random", type=int, default=500)
    parser.parse_args(namespace=OPTIONS)

    print(f"seed {OPTIONS.seed}, {OPTIONS.random} random values of each kind a message", flush=True)
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(DbcAgainstCodec)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)
    print(f"{OPTIONS.compared} payloads compared")
    return 0 if result.wasSuccessful() and result.testsRun > 0 and OPTIONS.compared > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
