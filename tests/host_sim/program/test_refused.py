"""Command lines that are refused in one line, before anything is read or written, and what belongs to that line. What the
options of all commands have in common: tests/host_sim/cli/test_options.c. Steps after --fault: live/test_vehicle_words.c."""
import os
import pathlib
import resource
import shlex
import subprocess
import unittest

import hostsim

HOST_SIM = pathlib.Path(__file__).resolve().parents[3] / "host_sim"
FILES = {"log": (HOST_SIM / "examples" / "ai-stops.log").read_text(encoding="ascii"), "c.yaml": "",
         "shared.yaml": "id_set: table\ntopology: shared\n", "gateway.yaml": "topology: gateway\n",
         "renumbered.yaml": "id_gear_command: 0x169\n", "bad.yaml": "# under three cycles\nvcu_heartbeat_timeout_ms: 29\n",
         "nul.yaml": "park: at_once\n\0\n",
         "s.yaml": (HOST_SIM / "scenarios" / "overview" / "healthy_shared.yaml").read_text(encoding="utf-8"),
         "bridge.yaml": "name: n\nshows: [TOP-2]\ntopology: gateway\nduration_ms: 1s\nexpect:\n  states: any\n"}
FORM = "WHO-WHAT[,NAME=VALUE]...@TIME is needed, such as ai-stop@2s"
STANDARD_INPUT = "host_sim: -: standard input is not read here; give the name of a file"
RUNS_NOTHING = "--tables runs nothing: no other option and no file can be combined with it"

