"""`--report FILE.html`: what is written, what is refused, and how much an hour of traffic takes. In a browser:
test_report_browser.py."""
import json
import pathlib
import re
import resource
import unittest

import hostsim
import traffic

ROOT = pathlib.Path(__file__).resolve().parents[4]
EXAMPLE = ROOT / "host_sim/examples/ai-stops.log"
SILENCE = ROOT / "host_sim/scenarios/motion/steering_command_timeout.yaml"
ENGAGED = traffic.log(traffic.frames(3000))
HOUR_S = 3600 // hostsim.PART


def data_of(page):
    """The data in a page."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])


def headline(page):
    return re.search(r'<h1 id="headline">(.*?)</h1>', page)[1]


class Written(hostsim.Case):
    def test_replay(self):
        self.run_good("replay", "--report", "r.html", EXAMPLE)
        page = self.read("r.html")
        self.assertEqual(headline(page), "The supervisor would have stopped this vehicle because the AI computer no "
                         "longer sent steering commands.")
        data = data_of(page)
        self.assertEqual([(trip["t_us"], trip["reason"], trip["kind"]) for trip in data["trips"]],
                         [(1007000, "STEERING_COMMAND_TIMEOUT", "silence")])
        self.assertTrue(data["about"]["recording"])
        self.assertEqual(data["about"]["interfaces"][0], "can0")
        self.assertRegex(data["about"]["clock"], r"^2023-11-1\d \d\d:\d\d:\d\d\.000$")
        self.assertEqual(data["series"]["lanes"]["state"]["v"], ["INIT", "STANDBY", "ACTIVE", "TRIPPED", "SAFE"])
        self.assertEqual(len(data["series"]["messages"]), 11)

    def test_scenario_demo_and_standard_output(self):
        self.run_good("scenario", "--report", "r.html", SILENCE)
        self.assertFalse(data_of(self.read("r.html"))["about"]["recording"])
        self.run_good("demo", "--report", "d.html")
        self.assertEqual([trip["reason"] for trip in data_of(self.read("d.html"))["trips"]],
                         ["STEERING_COMMAND_TIMEOUT", "EPS_OVER_CURRENT_SHUTDOWN"])
        out = self.run_good("replay", "--report", "-", EXAMPLE).stdout
        self.assertTrue(out.startswith("<!doctype html>"), out[:80])
        self.assertTrue(out.endswith("</html>\n"), out[-80:])

    def test_a_gateway_has_both_sides(self):
        self.write("log", traffic.log(traffic.frames(3000, engage_ms=1000, ai_interface="can1")))
        self.run_good("replay", "--topology", "gateway", "--ai-if", "can1", "--report", "r.html", "log")
        data = data_of(self.read("r.html"))
        self.assertEqual(data["about"]["interfaces"], ["can0", "can1"])
        self.assertTrue(data["about"]["gateway"])
        self.assertIn("throttle_command", data["series"]["overview"]["signals"])


class Refused(hostsim.Case):
    def test_a_disk_that_is_full_leaves_the_report_that_was_there(self):
        self.write("log", ENGAGED)
        self.write("r.html", "good")
        limit = (20000, 20000)  # bytes that a file may have
        result = self.run_program("replay", "--report", "r.html", "log",
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit), restore_signals=False)
        self.assert_refused(result, "r.html: File too large")
        self.assertEqual(self.read("r.html"), "good")
        self.assertEqual(self.files(), ["log", "r.html"])


class Hour(hostsim.Case):
    """Uneasy values all the time, a trip in every fourth block, and the operator's reset after it."""

    BLOCK_MS = 26000

    def block(self, number, trips):
        def edit(frame):
            if trips and frame.name.endswith("_command") and 6000 <= frame.t_ms < 9000:
                return None  # the AI computer is silent
            data = bytearray(frame.data)
            driving = frame.t_ms < 7000 or not trips
            if frame.name == "vehicle_status":
                data[6] = traffic.AUTOPILOT if driving else traffic.MANUAL
                data[6] |= traffic.BUTTON_1 if trips and 15000 <= frame.t_ms < 16500 else 0
            elif frame.name == "wheel_speed":
                speed = 400 + frame.t_us // 10000 * 7919 % 61 if driving else 0
                data = bytearray(speed.to_bytes(4, "little") * 2)
            elif frame.name == "gear_status" and not driving:
                data[0] = traffic.GEAR_P
            elif frame.name == "throttle_status":
                data[0] = 5 + frame.t_us // 10000 * 7919 % 6 if driving else 0
            elif frame.name == "steering_status":
                data[2:4] = (9000 + frame.t_us // 10000 * 7919 % 97).to_bytes(2, "little")
            frame.data = bytes(data)
            return frame

        frames = traffic.frames(self.BLOCK_MS, engage_ms=0, edit=edit)
        return traffic.log(frames, traffic.BASE_US + number * self.BLOCK_MS * 1000)

    def test_an_hour_makes_a_page_under_5_mb_in_under_5_s(self):
        manual = traffic.log(traffic.frames(self.BLOCK_MS))
        four = "".join(self.block(number, number == 1) for number in range(1, 5))
        self.write("log", manual + traffic.repeated(four, HOUR_S * 1000 // (4 * self.BLOCK_MS) + 1))
        cpu_s = self.least_cpu_s(5, "replay", "--report", "r.html", "log")
        page = self.read("r.html")
        data = data_of(page)
        print(f"an hour: {len(page) / 1e6:.2f} MB, {cpu_s:.2f} s CPU, {len(data['trips'])} trips", flush=True)
        self.assertGreaterEqual(len(data["trips"]), HOUR_S // 110)
        self.assertEqual(len(data["series"]["details"]), min(10, sum(not trip["from_recording"] for trip in data["trips"])))
        self.assertLess(len(page), 5e6)
        self.assertLess(cpu_s, 5)


if __name__ == "__main__":
    unittest.main()
