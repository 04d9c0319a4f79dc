"""host_sim vehicle as far as it needs no CAN: everything is checked before a socket is opened."""
import re
import unittest

import hostsim

FORM = "WHO-WHAT[,NAME=VALUE]...@TIME is needed, such as ai-stop@2s"
FAULTS = {
    "ai-stop": FORM,
    "ai-stop,@2000": FORM,
    "ai-,stop@2000": FORM,
    "ai-freeze,,for=100@2000": FORM,
    "@2000": FORM,
    "ai_stop@2000": FORM,
    "ai@-2000": FORM,
    "": FORM,
    "ai-stop@soon": "at_ms: 'soon' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone",
    "ai-stop@": "the time after @ is missing, such as @2s",
    "ai-stop@1.5": "at_ms: '1.5' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone",
    "ai-stop@25h": "at_ms: '25h' is not within 0ms to 1d",
    "ai-stop@1us": "at_ms: '1us' is not a whole number of milliseconds",
    "bus-send,id=0123,bytes=01@2s": "id: '0123' is not an identifier: 168h, 0x168, or decimal 360",
    "ai-stop@86400001": "at_ms: 86400001 is not within 0 to 86400000",
    "me-stop@2000": "'me' is not one of vcu, eps, ai, operator, bus",
    "supervisor-hang,for_ms=1@2000": "'supervisor' is not one of vcu, eps, ai, operator, bus",
    "ai-@2000": "the action of ai is missing",
    "ai-explode@2000": "ai: unknown action 'explode'; docs/scenarios.md lists them",
    "operator-stop@2000": "operator: unknown action 'stop'; docs/scenarios.md lists them",
    "eps-set,value=08h@3000": "'set' needs 'field'",
    "eps-set,field=faults@3000": "'set' needs 'value'",
    "eps-set,field=fault,value=08h@3000": "field: this node has no field 'fault': did you mean 'faults'?",
    "eps-set,field=faults,value=8@3000": "value: '8' is not a hexadecimal number such as 168h or 0x168",
    "eps-set,field=faults,value=100h@3000": "value: 100h is above FFh",
    "eps-freeze@3000": "eps: unknown action 'freeze': did you mean 'freeze_counter'?",
    "ai-stop,frames=3@2000": "'stop' takes no 'frames'",
    "ai-lag,by_ms=60001@2000": "by_ms: 60001 is not within 0 to 60000",
    "ai-lag,by=1@2000": "unknown key 'by' in a step; docs/scenarios.md lists them",
    "ai-mute,message=gear_status@2000": "message: another node sends gear_status",
    "operator-press,button=3@2000": "button: 3 is not within 1 to 2",
    "bus-send,bytes=01@2000": "either 'id' or 'message' is needed",
    "bus-send,id=800h,bytes=01@2000": "id: 800h is above 7FFh",
    "bus-send,id=1h,bytes=01,side=ai@2000": "side: only topology: gateway has an AI side",
    "bus-destroy,frames=1@2000": "bus: 'destroy' is for the simulated bus only",
}


class Vehicle(hostsim.Case):
    def vehicle(self, *arguments):
        return self.run_program("vehicle", *arguments, timeout=20)

    def test_help_names_every_option(self):
        text = self.run_good("vehicle", "--help").stdout
        for option in ("--can", "--ai-can", "--topology", "--id-set", "--config", "--fault", "--manual", "--for"):
            self.assertRegex(text, r"(?m)^  %s( |$)" % option)

    def test_a_configuration(self):
        self.write("c.yaml", "id_gear_command: 0x169\n")
        self.assert_no_interface(self.vehicle("--can", "nosuch", "--config", "c.yaml"))
        self.write("c.yaml", "id_gear_command: 0x169\nid_eps_status: 0x169\n")
        self.assert_refused(self.vehicle("--can", "nosuch", "--config", "c.yaml"),
                            "c.yaml:2: id_eps_status: another message has this identifier")

    def test_faults_that_make_no_sense(self):
        for fault, what in FAULTS.items():
            result = self.vehicle("--can", "nosuch", "--fault", "ai-start@1", "--fault=" + fault)
            self.assertEqual((result.status, result.stdout, result.stderr),
                             (2, "", "host_sim: --fault %s: %s\n" % (fault, what)))

    def test_a_fault_after_the_end(self):
        result = self.vehicle("--can", "nosuch", "--fault", "ai-stop@5000", "--for", "5000")
        self.assertEqual(result.stderr, "host_sim: --fault ai-stop@5000: the time is after the end (--for)\n")
        self.assertEqual(result.status, 2)

    def test_too_many_faults(self):
        faults = ["--fault=ai-stop@%d" % i for i in range(64)]
        self.assert_no_interface(self.vehicle("--can", "nosuch", *faults))
        self.assert_refused(self.vehicle("--can", "nosuch", *faults, "--fault=ai-stop@64"), "--fault: given more than 64 times")

    def assert_no_interface(self, result):
        """With all else in order it gets as far as the interface; one kernel has no CAN, another no such interface."""
        self.assertEqual(result.status, 2)
        self.assertTrue(re.fullmatch("host_sim: nosuch: (this kernel has no CAN.*|there is no such interface)\n",
                                     result.stderr), result.stderr)

    def test_interfaces(self):
        self.assert_refused(self.vehicle(), "--can is missing")
        self.assert_refused(self.vehicle("--ai-can", "nosuch"), "--can is missing")
        self.assert_refused(self.vehicle("--can", "nosuch", "--topology", "gateway"), "needs --ai-can")
        self.assert_refused(self.vehicle("--can", "nosuch", "--ai-can", "other", "--topology", "shared"), "--ai-can",
                            "gateway")
        self.assert_refused(self.vehicle("--can", "nosuch", "--ai-can", "nosuch"), "the same interface, 'nosuch'")
        self.assert_refused(self.vehicle("--can", "a-name-that-is-too-long"), "at most 15 characters")
        for more in ((), ("--topology", "shared"), ("--ai-can", "other"), ("--ai-can", "other", "--topology", "gateway"),
                     ("--fault", "bus-send,id=1h,bytes=01,side=ai@2000", "--ai-can", "other")):
            self.assert_no_interface(self.vehicle("--can", "nosuch", *more))

    def test_numbers_and_words(self):
        for option, bad in (("--for", "0"), ("--for", "1m"), ("--for", "8640000001"), ("--id-set", "both"),
                            ("--topology", "star")):
            self.assert_refused(self.vehicle("--can", "nosuch", option, bad), option, "'%s'" % bad)
        self.assert_refused(self.vehicle("--can", "nosuch", "vcan0"), "unexpected argument 'vcan0'")


if __name__ == "__main__":
    unittest.main()
