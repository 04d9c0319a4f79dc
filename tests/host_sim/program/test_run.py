"""host_sim run, and scenario on CAN interfaces: what needs no CAN. The rest: tests/vcan/test_run.py."""
import os
import pathlib
import re
import resource
import subprocess
import unittest

import hostsim

SCENARIOS = pathlib.Path(__file__).resolve().parents[3] / "host_sim" / "scenarios"
NO_INTERFACE = "nosuchcan0"


class Run(hostsim.Case):
    def test_which_interface(self):
        self.assert_refused(self.run_program("run"), "--can is missing")
        self.assert_refused(self.run_program("run", "can0"), "unexpected argument 'can0'")
        self.assert_refused(self.run_program("run", "--can"), "--can needs a value: IF")
        self.assert_refused(self.run_program("run", "--can="), "--can: the value is empty")

    def test_an_interface_that_is_not_there_is_named(self):
        for name in (NO_INTERFACE, "a-name-longer-than-any"):
            result = self.run_program("run", "--can", name, "--events", "e", "--out", "o")
            self.assert_refused(result, name + ": ")
            self.assertRegex(result.stderr, "no such interface|kernel has no CAN|longer")
        self.assertEqual(self.files(), [])

    def test_the_gateway_needs_two_interfaces_and_the_shared_bus_has_one(self):
        self.assert_refused(self.run_program("run", "--can", "a", "--topology", "gateway"), "needs --ai-can")
        for shared in (("--topology", "shared"), ("--config", "shared.yaml")):
            self.write("shared.yaml", "id_set: table\ntopology: shared\n")
            self.assert_refused(self.run_program("run", "--can", "a", "--ai-can", "b", *shared),
                                "--ai-can needs --topology gateway")
        for gateway in (("--topology", "gateway"), ()):
            self.assert_refused(self.run_program("run", "--can", "a", "--ai-can", "a", *gateway),
                                "--can and --ai-can are the same interface, 'a'")
        self.write("gateway.yaml", "topology: gateway\n")
        self.assert_refused(self.run_program("run", "--can", "a", "--config", "gateway.yaml"), "needs --ai-can")

    def test_bad_values(self):
        for bad in ("0", "-1", "1sec", "0.5", "2401h", "8640000001"):
            self.assert_refused(self.run_program("run", "--can", "a", "--for=" + bad), "--for", "'%s'" % bad)
        self.write("c.yaml", "no_such_setting: 1\n")
        self.assert_refused(self.run_program("run", "--can", "a", "--config", "c.yaml"), "c.yaml:1: ")

    def test_two_files_are_two(self):
        self.assert_refused(self.run_program("run", "--can", "a", "--events", "-", "--out", "-"), "--out and --events")
        self.write("c.yaml", "")
        self.assert_refused(self.run_program("run", "--can", "a", "--config", "c.yaml", "--out", "c.yaml"),
                            "--config and --out")

    def test_real_time_that_is_refused(self):
        command = [hostsim.PROGRAM, "run", "--can", NO_INTERFACE, "--realtime"]
        if os.geteuid() == 0:
            command = ["setpriv", "--bounding-set=-sys_nice", *command]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0)))
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1))
        self.assertIn("CAP_SYS_NICE", done.stderr)


class ScenarioBus(hostsim.Case):
    def scenario(self, bus, *arguments):
        return self.run_program("scenario", "--bus", bus, *arguments, SCENARIOS / "overview" / "healthy_shared.yaml")

    def test_names_that_are_none(self):
        for bus in (",", "a,", ",b", "a,b,c,d,e,f,g,h,i", "x" * 16):
            self.assert_refused(self.scenario(bus), "--bus: '%s'" % bus)
        self.assert_refused(self.scenario("a,a"), "--bus: both sides are the same interface, 'a'")

    def test_an_interface_that_is_not_there_is_named(self):
        result = self.scenario(NO_INTERFACE)
        self.assert_refused(result, NO_INTERFACE + ": ")
        self.assertEqual(result.stdout, "")

    def test_what_belongs_to_the_other_bus(self):
        for option in (("--tolerance", "5"), ("--supervisor", "true"), ("--sent", "sent.log")):
            self.assert_refused(self.scenario("sim", *option), "--tolerance, --supervisor and --sent need CAN interfaces")

    def test_an_external_supervisor_that_is_not_there_is_named_in_one_line(self):
        for command in ("/nonexistent", "./none --option"):
            self.assert_refused(self.scenario(NO_INTERFACE, "--supervisor", command),
                                f"--supervisor: {command.split()[0]}: No such file or directory")
        self.assert_refused(self.scenario(NO_INTERFACE, "--supervisor", "/etc/passwd"), "Permission denied")
        for command in ("/bin/true", "X=/none true"):
            self.assert_refused(self.scenario(NO_INTERFACE, "--supervisor", command), NO_INTERFACE)

    def test_the_gateway_needs_two_interfaces(self):
        gateway = next(path for path in sorted(SCENARIOS.glob("*/*.yaml"))
                       if re.search("^topology: gateway", path.read_text(encoding="utf-8"), re.MULTILINE))
        self.assert_refused(self.run_program("scenario", "--bus", "a", gateway), str(gateway),
                            "needs two interfaces: --bus a,IF")


if __name__ == "__main__":
    unittest.main()
