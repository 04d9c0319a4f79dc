#!/usr/bin/python3
"""How long the supervisor takes from the cause of a fault to the first safe frame on the wire: docs/reaction-time.md.

Derives the worst case of each fault from the tables of the code (`host_sim campaign --tables`: messages and cycles, settings,
what carries which fault, lengths of frames on the simulated bus) and writes it into the page between its markers, beside
the greatest time that campaigns measured. docs/reaction-time.md says how it is derived.

--measured RESULTS  of `host_sim campaign --results`: become the measured figures of the page
--compare RESULTS   changes nothing; fails where a run took longer than derived, and prints how near they came
                    both may be given twice: for a campaign, and for one with --newly-engaged
--check             changes nothing; fails when the page is not what the code says, or names a figure above the derived one
"""
import argparse
import collections
import json
import pathlib
import re
import subprocess
import sys

import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
BEGIN, END = "<!-- {}: made by scripts/tools/reaction-time.py -->", "<!-- end of {} -->"
BITRATES = (125000, 250000, 500000)
TOPOLOGIES = ("shared", "gateway")
TICK_US = 1000
CLOCKS_COMPARED_US = 1000000  # HW-4
# A controller is error passive above a TEC of 127, and each destroyed frame adds 8: so many collisions in a row.
COLLISIONS = 16
NEAR = 1.25
COMMANDS = ("turn_signal_command", "gear_command", "throttle_command", "steering_command")
# Bits from the start of a frame to the end of its DLC; bits of the data in which two commands of one ID can differ first.
BITS_BEFORE_DATA = 19
DIFFER_WITHIN = {"steering_command": 16, "throttle_command": 8, "gear_command": 8, "turn_signal_command": 40}


class Problem(Exception):
    pass


# --- a bus ---