# Of each command: arguments, and what the line says. The interface `nosuch`: all else was in order.
ROWS = {
    "": (
        ("", "no command"),
        ("drive", "'drive'"),
        ("--nonsense", "'--nonsense'"),
        ("''", "''"),
        ("-V extra", "unexpected argument 'extra'; see host_sim --help"),
        ("--version --help", "unexpected argument '--help'")),
    "atlas": (
        ("--show 0", "--show: case 0 cannot happen; the next one that can is 4"),
        ("--show 99999999", "--show: '99999999' is not a number from 0 to 168999"),
        ("--show 168999", "--show: case 168999 cannot happen, nor can any later one"),
        ("--show 100 --results r", "--show prints one case"),
        ("--show 4 --first BUS_OFF", "--show prints one case"),
        ("--show 4 --shard 1/2", "--show prints one case"),
        ("--first BUS_OFF --second BUS_OFF", "--first and --second are the same fault, BUS_OFF: a fault is not paired with itself"),
        ("--first BUS_OFF --second SELF_TEST_FAILED", "--first BUS_OFF --second SELF_TEST_FAILED: no case: in no state can"),
        ("--first SELF_TEST_FAILED --second GEAR_DEVIATION", "no case: in no state can the second of these faults follow the first")),
    "campaign": (
        ("", "--runs is missing"),
        ("--runs 3", "--seed is missing"),
        ("--runs 0 --seed 1", "--runs: '0' is not a number from 1 to 100000000"),
        ("--runs 100000001 --seed 1", "--runs"),
        ("--runs 3 --seed -1", "--seed: '-1' is not a number"),
        ("--runs 3 --seed 9223372036854775808", "--seed"),
        *((f"--runs 3 --seed 1 --shard '{shard}'", f"--shard: '{shard}'") for shard in (
            "1", "0/2", "3/2", "1/0", "1/1001", "a/b", "1/2/3", "/2", "1/", "-1/2", "1 /2", "123456789/2")),
        ("--runs 3 --seed 1 --fault NONSENSE", "unknown fault 'NONSENSE'"),
        ("--runs 3 --seed 1 --fault TX_GATE_REFUSED", "a campaign does not inject TX_GATE_REFUSED"),
        ("--runs 3 --seed 1 --newly-engaged --fault BUS_OFF", "--newly-engaged: BUS_OFF is not detected later at an engagement than under way"),
        ("--runs 3 --seed 1 --show 3", "no run 3"),
        ("--runs 3 --seed 1 --show 1 --results r", "--show prints one run"),
        ("--runs 3 --seed 1 --show 1 --shard 1/2", "--show prints one run"),
        ("--runs 3 --seed 1 --broken nowhere", "'nowhere' is not a folder"),
        ("--runs 3 --seed 1 --broken /proc", "--broken: the folder '/proc' cannot be written: "),
        ("--runs 3 --seed 1 --why a --results a", "are the same file"),
        ("--runs 3 --seed 1 --results no/where", "no/where: "),
        ("--runs 3 --seed 1 file", "unexpected argument 'file'; only --merge takes files"),
        ("--merge", "--merge: FILE is missing"),
        ("--merge log --runs 3", "--merge takes files"),
        ("--merge log --broken .", "--merge takes files"),
        ("--merge log --newly-engaged", "--merge takes files"),
        ("--merge log --results log", "are the same file"),
        *(("--tables " + more, RUNS_NOTHING) for more in (
            "--results r", "--why r", "--runs 5", "--seed 1", "--shard 1/2", "--merge", "--newly-engaged", "--fault BUS_OFF",
            "--show 1", "--broken .", "file"))),
    "config": (
        ("--schema --to-kconfig", "give only one of --schema and --to-kconfig"),
        ("--schema --config nofile", "--schema prints the schema of every configuration"),
        *((option + " --config bad.yaml", "bad.yaml:2: vcu_heartbeat_timeout_ms") for option in ("", "--to-kconfig")),
        ("--config nul.yaml", "nul.yaml:2: "),
        ("log", "unexpected argument 'log'")),
    "demo": (
        ("more", "more"),
        ("--scenario nonesuch", "no scenario 'nonesuch'"),
        ("--scenario " + "x" * 5000, "too long"),
        ("--scenario ./s.yaml --events s.yaml", "same file"),
        *((f"{option} no/where", "no/where: No such file or directory") for option in ("--events", "--report"))),
    "hunt": (
        ("", "--seed is missing"),
        ("--seed 1", "--runs or --for-minutes is missing"),
        *(("--list-hazards " + more, "--list-hazards runs nothing") for more in (
            "--checkpoint x", "--seed 1", "--shard 1/2", "--runs 1", "--for-minutes 1", "--found .")),
        ("--seed 1 --runs 1 --for-minutes 1", "give only one of --runs and --for-minutes"),
        ("--seed 1 --runs 0", "--runs: '0' is not a number from 1"),
        ("--seed 1 --runs 1 --found /proc", "--found: the folder '/proc' cannot be written: "),
        *((f"--seed 1 --runs 1 --checkpoint {path}",
           "--checkpoint: give a file; standard output cannot be read") for path in ("-", "/dev/stdout"))),
    "monitor": (
        ("", "--can or --log is missing: what to watch; see host_sim monitor --help"),
        ("--log log --can can0", "--log and --can exclude each other"),
        ("--log log --record x", "--record needs --can: a log is recorded already"),
        ("--can can0 --speed 4", "--speed needs --log"),
        ("--can can0 --skip-bad-lines", "--skip-bad-lines needs --log"),
        ("--can nosuch --record log", "log: exists already, and is not replaced"),
        *((f"--log log --speed {bad}", f"--speed: '{bad}' is not a number from 0.01 to 1000, nor max")
          for bad in ("-1", "1e3", "nan")),
        ("--log log --topology gateway", "the gateway topology needs --ai-if: which interface of the log is the AI side"),
        ("--log none.log", "none.log: No such file or directory"),
        ("--log /dev/null", "/dev/null: contains no frame")),
    "replay": (
        ("", "LOG is missing"),
        ("''", "LOG: the name is empty"),
        ("-- log --tail", "unexpected argument '--tail' after 'log'"),
        ("nofile", "nofile: No such file"),
        *((f"{option} {bad} log", f"{option}: '{bad}' is not ") for option, highest in (
            ("--tail", 8640000000), ("--start-ms", 4294967295)) for bad in (-1, highest + 1)),
        *((f"{option} ./log log", "same file") for option in (
            "--out", "--events", "--store", "--why", "--trace", "--report")),
        ("--out - --events - log", "same file"),
        ("--config c.yaml --out c.yaml log", "same file"),
        ("--config bad.yaml log", "bad.yaml:2: vcu_heartbeat_timeout_ms"),
        ("--topology SHARED log", "shared|gateway"),
        ("--id-set SHARED log", "heading|table"),
        ("--reset-cause SHARED log", "power-on|watchdog|brown-out|lock-up|software|unknown"),
        ("--topology gateway log", "the gateway topology needs --ai-if"),
        ("--config gateway.yaml log", "the gateway topology needs --ai-if"),
        ("--ai-if can0 --topology shared log", "--ai-if needs --topology gateway"),
        ("--ai-if can0 --config shared.yaml log", "--ai-if needs --topology gateway"),
        ("--ai-if 0123456789abcdef log", "'0123456789abcdef' is too long"),
        *((f"--store {path} log", "--store: give a file; standard output cannot be read") for path in ("-", "/dev/stdout"))),
    "run": (
        ("", "--can is missing: the interface of the vehicle side; see host_sim run --help"),
        ("--can nosuch --events e --out o", "nosuch: "),
        ("--can a --topology gateway", "the gateway topology needs --ai-can"),
        ("--can a --config gateway.yaml", "the gateway topology needs --ai-can"),
        ("--can a --ai-can b --topology shared", "--ai-can needs --topology gateway"),
        ("--can a --ai-can b --config shared.yaml", "--ai-can needs --topology gateway"),
        ("--can a --ai-can a --topology gateway", "--can and --ai-can are the same interface, 'a'"),
        ("--can a --ai-can a", "--can and --ai-can are the same interface, 'a'"),
        ("--can a --for 0", "--for: '0'"),
        ("--can a --for 2401h", "--for: '2401h'"),
        ("--can a --for 8640000001", "--for: '8640000001'"),
        ("--can a --events - --out -", "--out and --events"),
        ("--can a --config c.yaml --out c.yaml", "--config and --out")),
    "scenario": (
        ("", "FILE is missing"),
        ("nowhere.yaml", "nowhere.yaml: No such file"),
        ("s.yaml /dev/null", "/dev/null: not a regular file"),
        ("s.yaml -", STANDARD_INPUT),
        ("--config - s.yaml", STANDARD_INPUT),
        ("--topology shared bridge.yaml", "the file fixes the topology"),
        *((f"{option} e s.yaml s.yaml", "need a single scenario, 2 were given") for option in ("--events", "--why")),
        ("--why w --bus can0 s.yaml", "simulated bus"),
        ("--junit nowhere/j.xml s.yaml", "nowhere/j.xml: "),
        *((f"{option} s.yaml s.yaml", "the same file, 's.yaml'") for option in ("--junit", "--report")),
        (" ".join(["s.yaml"] * 1001), "FILE: more than 1000 were given"),
        ("--from log -o c.yaml", "c.yaml: exists already, and is not replaced"),
        ("--from -", "give a file; standard input cannot be read twice"),
        ("--from none.log", "none.log: No such file"),
        ("--from pipe", "--from: the log is read twice, and pipe is not a regular file"),
        ("--from c.yaml", "c.yaml: "),
        ("--from log s.yaml", "--from takes no FILE"),
        ("--from log -o no/where.yaml", "no/where.yaml: "),
        ("-o x.yaml s.yaml", "-o, --ai-if and --skip-bad-lines need --from LOG"),
        ("--from log --schema", "--schema"),
        *((f"{instead} {option}", instead.split()[0] + " runs no scenario, so it takes no option of a run")
          for instead in ("--from log", "--schema") for option in (
              "--junit=x", "--events=x", "--bus=vcan0", "--supervisor=x", "--sent=x", "--tolerance=5", "--why=x", "--report=x",
              "--trace=x")),
        *((f"--bus {bus} s.yaml", f"--bus: '{bus}'") for bus in (",", "a,", ",b", "a,b,c,d,e,f,g,h,i", "x" * 16)),
        ("--bus a,a s.yaml", "--bus: both sides are the same interface, 'a'"),
        ("--bus a bridge.yaml", "bridge.yaml: the gateway topology needs two interfaces: --bus a,IF"),
        ("--bus nosuch s.yaml", "nosuch: "),
        *((f"--bus sim {option} s.yaml", "--tolerance, --supervisor and --sent need CAN interfaces")
          for option in ("--tolerance 5", "--supervisor true", "--sent sent.log")),
        ("--bus nosuch --supervisor /nonexistent s.yaml", "--supervisor: /nonexistent: No such file or directory"),
        ("--bus nosuch --supervisor './none --option' s.yaml", "--supervisor: ./none: No such file or directory"),
        ("--bus nosuch --supervisor /etc/passwd s.yaml", "Permission denied"),
        ("--bus nosuch --supervisor /bin/true s.yaml", "nosuch: "),
        ("--bus nosuch --supervisor 'X=/none true' s.yaml", "nosuch: ")),
    "soak": (
        ("", "--hours is missing"),
        ("--hours 1", "--seed is missing"),
        ("--hours 0 --seed 1", "--hours: '0'"),
        ("--hours 1.5 --seed 1", "a time: 2h, or whole"),
        ("--hours 1 --seed 1 --checkpoint -", "--checkpoint: give a file"),
        ("--hours 1 --seed 1 --results a --checkpoint a", "same file")),
    "survey": (
        ("", "LOG or --can is missing"),
        ("log --can can0", "give only one of LOG and --can"),
        ("log --for 1s", "--for is for --can"),
        ("--can can0 --for 1m", "--for: '1m' is not a time"),
        ("--can can0 --ai-if x", "--ai-if is for a log"),
        ("--ai-can can0", "--can is missing"),
        ("log --bitrate 5", "--bitrate: '5' is not a number"),
        ("log --config-out log", "same file"),
        ("log --config-out no/c.yaml", "no/c.yaml: "),
        ("--can nosuch --config-out no/c.yaml", "no/c.yaml: "),
        ("log --json --config-out -", "--json and --config-out -: only one"),
        ("log --json --config-out /dev/stdout", "--json and --config-out -: only one"),
        ("--can nosuch", "nosuch: ")),
    "vehicle": (
        ("--ai-can nosuch", "--can is missing"),
        ("--can a-name-that-is-too-long", "at most 15 characters"),
        ("--can nosuch --for 8640000001", "--for: '8640000001'"),
        *((f"--can nosuch {more}", "nosuch: ") for more in (
            "", "--topology shared", "--ai-can other", "--ai-can other --topology gateway", "--config renumbered.yaml",
            "--fault bus-send,id=1h,bytes=01,side=ai@2000 --ai-can other", "--fault=ai-stop@1 " * 64)),
        ("--can nosuch " + "--fault=ai-stop@1 " * 65, "--fault: given more than 64 times"),
        *((f"--can nosuch --fault ai-start@1 '--fault={fault}'", f"--fault {fault}: {FORM}") for fault in (
            "ai-stop", "ai-stop,@2000", "ai-,stop@2000", "ai-freeze,,for=100@2000", "@2000", "ai_stop@2000", "ai@-2000", "")),
        ("--can nosuch --fault=ai-stop@soon",
         "at_ms: 'soon' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone"),
        ("--can nosuch --fault=ai-stop@", "the time after @ is missing, such as @2s"),
        ("--can nosuch --fault=ai-stop@86400001", "at_ms: 86400001 is not within 0 to 86400000"),
        ("--can nosuch --fault=me-stop@2000", "'me' is not one of vcu, eps, ai, operator, bus"),
        ("--can nosuch --fault=eps-set,field=fault,value=08h@3000",
         "field: this node has no field 'fault': did you mean 'faults'?"),
        ("--can nosuch --fault ai-stop@5000 --for 5000", "--fault ai-stop@5000: the time is after the end (--for)")),
}


class Refused(hostsim.Case):
    def test_each_line(self):
        for name, content in FILES.items():
            self.write(name, content)
        os.mkfifo(self.folder / "pipe")
        for command, rows in ROWS.items():
            for arguments, says in rows:
                with self.subTest(command, arguments=arguments[:100]):
                    result = self.run_program(*command.split(), *shlex.split(arguments), timeout=20)
                    self.assert_refused(result, says)
                    self.assertEqual((result.stdout, self.files()), ("", sorted([*FILES, "pipe"])))
        self.assertEqual({name: self.read(name) for name in FILES}, FILES)

    def test_real_time_that_is_refused(self):
        command = [hostsim.PROGRAM, "run", "--can", "nosuch", "--realtime"]
        if os.geteuid() == 0:
            command = ["setpriv", "--bounding-set=-sys_nice", *command]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0)))
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1))
        self.assertIn("CAP_SYS_NICE", done.stderr)


if __name__ == "__main__":
    unittest.main()
