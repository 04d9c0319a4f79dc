"""A terminal for programs that need one."""
import os
import subprocess
import time

PATIENCE_S = 30


class Tmux:
    """A program in a terminal of its own."""
    count = 0

    def __init__(self, folder, width, height, *command, **environment):
        Tmux.count += 1  # one server each: the one before may not have ended yet
        self.socket = str(folder / f"tmux{Tmux.count}")
        self.status = folder / "status"
        self.errors = folder / "errors"
        # LeakSanitizer hangs at the end of a program that holds a SIGHUP back, which a terminal that goes away sends.
        variables = {"LANG": "C.UTF-8", "NO_COLOR": "", "ASAN_OPTIONS": "detect_leaks=0", **environment}
        words = " ".join("'%s=%s'" % item for item in variables.items())
        line = "env %s %s; echo $? > '%s'; exec sleep 1000" % (
            words, " ".join("'%s'" % word for word in command), self.status)
        self.run("-f", "/dev/null", "new-session", "-d", "-c", str(folder), "-x", str(width), "-y", str(height), line)

    def run(self, *arguments):
        return subprocess.run(["tmux", "-S", self.socket, *arguments], check=True, stdout=subprocess.PIPE, timeout=PATIENCE_S,
                              env={**os.environ, "LC_ALL": "C.UTF-8"}).stdout.decode("utf-8")

    def lines(self, *options):
        return self.run("capture-pane", "-p", *options).split("\n")

    def press(self, *keys):
        self.run("send-keys", *keys)

    def wait_for(self, text):
        """Wait until a line contains it. Gives the lines."""
        end = time.monotonic() + PATIENCE_S
        lines = []
        while time.monotonic() < end:
            lines = self.lines()
            if any(text in line for line in lines):
                return lines
            time.sleep(0.05)
        raise AssertionError("no %r in\n%s" % (text, "\n".join(lines)))

    def exit_status(self):
        end = time.monotonic() + PATIENCE_S
        while not self.status.exists() or not self.status.read_text():
            if time.monotonic() > end:
                raise AssertionError("it goes on:\n" + "\n".join(self.lines()))
            time.sleep(0.05)
        return int(self.status.read_text())

    def close(self):
        subprocess.run(["tmux", "-S", self.socket, "kill-server"], stderr=subprocess.DEVNULL, check=False)
