"""host_sim vehicle as far as it needs no CAN: everything is checked before a socket is opened."""
import re
import unittest

import hostsim

FORM = "WHO-WHAT[,NAME=VALUE]...@TIME is needed, such as ai-stop@2s"
FAULTS = {  # what makes no sense in a step itself: tests/host_sim/live/test_vehicle_words.c
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
    "ai-stop@86400001": "at_ms: 86400001 is not within 0 to 86400000",
    "me-stop@2000": "'me' is not one of vcu, eps, ai, operator, bus",
    "eps-set,field=fault,value=08h@3000": "field: this node has no field 'fault': did you mean 'faults'?",
}


class Vehicle(hostsim.Case):
    def vehicle(self, *arguments):
        return self.run_program("vehicle", *arguments, timeout=20)

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
