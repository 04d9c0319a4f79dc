"""Does `--why` name the fault that was injected? Reads what `host_sim campaign --why FILE` writes.

    /usr/bin/python3 tests/host_sim/program/logs/why_campaign.py FILE...

The table below is written by hand from the requirements; nothing of the program's own table is used.
"""
import collections
import json
import sys

VCU, EPS, AI = "vehicle_status", "eps_status", "turn_signal_command"
COMMANDS = ("gear_command", "throttle_command", "steering_command")

# kind, message that tells, cycle of that message in ms (0: none, the cause is not compared): the faults
KINDS = {
    ("own", None, 0): "SELF_TEST_FAILED MEMORY_CORRUPTED CONFIG_INVALID SUPERVISOR_RESET STEP_OVERRUN STORE_INVALID",
    ("hardware", None, 0): "OUTPUT_FEEDBACK EMERGENCY_STOP CLOCK_DEVIATION",
    ("bus", None, 0): "BUS_OFF TX_STALLED RX_OVERRUN ERROR_PASSIVE AI_BUS_OFF",
    ("silence", VCU, 10): "VCU_HEARTBEAT_LOST",
    ("stuck", VCU, 10): "VCU_HEARTBEAT_STUCK",
    ("silence", "steering_status", 10): "EPS_HEARTBEAT_LOST",
    ("stuck", "steering_status", 10): "EPS_HEARTBEAT_STUCK",
    ("silence", AI, 100): "AI_HEARTBEAT_LOST",
    ("stuck", AI, 100): "AI_HEARTBEAT_STUCK",
    ("bit", EPS, 10): "EPS_OVER_CURRENT_SHUTDOWN EPS_TEMP_ABOVE_120 EPS_MOTOR_ENCODER EPS_POSITION_ENCODER EPS_TEMP_ABOVE_110",
    ("score", EPS, 10):
        "EPS_UNDER_VOLTAGE EPS_OVER_VOLTAGE EPS_EXCESSIVE_CURRENT EPS_MODE_OFF EPS_MODE_INVALID EPS_MODE_NOT_ANGLE",
    ("bit", VCU, 10):
        "VCU_EPS_HARDWARE_FAULT VCU_EPS_CAN_BUS_FAULT S_DRIVER_ALARM REMOTE_SIGNAL_LOST REMOTE_POWER_LOST VCU_AI_CAN_LOST "
        "VCU_LEVEL2_ALARM",
    ("mode", VCU, 10): "MODE_INVALID MODE_FLAPPING MODE_NONE",
    ("silence", EPS, 10): "EPS_STATUS_TIMEOUT",
    ("silence", "gear_status", 25): "GEAR_STATUS_TIMEOUT",
    ("silence", "throttle_status", 10): "THROTTLE_STATUS_TIMEOUT",
    ("silence", "wheel_speed", 10): "WHEEL_SPEED_TIMEOUT",
    ("silence", "steering_position", 10): "STEERING_POSITION_TIMEOUT",
    ("silence", "gear_command", 100): "GEAR_COMMAND_TIMEOUT",
    ("silence", "throttle_command", 100): "THROTTLE_COMMAND_TIMEOUT",
    ("silence", "steering_command", 25): "STEERING_COMMAND_TIMEOUT",
    ("value", COMMANDS, 100): "AI_COMMAND_OUT_OF_RANGE",
    ("score", "gear_status", 25): "GEAR_STATUS_INVALID",
    ("score", "throttle_status", 10): "THROTTLE_STATUS_INVALID",
    ("score", "steering_status", 10): "STEERING_ANGLE_INVALID",
    ("budget", "steering_status", 25): "STEERING_DEVIATION",
    ("budget", "throttle_status", 10): "THROTTLE_DEVIATION",
    ("budget", "gear_status", 25): "GEAR_DEVIATION",
    ("budget", VCU, 100): "AUTOPILOT_OFF_IGNORED",
    ("budget", "throttle_status", 25): "THROTTLE_IN_PARK",
    ("intrusion", "gear_command", 100): "FOREIGN_COMMAND_SENDER COMMAND_TOO_FAST",
    ("vehicle", (VCU, "gear_status"), None): "SAFE_STATE_UNCONFIRMED",
    ("vehicle", "wheel_speed", None): "VEHICLE_NOT_STOPPING",
    ("budget", "wheel_speed", 10): "SPEED_IMPLAUSIBLE",
    ("intrusion", None, 100): "STATUS_ID_IN_USE",
    ("own", AI, 100): "WRONG_ID_SET",
}
EXPECTED = {fault: kind for kind, faults in KINDS.items() for fault in faults.split()}

