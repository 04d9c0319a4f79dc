"""host_sim monitor from outside: the screen in tmux, lines where there is no terminal."""
import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

import hostsim
import traffic
from tmux import Tmux

ROOT = pathlib.Path(__file__).parents[3]
EXAMPLE = ROOT / "host_sim/examples/ai-stops.log"
PATIENCE_S = 30
GATEWAY = "host_sim: not the default: topology: gateway (default shared)\n"


def long_log(seconds):
    """A healthy vehicle in manual mode; at 2 s the VCU reports the loss of the remote signal, for half a second."""
    def edit(frame):
        if frame.name == "vehicle_status" and 2000 <= frame.t_ms < 2500:
            frame.data = frame.data[:4] + b"\x01" + frame.data[5:]
        return frame
    return traffic.log(traffic.frames(1000 * seconds, senders=("vcu", "eps"), edit=edit))


class Screen(hostsim.Case):
    def open(self, width, height, *arguments, **environment):
        tmux = Tmux(self.folder, width, height, hostsim.PROGRAM, "monitor", *arguments, **environment)
        self.addCleanup(tmux.close)
        return tmux

    def test_80_by_24(self):
        tmux = self.open(80, 24, "--log", EXAMPLE)
        lines = tmux.wait_for("END")
        self.assertRegex(lines[0], r"^ host_sim monitor  ai-stops.log  END +\d+ frames/s  0:00:01$")
        self.assertEqual(lines[1], "shadow      SAFE: STEERING_COMMAND_TIMEOUT  LED code 14")
        self.assertRegex(lines[23], "^ space  pause .* q  quit$")
        tmux.press("q")
        self.assertEqual(tmux.exit_status(), 0)

    def test_colours_and_none(self):
        red, grey = "\033[31m", "\033[90m"
        with_colours = "\n".join(self.colours(NO_COLOR=""))
        self.assertIn(red, with_colours)
        self.assertIn(grey, with_colours)
        without = "\n".join(self.colours(NO_COLOR="1"))
        self.assertNotRegex(without, "\033\\[[0-9;]*[39][0-7]m")
        self.assertIn("LATE", without)

    def colours(self, **environment):
        tmux = self.open(80, 24, "--log", EXAMPLE, **environment)
        tmux.wait_for("END")
        lines = tmux.lines("-e")
        tmux.close()
        return lines

    def test_a_terminal_without_utf_8_gets_ascii(self):
        tmux = self.open(80, 24, "--log", EXAMPLE, LANG="C", LC_ALL="C")
        lines = tmux.wait_for("END")
        self.assertRegex(lines[11], r"^0A3h gear_status          25.0 ##\.\.\.\.\.\.  25.0  25.0     P$")

    def test_resized_while_it_runs(self):
        log = self.write("long.log", long_log(60))
        tmux = self.open(80, 24, "--log", log)
        tmux.wait_for("STANDBY")
        tmux.run("resize-window", "-x", "160", "-y", "50")
        lines = tmux.wait_for("left_raw")
        self.assertRegex(lines[49], "^ space  pause .* q  quit$")
        tmux.run("resize-window", "-x", "60", "-y", "12")
        end = time.monotonic() + PATIENCE_S
        while not tmux.lines()[11].startswith(" space  pause"):
            self.assertLess(time.monotonic(), end, tmux.lines())
            time.sleep(0.05)
        tmux.run("resize-window", "-x", "20", "-y", "4")
        tmux.wait_for("too small")
        tmux.run("resize-window", "-x", "80", "-y", "24")
        tmux.wait_for("wheel_speed")
        tmux.press("q")
        self.assertEqual(tmux.exit_status(), 0)

    def test_keys(self):
        log = self.write("long.log", long_log(60))
        tmux = self.open(80, 24, "--log", log)
        tmux.wait_for("REMOTE_SIGNAL_LOST (LED 17)")
        tmux.press("Space")
        before = tmux.wait_for("PAUSED")
        tmux.press("r")
        time.sleep(0.5)
        self.assertEqual(before[0], tmux.lines()[0])  # a log stands still
        tmux.press("h")
        tmux.wait_for("this help, and back")
        tmux.press("h")
        tmux.press("Space")
        tmux.wait_for("alarm REMOTE_SIGNAL_LOST has ended")
        tmux.press("+", "+")
        tmux.wait_for(" x4 ")
        tmux.press("Home")
        tmux.wait_for("newer below")
        tmux.press("End")
        tmux.press("q")
        self.assertEqual(tmux.exit_status(), 0)

    def test_a_bad_line_is_told_after_the_screen_is_closed(self):
        log = self.write("bad.log", "(1700000000.000000) can0 123#01\n(1700000000.300000) can0 123#01\nnonsense\n")
        tmux = self.open(80, 24, "--log", log)
        self.assertEqual(tmux.exit_status(), 2)
        self.assertIn("bad.log:3: ", "".join(tmux.lines()))

    # Shows: INT-2
    def test_settings_that_are_not_the_default_are_left_above_the_screen(self):
        tmux = self.open(80, 24, "--log", EXAMPLE, "--ai-if", "can1")
        tmux.wait_for("END")
        tmux.press("q")
        self.assertEqual(tmux.exit_status(), 0)
        self.assertIn(GATEWAY, "".join(line + "\n" for line in tmux.lines()))

    def test_a_dumb_terminal_gets_lines(self):
        tmux = self.open(80, 24, "--log", EXAMPLE, "--speed", "max", TERM="dumb")
        self.assertEqual(tmux.exit_status(), 0)
        self.assertIn("      1.007 s  shadow      ACTIVE -> TRIPPED: STEERING_COMMAND_TIMEOUT", tmux.lines())