class Bus:
    """The frames of one wire. An entry: (name, identifier, period in us, jitter in us)."""

    def __init__(self, tables, bitrate, entries):
        self.bit_us = 1000000 // bitrate
        self.tables = tables
        self.frame_us = (tables["standard_bits"][8] + tables["interframe_bits"]) * self.bit_us
        # What somebody else may send: the longest classic frame there is.
        self.longest_us = (tables["extended_bits"][8] + tables["interframe_bits"]) * self.bit_us
        self.entries = entries

    def higher(self, identifier, leave_out):
        return [entry for entry in self.entries if entry[1] <= identifier and entry[0] != leave_out]

    def window_us(self, higher, extra_us):
        """How long frames of higher priority, and whatever else is in the way, hold a frame back."""
        window = extra_us
        while True:
            frames = sum(-(-(window + jitter + self.bit_us) // period) for _, _, period, jitter in higher)
            longer = extra_us + frames * self.frame_us
            if longer == window:
                return window
            if longer > 10000000:
                raise Problem("the bus is overloaded: there is no worst case")
            window = longer

    def response_us(self, name, extra_us=0):
        """From the moment a periodic frame is to be sent to its last bit, whichever of a busy wire (R. Davis et al. 2007)."""
        _, identifier, period, jitter = next(entry for entry in self.entries if entry[0] == name)
        higher = self.higher(identifier, name)
        own = (name, identifier, period, jitter)
        busy = self.window_us(higher + [own], self.longest_us + extra_us)
        worst = 0
        for instance in range(-(-(busy + jitter) // period)):
            window = self.window_us(higher, self.longest_us + extra_us + instance * self.frame_us)
            worst = max(worst, jitter + window - instance * period + self.frame_us)
        return worst - self.tables["interframe_bits"] * self.bit_us


class World:
    """Both sides of a topology at one bit rate and ID set."""

    def __init__(self, tables, bitrate, topology, id_set):
        self.tables = tables
        self.shared = topology == "shared"
        self.messages = {message["name"]: message for message in tables["messages"]}
        self.ids = {name: message[f"{id_set}_id"] for name, message in self.messages.items()}
        vehicle = [self.entry(name) for name, message in self.messages.items() if message["node"] != "ai"]
        commands = [self.entry(name) for name in COMMANDS]
        if self.shared:
            self.vehicle = self.ai = Bus(tables, bitrate, vehicle + commands)
        else:
            # What the gateway passes on is as late as it was at its arrival.
            late = {name: Bus(tables, bitrate, vehicle).response_us(name) for name, *_ in vehicle}
            for _ in range(8):
                self.ai = Bus(tables, bitrate, commands + [self.entry(name, late[name]) for name in late])
                passed = [self.entry(name, self.ai.response_us(name)) for name in COMMANDS]
                self.vehicle = Bus(tables, bitrate, vehicle + passed)
                late = {name: self.vehicle.response_us(name) for name in late}

    def entry(self, name, jitter_us=0):
        return name, self.ids[name], self.messages[name]["cycle_ms"] * 1000, jitter_us

    def collision_us(self, name):
        """One collision of two commands with this ID: up to the bit that differs, the error frame, and on."""
        bits = BITS_BEFORE_DATA + DIFFER_WITHIN[name]
        return (bits + (bits - 1) // 4 + self.tables["error_bits"] + self.tables["interframe_bits"]) * self.vehicle.bit_us

    def collisions_us(self, names):
        """As many as it takes until both senders are error passive, and one of the other command after that; then an
        error-passive sender lets somebody else go first."""
        if not names:
            return 0
        costs = sorted((self.collision_us(name) for name in names), reverse=True)
        return COLLISIONS * costs[0] + sum(costs[1:]) + self.vehicle.longest_us + \
            self.tables["suspend_bits"] * self.vehicle.bit_us

    def arrival_us(self, name):
        """A message of the vehicle or the AI computer, from the moment it is to be sent to its arrival."""
        bus = self.ai if name in COMMANDS else self.vehicle
        return bus.response_us(name)

    def status_us(self):
        """The status frame, which everything else on the wire goes before."""
        bus = Bus(self.tables, 1000000 // self.vehicle.bit_us, self.vehicle.entries + [("status", 0x7F0, 100000, 0)])
        return bus.response_us("status")

    def send_us(self, name, collisions=True, passive=False):
        """A safe command, from the decision to its last bit: behind one frame that is on the wire, everything of higher
        priority, the held angle (065h goes first), and on the shared bus the AI computer's frames with the same IDs."""
        bus = self.vehicle
        higher = [entry for entry in bus.higher(self.ids[name], None) if self.shared or entry[0] not in COMMANDS]
        own = [other for other in COMMANDS if self.ids[other] < self.ids[name]]
        # On the shared bus each 065h of the AI computer is answered by another one of the supervisor.
        answers = [entry for entry in higher if entry[0] in own] if self.shared else []
        extra = bus.longest_us + len(own) * bus.frame_us
        if self.shared and collisions:
            extra += self.collisions_us(own + [name])
        if passive:  # after each own frame it lets somebody else go first
            extra += len(own) * (bus.longest_us + self.tables["suspend_bits"] * bus.bit_us)
        window = bus.window_us(higher + answers, extra)
        return window + bus.frame_us - self.tables["interframe_bits"] * bus.bit_us


# --- the rows ---


def setting_us(world, row):
    return world.tables["settings"][row["setting"]] * 1000


def engaged_decision_us(world, row):
    """With an engagement: from the operator's switch, or from the cause if that is later."""
    known_us = world.messages["vehicle_status"]["cycle_ms"] * 1000 + world.arrival_us("vehicle_status")
    wait_us = world.tables["settings"][row["wait"]] * 1000 if row["wait"] else 0
    if row["kind"] == "never_seen":
        return known_us + wait_us + TICK_US
    if row["kind"] == "silence":  # the time begins with the engagement, or with a frame that comes after it
        return max(known_us, world.arrival_us(row["message"])) + setting_us(world, row) + TICK_US
    return known_us + wait_us + under_way_decision_us(world, row)


def decision_us(world, row):
    """From the cause to the moment at which the supervisor decides."""
    return engaged_decision_us(world, row) if "wait" in row else under_way_decision_us(world, row)


def under_way_decision_us(world, row):
    kind = row["kind"]
    name = row["message"]
    if kind == "at_once":
        return TICK_US if "later" in row["flags"] else 0  # it runs again: from the next tick on
    if kind == "tick":
        return TICK_US
    if kind == "contact":
        return setting_us(world, row) + TICK_US
    if kind == "clocks":  # a comparison that had begun before the cause may not show it
        return 2 * CLOCKS_COMPARED_US + TICK_US
    if kind == "frame":  # of a stranger, with the ID of a command that the gateway sends too
        return world.vehicle.response_us(name, world.collisions_us([name]))
    cycle_us = world.messages[name]["cycle_ms"] * 1000
    arrival_us = world.arrival_us(name)
    if kind == "frames":
        return cycle_us * (world.tables["settings"][row["setting"]] if row["setting"] else 1) + arrival_us
    if kind == "silence":
        return arrival_us + setting_us(world, row) + TICK_US
    if kind == "lasts":
        return cycle_us + arrival_us + setting_us(world, row) + 2 * TICK_US
    if kind == "gaps":
        return row["highest"] * 1000 * (world.tables["settings"][row["setting"]] + 1) + arrival_us
    if kind == "stall":
        return cycle_us + arrival_us + setting_us(world, row) + 2 * TICK_US
    if kind == "unconfirmed":
        timeout_us = world.tables["settings"]["steering_command_timeout_ms"] * 1000
        return arrival_us + timeout_us + TICK_US + setting_us(world, row) + TICK_US
    raise Problem(f"{row['fault']}: no derivation for the kind '{kind}'")


def reaction_us(world, row, collisions=True):
    if "output" in row["flags"]:
        return decision_us(world, row)
    passive = row["fault"] == "ERROR_PASSIVE"
    return decision_us(world, row) + world.send_us("throttle_command", collisions, passive)


def confirmation_us(world, row):
    """To SAFE, with the simulated vehicle, from its greatest speed, and P commanded at once."""
    vehicle = world.tables["vehicle"]
    brake_us = max(0, vehicle["speed_mm_s"] - vehicle["walking_pace_mm_s"]) * 1000000 // vehicle["braking_mm_s2"] + TICK_US
    # The VCU looks at its gear box once a cycle. A command D that comes between is answered, and P is taken anew.
    park_us = world.send_us("gear_command") + brake_us + vehicle["gear_change_ms"] * 1000 + \
        world.messages["vehicle_status"]["cycle_ms"] * 1000
    if world.shared:
        park_us += world.tables["settings"]["override_gap_ms"] * 1000 + world.send_us("gear_command")
    park_us += world.messages["gear_status"]["cycle_ms"] * 1000 + world.arrival_us("gear_status")
    off_us = world.send_us("turn_signal_command") + world.messages["vehicle_status"]["cycle_ms"] * 1000 + \
        world.arrival_us("vehicle_status")
    return decision_us(world, row) + max(park_us, off_us)


def applies(row, topology):
    return not ({"shared", "gateway"} - {topology}) & set(row["flags"])


ENGAGED = "@engagement"


def engaged_rows(tables):
    """The rows of faults which an engagement delays, with another name, and what they wait for."""
    rows = {row["fault"]: row for row in tables["rows"]}
    return [{**rows[item["fault"]], "fault": item["fault"] + ENGAGED, "wait": item["wait"],
             "kind": "never_seen" if item["never_seen"] else rows[item["fault"]]["kind"],
             "flags": flags_engaged(rows[item["fault"]]["flags"])}
            for item in tables["engagements"]]


def flags_engaged(flags):
    """A gateway waits with gear and throttle, so what needs a gear is caused on the shared bus only."""
    return flags + ["shared"] if "in_gear" in flags else flags


class Derived:
    """(fault, topology, bit rate) -> us; the worst of both ID sets."""

    def __init__(self, tables):
        self.rows = tables["rows"] + engaged_rows(tables)
        self.tables = tables
        self.worlds = {(topology, bitrate): [World(tables, bitrate, topology, id_set) for id_set in ("heading", "table")]
                       for topology in TOPOLOGIES for bitrate in BITRATES}
        self.reaction = self.each(reaction_us)
        self.without_collisions = self.each(lambda world, row: reaction_us(world, row, collisions=False))
        self.decision = self.each(decision_us)
        # Not where no frame leaves for a while, or a sender goes on and on.
        settles = {row["fault"] for row in tables["rows"] if row["kind"] != "gaps" and "no_wire" not in row["flags"]}
        self.confirmation = {key: time for key, time in self.each(confirmation_us).items() if key[0] in settles}

    def each(self, what):
        return {(row["fault"], topology, bitrate): max(what(world, row) for world in self.worlds[topology, bitrate])
                for row in self.rows for topology in TOPOLOGIES for bitrate in BITRATES if applies(row, topology)}


# --- what was measured ---


class Measured:
    """(fault, topology, bit rate) -> greatest us, and how many runs; confirmations with P at once and without bus-off."""

    def __init__(self, paths, rows):
        self.by_output = {row["fault"] for row in rows if "output" in row["flags"]}
        self.runs = collections.Counter()
        self.reaction = {}
        self.confirmation = {}
        self.total = 0
        self.rows = []
        for path in paths:
            try:
                self.read(path, rows)
            except (OSError, ValueError, KeyError) as error:
                raise Problem(f"{path}: {error}") from error

    def read(self, path, rows):
        with open(path, encoding="ascii") as lines:
            head = json.loads(next(lines, "{}"))
            if head.get("campaign") != 1:
                raise Problem(f"{path} holds no results of a campaign")
            suffix = ENGAGED if head["newly_engaged"] else ""
            self.rows += [row for row in rows if ("wait" in row) == head["newly_engaged"]]
            for line in lines:
                run = json.loads(line)
                self.take({**run, "fault": run["fault"] + suffix}, self.by_output)

    def take(self, run, by_output):
        self.total += 1
        key = run["fault"], run["topology"], run["bitrate"]
        self.runs[run["fault"]] += 1
        time = run["opened_us" if run["fault"] in by_output else "safe_us"]
        if time is None:
            raise Problem(f"run {run['run']}, {run['fault']}: there was no reaction")
        self.reaction[key] = max(self.reaction.get(key, 0), time)
        if run["confirmed_us"] is not None and run["park"] == "at_once" and not run["bus_off"]:
            self.confirmation[key] = max(self.confirmation.get(key, 0), run["confirmed_us"])


def compare(derived, measured):
    """Every figure that is above the derived one."""
    above = []
    for what, limits, times in (("first safe frame", derived.reaction, measured.reaction),
                                ("confirmation", derived.confirmation, measured.confirmation)):
        for key, time in sorted(times.items()):
            if key in limits and time > limits[key]:
                above.append(f"{key[0]}, {key[1]}, {key[2] // 1000} kbit/s: {what} measured {time / 1000} ms, "
                             f"derived {limits[key] / 1000} ms")
    return above


# --- the page ---


def text_ms(us):
    return "-" if us is None else f"{us / 1000:.1f}"


def up_ms(us):
    """A tenth of a millisecond, never less than it is."""
    return f"{-(-us // 100) / 10:.1f}"


CAUSES = {
    "at_once": "the call that finds it",
    "tick": "the next tick",
    "contact": "{setting} ms of ticks",
    "clocks": "two comparisons of 1000 ms",
    "frame": "the frame itself",
    "frames": "{count} x {message}, cycle {cycle} ms",
    "silence": "no {message} for {setting} ms",
    "heartbeat": "no changed counter in {message} for {setting} ms",
    "lasts": "{message} (cycle {cycle} ms) for {setting} ms",
    "gaps": "{setting} gaps of {highest} ms between frames of {message}",
    "stall": "{message} (cycle {cycle} ms) waits {setting} ms",
    "unconfirmed": "no {message} for {timeout} ms, then {setting} ms",
    "never_seen": "no {message}",
}


def cause_text(tables, row):
    messages = {message["name"]: message for message in tables["messages"]}
    message = messages.get(row["message"])
    value = tables["settings"].get(row["setting"] or "", 1)
    kind = ("tick" if row["kind"] == "at_once" and "later" in row["flags"] else
            "heartbeat" if row["kind"] == "silence" and "_HEARTBEAT_" in row["fault"] else row["kind"])
    text = CAUSES[kind].format(
        message=f"{message['heading_id']:03X}h" if message else "", count=value, setting=value,
        cycle=message["cycle_ms"] if message else "", highest=row["highest"],
        timeout=tables["settings"]["steering_command_timeout_ms"])
    wait = row.get("wait")
    return f"{text} for {tables['settings'][wait]} ms" if row["kind"] == "never_seen" else \
        f"{text}, after {tables['settings'][wait]} ms" if wait else text


def why(derived, figures, row):
    """Why a derived time is more than 1.25 times the measured one: what was not reached in the runs."""
    reasons = set()
    for (fault, topology, bitrate), time in sorted(derived.reaction.items()):
        seen = figures.get((fault, topology, bitrate))
        if fault != row["fault"] or seen is None or time <= NEAR * seen:
            continue
        lone = derived.without_collisions[fault, topology, bitrate]
        reasons |= {"collisions"} if lone < time else set()
        reasons |= {"arbitration"} if lone > NEAR * seen else set()
    return ", ".join(sorted(reasons)) or "-"


def reaction_table(derived, figures, rows):
    head = ["fault", "known by"] + [f"{topology} {bitrate // 1000}" for topology in TOPOLOGIES for bitrate in BITRATES]
    lines = ["| " + " | ".join(head + ["not reached"]) + " |", "|" + "---|" * (len(head) + 1)]
    for row in rows:
        cells = [f"`{row['fault'].removesuffix(ENGAGED)}`" + (" (output)" if "output" in row["flags"] else ""),
                 cause_text(derived.tables, row)]
        for topology in TOPOLOGIES:
            for bitrate in BITRATES:
                key = row["fault"], topology, bitrate
                cells.append(f"{up_ms(derived.reaction[key])} / {text_ms(figures.get(key))}"
                             if key in derived.reaction else "-")
        lines.append("| " + " | ".join(cells + [why(derived, figures, row)]) + " |")
    return "\n".join(lines)


def wire_table(derived):
    lines = ["| | " + " | ".join(f"{topology} {bitrate // 1000}" for topology in TOPOLOGIES for bitrate in BITRATES) + " |",
             "|" + "---|" * 7]
    parts = [("a frame of 8 bytes, with worst-case stuffing and interframe space", lambda world: world.vehicle.frame_us),
             ("blocking by a frame of others (29 bits, 8 bytes)", lambda world: world.vehicle.longest_us)]
    for name in derived.worlds["shared", 500000][0].messages:
        parts.append((f"`{name}` from its sender to the supervisor", lambda world, name=name: world.arrival_us(name)))
    parts += [("first safe frame, from the decision to its last bit", lambda world: world.send_us("throttle_command")),
              ("the same without collisions", lambda world: world.send_us("throttle_command", False)),
              ("gear P, from the decision to its last bit", lambda world: world.send_us("gear_command")),
              ("autopilot off, from the decision to its last bit", lambda world: world.send_us("turn_signal_command")),
             ("status frame 7F0h, from its slot to its last bit", World.status_us)]
    for name, what in parts:
        cells = [up_ms(max(map(what, derived.worlds[topology, bitrate]))) for topology in TOPOLOGIES
                 for bitrate in BITRATES]
        lines.append("| " + " | ".join([name] + cells) + " |")
    return "\n".join(lines)


def confirmation_table(derived, figures):
    """After the decision, for all rows whose vehicle can confirm: the greatest of all of them."""
    lines = ["| | " + " | ".join(f"{topology} {bitrate // 1000}" for topology in TOPOLOGIES for bitrate in BITRATES) + " |",
             "|" + "---|" * 7]
    cells = []
    for topology in TOPOLOGIES:
        for bitrate in BITRATES:
            keys = [key for key in derived.confirmation if key[1:] == (topology, bitrate)]
            limit = max(derived.confirmation[key] - derived.decision[key] for key in keys)
            seen = figures.get(("confirmed", topology, bitrate))
            cells.append(f"{up_ms(limit)} / {text_ms(seen)}")
    lines.append("| SAFE, after the decision / after the first safe frame | " + " | ".join(cells) + " |")
    return "\n".join(lines)


CELL = re.compile(r"^([\d.]+) / ([\d.]+|-)$")


def read_figures(text):
    """(fault, topology, bit rate) -> (derived us, measured us or None), as the page has them."""
    figures = {}
    suffix = ""
    for line in text.splitlines():
        suffix = ENGAGED if line == BEGIN.format("engagements") else "" if line == END.format("engagements") else suffix
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        name = re.match(r"^`(\w+)`", cells[0])
        first = 2 if name else 1
        key = name[1] + suffix if name else "confirmed" if cells[0].startswith("SAFE, after") else None
        if key is None or len(cells) < first + 6:
            continue
        for index, cell in enumerate(cells[first:first + 6]):
            match = CELL.match(cell)
            if match:
                place = key, TOPOLOGIES[index // 3], BITRATES[index % 3]
                figures[place] = float(match[1]) * 1000, None if match[2] == "-" else float(match[2]) * 1000
    return figures


def put(text, name, table):
    return tables.with_section("docs/reaction-time.md", text, BEGIN.format(name), END.format(name), table)


def make_page(text, derived, figures):
    text = put(text, "wire", wire_table(derived))
    rows = derived.rows
    text = put(text, "reactions", reaction_table(derived, figures, [row for row in rows if "wait" not in row]))
    text = put(text, "engagements", reaction_table(derived, figures, [row for row in rows if "wait" in row]))
    text = put(text, "confirmations", confirmation_table(derived, figures))
    return text


def figures_of(measured, derived):
    figures = dict(measured.reaction)
    for (fault, topology, bitrate), time in measured.confirmation.items():
        if (fault, topology, bitrate) not in derived.confirmation:
            continue
        key = "confirmed", topology, bitrate
        lead = measured.reaction.get((fault, topology, bitrate), 0)
        figures[key] = max(figures.get(key, 0), time - min(lead, time))
    return figures


def read_tables(arguments):
    done = subprocess.run([arguments.host_sim, "campaign", "--tables"], capture_output=True, check=False)
    if done.returncode != 0:
        raise Problem(f"{arguments.host_sim} campaign --tables: {done.stderr.decode().strip()}")
    return json.loads(done.stdout)


def check(text, derived, page):
    figures = read_figures(text)
    for key, (_, seen) in sorted(figures.items()):
        if key[0] != "confirmed" and seen is not None and key in derived.reaction and seen > derived.reaction[key]:
            raise Problem(f"{page}: {key[0]}, {key[1]}, {key[2] // 1000} kbit/s: measured above derived")
    made = make_page(text, derived, {key: seen for key, (_, seen) in figures.items() if seen is not None})
    if made != text:
        for old, new in zip(text.splitlines(), made.splitlines()):
            if old != new:
                raise Problem(f"{page} is out of date: run scripts/tools/reaction-time.py. It has\n  {old}\n"
                              f"where the code says\n  {new}")
        raise Problem(f"{page} is out of date: run scripts/tools/reaction-time.py")
    rows = [row["fault"] for row in derived.rows]
    unmeasured = [fault for fault in rows if not any(key[0] == fault and seen is not None
                                                     for key, (_, seen) in figures.items())]
    if unmeasured:
        raise Problem(f"{page}: no measurements of {', '.join(unmeasured)}")


def report_compare(derived, measured):
    above = compare(derived, measured)
    for line in above:
        print(line)
    missing = [row["fault"] for row in measured.rows if not measured.runs[row["fault"]]]
    near = sum(time >= derived.reaction[key] / NEAR for key, time in measured.reaction.items())
    engaged = sum(fault.endswith(ENGAGED) for fault in measured.runs)
    print(f"{measured.total} runs, {len(measured.runs) - engaged} faults, {engaged} of them also at an engagement (least "
          f"{min(measured.runs.values(), default=0)} runs of one), "
          f"{len(measured.reaction)} greatest times: {len(above)} above the derived time, {near} at least 1/{NEAR} of it")
    return not above and not (missing and measured.total > 10000)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--measured", action="append")
    parser.add_argument("--compare", action="append")
    parser.add_argument("--host-sim", default=str(ROOT / "build/host/bin/host_sim"))
    parser.add_argument("--page", default=str(ROOT / "docs/reaction-time.md"))
    arguments = parser.parse_args()
    try:
        derived = Derived(read_tables(arguments))
        page = pathlib.Path(arguments.page)
        if arguments.compare:
            return 0 if report_compare(derived, Measured(arguments.compare, derived.rows)) else 1
        text = page.read_text(encoding="utf-8")
        if arguments.check:
            check(text, derived, page)
            return 0
        figures = {key: seen for key, (_, seen) in read_figures(text).items() if seen is not None}
        if arguments.measured:
            measured = Measured(arguments.measured, derived.rows)
            above = compare(derived, measured)
            if above:
                raise Problem("measured above derived:\n" + "\n".join(above))
            known = set(measured.runs)  # figures of other faults stay
            figures = {key: seen for key, seen in figures.items() if key[0] not in known}
            for key, seen in figures_of(measured, derived).items():
                figures[key] = max(seen, figures.get(key, 0))  # "confirmed": the greatest of all faults
        page.write_text(make_page(text, derived, figures), encoding="utf-8")
        return 0
    except (Problem, OSError) as problem:
        print(f"reaction-time: {problem}", file=sys.stderr)
        return 1


sys.exit(main())