# Faults that are not the reason of a trip here: what trips is another one.
ANOTHER = {"STORE_INVALID": "SUPERVISOR_RESET"}

# From the injection to its first frame: the cycle of the message, some frames that share the wire with it (125 kbit/s),
# and the time that a newly sent frame needs.
WIRE_MS = 25
COMMAND_CYCLE_MS = 100

# A cause that began before the injection, or much later, by its nature.
BEFORE = {"MODE_FLAPPING"}  # the first of four engagements
LATER = {"STEERING_DEVIATION"}  # when the angle that is commanded leaves the one that is held


def problem_of(line):
    """What is wrong about a run; None: nothing."""
    fault = line["fault"]
    reason = ANOTHER.get(fault, fault)
    kind, messages, cycle = EXPECTED[reason]
    if not isinstance(messages, tuple):
        messages = (messages,)
    trips = [trip for trip in line["trips"] if trip["reason"] == reason]
    if not trips:
        return "not among the trips: %s" % [trip["reason"] for trip in line["trips"]]
    trip = trips[0]
    if trip["kind"] != kind:
        return "kind %s" % trip["kind"]
    if trip["message"] not in messages:
        return "message %s" % trip["message"]
    if (trip["message"] is None) != (trip["id"] is None) and fault != "STATUS_ID_IN_USE":
        return "id %s" % trip["id"]
    return cause_problem(line, fault, trip, cycle)


def cause_problem(line, fault, trip, cycle):
    """What is wrong about the time of the cause."""
    cause = trip["cause_ms"]
    if cause is None or cause > trip["t_ms"]:
        return "cause at %s, trip at %d" % (cause, trip["t_ms"])
    if cycle is None or fault in BEFORE or fault in LATER or cycle == 0:
        return None
    first = min(line["steps_ms"], line["cause_ms"])
    last = line["cause_ms"] + cycle
    if line["engage_ms"] and fault.startswith("EPS_MODE_"):
        first = min(first, line["engage_ms"])  # in manual the EPS assists: the injected mode only goes on with that
    if line["engage_ms"]:  # what is compared with a command begins with the first command after the engagement
        last = max(last, line["engage_ms"] + COMMAND_CYCLE_MS + cycle)
    if not first - WIRE_MS <= cause <= last + WIRE_MS:
        return "cause at %d ms, injected at %d" % (cause, line["cause_ms"])
    return None


def check(lines):
    """(runs by fault, {fault: [(run, problem)]})"""
    runs = collections.Counter()
    problems = collections.defaultdict(list)
    for line in lines:
        runs[line["fault"]] += 1
        problem = problem_of(line)
        if problem is not None:
            problems[line["fault"]].append((line["run"], problem))
    return runs, problems


def read(paths):
    for path in paths:
        with open(path, encoding="ascii") as lines:
            for line in lines:
                yield json.loads(line)


def main(paths):
    runs, problems = check(read(paths))
    for fault in sorted(runs):
        print("%-28s %6d runs, %d exceptions" % (fault, runs[fault], len(problems[fault])))
        for run, problem in problems[fault][:3]:
            print("    run %d: %s" % (run, problem))
    wrong = sum(len(found) for found in problems.values())
    print("%d runs, %d exceptions" % (sum(runs.values()), wrong))
    return 1 if wrong or not runs else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
