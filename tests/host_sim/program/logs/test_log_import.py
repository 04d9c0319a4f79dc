"""Logs of other formats, as other programs write them: can-utils and python-can. Each gives the same replay as the log
that it was made from."""
import gzip
import json
import os
import resource
import subprocess

import hostsim
import traffic

ENGAGED = 1000


class Case(hostsim.Case):
    def outcome(self, log, name="log"):
        """Events and sent frames of a replay; the summary apart from what depends on the format."""
        result = self.replay(log, name=name)
        return result.events(), result.text("out.log")


def silence(frame):
    return None if frame.name == "eps_status" and frame.t_ms > 2000 else frame


class OtherPrograms(Case):
    def setUp(self):
        super().setUp()
        self.log = traffic.log(traffic.frames(3000, ENGAGED, edit=silence))
        self.expected = self.outcome(self.log)
        self.assertIn("EPS_STATUS_TIMEOUT", [event.get("reason") for event in self.expected[0]])
        self.write("plain.log", self.log)

    def convert(self, *command):
        """Times are read as UTC, and log2asc writes local ones."""
        with open(self.folder / "plain.log", "rb") as plain:
            return subprocess.run(command, cwd=self.folder, check=True, stdout=subprocess.PIPE, stdin=plain,
                                  env={**os.environ, "TZ": "UTC"}).stdout

    def test_gzip(self):
        packed = self.convert("gzip", "-c")
        self.assertEqual(self.outcome(packed), self.expected)
        self.assertEqual(self.outcome(packed, name="misnamed.log"), self.expected)

    def test_the_screen_of_candump(self):
        screen = self.convert("log2long")
        self.assertIn(b"[8]  00", screen)
        self.assertEqual(self.outcome(screen), self.expected)

    def test_asc_of_can_utils(self):
        self.convert("log2asc", "-I", "plain.log", "-O", "log.asc", "can0")
        asc = (self.folder / "log.asc").read_bytes()
        self.assertIn(b"base hex", asc)
        self.assertEqual(self.outcome(asc), self.expected)

    def test_asc_of_python_can(self):
        self.convert("/usr/bin/python3", "-m", "can.logconvert", "plain.log", "log.asc")
        asc = (self.folder / "log.asc").read_bytes()
        self.assertIn(b"Begin Triggerblock", asc)
        events, sent = self.outcome(asc)
        self.assertEqual(events, self.expected[0])
        self.assertEqual(len(sent.splitlines()), len(self.expected[1].splitlines()))

    def test_blf_by_the_command_that_the_message_names(self):
        self.convert("/usr/bin/python3", "-m", "can.logconvert", "plain.log", "my.blf")
        result = self.run_program("replay", "my.blf")
        self.assert_refused(result, "my.blf: a Vector BLF log; convert it: ")
        command = result.stderr.split("convert it: ")[1].split(" (")[0]
        self.assertEqual(command, "python3 -m can.logconvert my.blf my.blf.log")
        self.convert("/usr/bin/python3", *command.split()[1:])
        events, _ = self.outcome(self.read("my.blf.log"))
        self.assertEqual([event for event in events if event["event"] == "state"],
                         [event for event in self.expected[0] if event["event"] == "state"])


class OfTshark(Case):
    """The command for captures, run in bash with a stand-in for tshark that prints columns as tshark does."""
    BASE = {"frame.time_epoch": "1700000001.123456000"}
    ERROR = dict.fromkeys(("tx_timeout", "lostarb", "ctrl", "prot", "trx", "ack", "busoff", "buserror", "restarted"), 0)

    def frame(self, can_id, length, data="", xtd=0, rtr=0, **more):
        return {**self.BASE, "can.id": can_id, "can.len": length, "can.flags.xtd": xtd, "can.flags.rtr": rtr,
                "data.data": data, **more}

    def error(self, *names, **more):
        bits = {**self.ERROR, **dict.fromkeys(names, 1)}
        return {**self.BASE, "can.len": 8, **{"can.err." + name: value for name, value in bits.items()}, **more}

    def converted(self, frames):
        """What the command makes of frames: columns by their names."""
        (self.folder / "bin").mkdir()
        self.write("frames.json", json.dumps(frames))
        stand_in = self.write("bin/tshark", "#!/usr/bin/python3\nimport json, sys\n"
                              "assert sys.argv[1:5] == ['-r', 'my.pcap', '-T', 'fields']\n"
                              "for frame in json.load(open('frames.json')):\n"
                              "    print(*(frame.get(word.removeprefix('-e'), '') for word in sys.argv[5:]), sep='\\t')\n")
        stand_in.chmod(0o755)
        self.write("my.pcap", b"\xD4\xC3\xB2\xA1\x02\0\x04\0")
        refused = self.run_program("replay", "my.pcap")
        self.assert_refused(refused, "my.pcap: a pcap capture; convert it: ")
        subprocess.run(["bash", "-c", refused.stderr.split("convert it: ")[1]], cwd=self.folder, check=True,
                       env={**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}"})
        return [line.removeprefix("(1700000001.123456) can0 ") for line in (self.folder / "my.pcap.log").read_text(encoding="ascii").splitlines()]

    def test_frames(self):
        self.assertEqual(self.converted([
            self.frame(0x43F, 8, "0000000000000011"), self.frame(0x43F, 1, "01", xtd=1), self.frame(0xCF00400, 2, "0102", xtd="True"),
            self.frame(0x43F, 8, rtr=1), self.frame(0x363, 0, xtd="False", rtr="False"),
            self.frame(0x123, 3, "616263", **{"canfd.flags.brs": 1, "canfd.flags.esi": 0}),
        ]), ["43F#0000000000000011", "0000043F#01", "0CF00400#0102", "43F#R8", "363#", "123##1616263"])
        self.run_good("replay", "my.pcap.log")

    def test_error_frames(self):
        controller = {"can.err.ctrl." + name: value for name, value in (("rx_passive", 1), ("tx_passive", 0), ("tx_warning", 1))}
        self.assertEqual(self.converted([self.error("busoff"), self.error("restarted"), self.error("ctrl", **controller),
                                         self.error("buserror", "prot"), self.error()]),
                         ["20000040#" + 16 * "0", "20000100#" + 16 * "0", "20000004#0018" + 12 * "0", "20000088#" + 16 * "0",
                          "20000000#" + 16 * "0"])
        self.run_good("survey", "my.pcap.log")

    def test_what_it_cannot_write_is_left_out(self):
        """Data that tshark dissected further, and frames of other networks."""
        self.assertEqual(self.converted([self.frame(0x43F, 8), dict(self.BASE), self.frame(0x168, 1, "00")]), ["168#00"])


class Bounded(Case):
    def test_memory_is_bounded(self):
        """Compressed files one after the other, 20 MB of text, with 16 MiB of address space for data."""
        minute = gzip.compress(traffic.log(traffic.frames(60000, ENGAGED)).encode(), 1)
        limit = (lambda: resource.setrlimit(resource.RLIMIT_DATA, (16 << 20, 16 << 20))) if hostsim.PART == 1 else None
        result = self.run_good("survey", "-", stdin=minute * 10, preexec_fn=limit)
        self.assertIn("426000 frames", result.stdout)


if __name__ == "__main__":
    hostsim.unittest.main()
