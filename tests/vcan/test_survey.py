"""host_sim survey --can on a virtual bus: it hears what is there, sends nothing, ends in time or by a signal."""
import json
import signal
import subprocess

import canbus
from clients import MESSAGES

CYCLES = {can_id: cycle for can_id, (cycle, _, _) in MESSAGES.items()}  # in milliseconds


class Survey(canbus.Case):
    def vehicle(self, *arguments):
        self.start("vehicle", "--can", "vcan0", *arguments)
        self.bus().wait_for(0x0A3)

    def survey(self, *arguments):
        """The result of a survey that ends by itself."""
        status, stdout, stderr = self.run_to_end("survey", "--json", *arguments)
        self.assertEqual((status, stderr), (0, ""))
        return json.loads(stdout)

    def test_every_message_is_heard_and_nothing_is_sent(self):
        listener = self.bus()
        self.vehicle()
        survey = self.survey("--can", "vcan0", "--for", "2s")
        self.assertEqual(survey["source"], "vcan0")
        self.assertEqual(survey["interfaces"], ["vcan0"])
        self.assertEqual({int(message["id"], 16) for message in survey["messages"]}, set(CYCLES))
        self.assertEqual(survey["unknown"], [])
        for message in survey["messages"]:
            expected = survey["duration_ms"] / CYCLES[int(message["id"], 16)]
            self.assertLess(abs(message["count"] - expected), 0.5 * expected, message)
        self.assertGreater(survey["load"][0]["most_pct"], 5)
        self.assertLess(survey["load"][0]["most_pct"], 30)
        self.assertFalse([frame for frame in listener.listen(0) if frame.id not in CYCLES])

    def test_a_signal_ends_it_with_the_result(self):
        self.vehicle("--manual")
        process = self.start("survey", "--can", "vcan0", "--config-out", self.folder / "config.yaml", "--json")
        self.bus().listen(1.5)
        self.assertEqual(process.end(signal.SIGINT), 0)
        self.assertGreater(json.loads(process.text())["frames"], 100)
        self.assertIn("# Proposed by host_sim survey from vcan0\n", (self.folder / "config.yaml").read_text())

    def test_two_interfaces_are_a_gateway(self):
        self.vehicle("--ai-can", "vcan1")
        survey = self.survey("--can", "vcan0", "--ai-can", "vcan1", "--for", "1s")
        sides = {message["name"]: message["side"] for message in survey["messages"]}
        self.assertEqual(sides["steering_command"], "ai")
        self.assertEqual(sides["wheel_speed"], "vehicle")
        self.assertIn({"name": "topology", "value": "gateway", "default": "shared", "weakens": False,
                       "reason": "as given to this survey"}, survey["proposal"]["settings"])

    def test_an_interface_that_is_removed_ends_it_with_the_result(self):
        canbus.ip("link", "add", "dev", "vcan9", "type", "vcan")
        self.addCleanup(subprocess.run, ["ip", "link", "delete", "vcan9"], stderr=subprocess.DEVNULL, check=False)
        canbus.ip("link", "set", "vcan9", "up")
        bus = self.bus("vcan9")
        process = self.start("survey", "--can", "vcan9", "--config-out", self.folder / "config.yaml", "--json")
        for _ in range(15):
            bus.send(0x123, [1])
            bus.listen(0.1)
        canbus.ip("link", "delete", "vcan9")
        self.assertEqual(process.end(None), 2)
        self.assertEqual([unknown["id"] for unknown in json.loads(process.text())["unknown"]], ["123"])
        self.assertEqual(process.text("stderr"), "host_sim: vcan9 is down\nhost_sim: vcan9: the interface no longer exists\n")
        self.assertIn("from vcan9", (self.folder / "config.yaml").read_text())

    def test_a_silent_bus_is_no_result(self):
        self.assertEqual(self.run_to_end("survey", "--can", "vcan2", "--for", "300ms"),
                         (2, "", "host_sim: vcan2: no frame came; check the bit rate and the cable, and that ip link shows "
                                 "the interface as up\n"))