class Picture(hostsim.Case):
    def test_the_picture_of_the_page_is_what_the_program_shows(self):
        made = self.folder / "made.svg"
        subprocess.run([ROOT / "scripts/tools/pictures/terminal-picture.py", "100x32", "END", made, hostsim.PROGRAM, "monitor", "--log",
                        EXAMPLE], check=True, timeout=60)
        self.assertEqual(made.read_text(encoding="utf-8"), (ROOT / "docs/pictures/monitor.svg").read_text(encoding="utf-8"))


class Lines(hostsim.Case):
    def monitor(self, *arguments, **options):
        return subprocess.run([hostsim.PROGRAM, "monitor", *map(str, arguments)], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False, text=True, timeout=60, **options)

    def test_a_line_for_each_change(self):
        done = self.monitor("--log", EXAMPLE, "--speed", "max")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.splitlines()[:3],
                         ["      0.600 s  vcu         363h mode: manual -> autopilot",
                          "      0.605 s  vcu         0A3h gear: P -> D", "      0.607 s  ai          168h gear: P -> D"])
        self.assertNotIn("\033", done.stdout)

    def test_the_shadow_that_is_asked_for_tells_all(self):
        lines = self.monitor("--log", EXAMPLE, "--speed", "max", "--shadow").stdout.splitlines()
        self.assertEqual(lines[0], "      0.000 s  shadow      INIT")
        self.assertIn("      0.512 s  shadow      INIT -> STANDBY", lines)
        self.assertIn("      1.007 s  shadow      ACTIVE -> TRIPPED: STEERING_COMMAND_TIMEOUT", lines)

    def test_speed(self):
        seconds = []
        for _ in range(3):
            begin = time.monotonic()
            self.monitor("--log", EXAMPLE, "--speed", "4")
            seconds.append(time.monotonic() - begin)
        self.assertGreater(min(seconds), 1.394 / 4)
        self.assertLess(min(seconds), 1.394)  # what it takes at its own speed; a busy machine needs more than a quarter of it

    def test_a_log_on_standard_input(self):
        done = subprocess.run([hostsim.PROGRAM, "monitor", "--log", "-", "--speed", "max"], input=EXAMPLE.read_bytes(),
                              stdout=subprocess.PIPE, check=False, timeout=60)
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"TRIPPED", done.stdout)

    def test_a_log_that_still_grows_is_ended_by_a_signal(self):
        with subprocess.Popen([hostsim.PROGRAM, "monitor", "--log", "-", "--speed", "max"], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            process.stdin.write(EXAMPLE.read_bytes())
            process.stdin.flush()
            self.wait_until_it_looks_for_signals(process.pid)
            process.send_signal(signal.SIGINT)
            said = process.stderr.read()
        self.assertEqual((process.returncode, said), (0, b""))

    def test_a_log_that_nobody_writes_is_ended_by_a_signal(self):
        os.mkfifo(os.path.join(self.folder, "pipe"))
        with subprocess.Popen([hostsim.PROGRAM, "monitor", "--log", "pipe"], cwd=self.folder) as process:
            time.sleep(0.5)
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(timeout=60), -signal.SIGTERM)

    def test_what_a_silence_causes_is_listed_in_its_order(self):
        frames = list(traffic.frames(3000))
        log = traffic.log([frame for frame in frames if not 1000 <= frame.t_ms < 2000])
        done = self.monitor("--log", self.write("gap.log", log), "--speed", "max")
        times = [float(line.split()[0]) for line in done.stdout.splitlines() if re.match(r" +[0-9.]+ s ", line)]
        self.assertGreater(len(times), 20)
        self.assertEqual(times, sorted(times))
        self.assertEqual(self.monitor("--log", "gap.log", "--speed", "50", cwd=self.folder).stdout, done.stdout)

    def test_a_time_that_goes_backwards(self):
        for back, said in ((9, ""), (500, "host_sim: b.log:3: the time stamps go back by 0.500 s; the times are wrong there: cut "
                                          "or sort the log\n")):
            self.write("b.log", "".join("(170000000%d.%03d000) can0 123#01\n" % (ms // 1000, ms % 1000)
                                        for ms in (0, 2000, 2000 - back, 2000 - 1, 2500)))
            done = self.monitor("--log", "b.log", "--speed", "max", cwd=self.folder)
            self.assertEqual((done.returncode, done.stderr), (0, said))

    def test_bad_lines(self):
        self.write("b.log", "(1700000000.000000) can0 123#01\nnonsense\n(1700000000.300000) can0 123#01\n(17000")
        done = self.monitor("--log", "b.log", "--speed", "max", cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        done = self.monitor("--log", "b.log", "--speed", "max", "--skip-bad-lines", cwd=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, "host_sim: b.log: lines skipped: 2\n"))

    def test_an_ai_side_that_the_log_does_not_have(self):
        for name, status, said in (("can9", 2, "host_sim: --ai-if: the log has frames from can0, but none from can9\n"),
                                   ("can0", 0, "")):
            done = self.monitor("--log", EXAMPLE, "--speed", "max", "--ai-if", name)
            self.assertEqual((done.returncode, done.stderr), (status, GATEWAY + said))


if __name__ == "__main__":
    unittest.main()
