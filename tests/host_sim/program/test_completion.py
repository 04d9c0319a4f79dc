"""Completion in a shell, typed in a terminal.

usage: test_completion.py bash|zsh|fish"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import hostsim
from tmux import Tmux

SHELL = "bash"
START = {  # how an interactive shell without anybody's settings takes the completion
    "bash": ("bash", "--norc", "--noprofile", "-i"),
    "zsh": ("zsh", "-f", "-i"),
    "fish": ("fish", "--no-config", "-i"),
}
PREPARE = {
    "bash": "PS1='ready> '; source host_sim.bash",
    "zsh": "PROMPT='ready> '; fpath=($PWD $fpath); autoload -U compinit; compinit -u -D",
    "fish": "function fish_prompt; echo 'ready> '; end; source host_sim.fish",
}
FILE = {"bash": "host_sim.bash", "zsh": "_host_sim", "fish": "host_sim.fish"}
TYPED = {  # before the tab: what the line is then
    "host_sim repl": "host_sim replay",
    "host_sim replay --topo": "host_sim replay --topology",
    "host_sim replay --topology g": "host_sim replay --topology gateway",
    "host_sim replay --topology=g": "host_sim replay --topology=gateway",
    "host_sim replay --shadow my": "host_sim replay --shadow my.log",
    "host_sim replay --why=my": "host_sim replay --why=my.log",
    "host_sim help surv": "host_sim help survey",
    "host_sim completion z": "host_sim completion zsh",
    "host_sim campaign --fault VCU_HEARTBEAT_L": "host_sim campaign --fault VCU_HEARTBEAT_LOST",
    "host_sim campaign --broken fol": "host_sim campaign --broken folder/",
    "host_sim monitor --speed m": "host_sim monitor --speed max",
    "host_sim scenario --bus s": "host_sim scenario --bus sim",
    "host_sim demo --scenario healthy_b": "host_sim demo --scenario healthy_busy_bus",
}


class Completion(hostsim.Case):
    def setUp(self):
        super().setUp()
        self.write(FILE[SHELL], self.run_good("completion", SHELL).stdout)
        self.write("my.log", "")
        (self.folder / "folder").mkdir()

    def test_the_script_is_correct(self):
        done = subprocess.run([SHELL, "-n", FILE[SHELL]], cwd=self.folder, stderr=subprocess.PIPE, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_what_is_typed_is_completed(self):
        folder = str(pathlib.Path(hostsim.PROGRAM).resolve().parent)
        # Without HISTFILE=, bash writes its history into the folder while the test removes it.
        tmux = Tmux(self.folder, 200, 20, *START[SHELL], HOME=str(self.folder), HISTFILE="",
                    PATH=folder + ":" + os.environ["PATH"])
        self.addCleanup(tmux.close)
        tmux.press(PREPARE[SHELL], "Enter")
        for typed, expected in TYPED.items():
            tmux.press("C-u", "C-l")
            tmux.wait_for("ready>")
            tmux.press("-l", typed)
            tmux.wait_for(typed)
            tmux.press("Tab")
            tmux.wait_for(expected)


class EveryOption(hostsim.Case):
    """Bash and fish say what they would offer."""
    ASK = {
        "bash": 'source host_sim.bash; COMP_WORDS=(host_sim "$0" --); COMP_CWORD=2; _host_sim; printf "%s\\n" "${COMPREPLY[@]}"',
        "fish": 'source host_sim.fish; complete -C "host_sim $argv[1] --"',
    }

    def test_every_option_of_every_command_is_offered(self):
        self.write(FILE[SHELL], self.run_good("completion", SHELL).stdout)
        for command in self.commands():
            text = self.run_good("help", command).stdout.split("\nExamples:")[0]
            options = set(re.findall(r"^  (--[a-z-]+)", text, re.MULTILINE)) | {"--help"}
            done = subprocess.run([SHELL, "-c", self.ASK[SHELL], command], cwd=self.folder, check=True, stdout=subprocess.PIPE,
                                  env={**os.environ, "HOME": str(self.folder)})
            self.assertEqual({line.split("\t")[0] for line in done.stdout.decode().split("\n") if line}, options, command)


class InBash(hostsim.Case):
    def offered(self, *words):
        """What bash offers for the last word."""
        ask = 'source host_sim.bash; COMP_WORDS=(host_sim "$@"); COMP_CWORD=$#; _host_sim; printf "%s\\n" "${COMPREPLY[@]}"'
        done = subprocess.run(["bash", "-c", ask, "bash", *words], cwd=self.folder, check=True, stdout=subprocess.PIPE)
        return done.stdout.decode().split()

    def test_bash_offers_what_may_come_there(self):
        self.write(FILE[SHELL], self.run_good("completion", SHELL).stdout)
        self.write("--file", "")
        self.assertIn("--shadow", self.offered("replay", "--"))
        for given in (["--shadow"], ["--shadow", "--store", "x"], ["--store", "=", "x", "--shadow"]):
            self.assertNotIn("--shadow", self.offered("replay", *given, "--"))
            self.assertIn("--why", self.offered("replay", *given, "--"))
        self.assertNotIn("--store", self.offered("replay", "--store", "=", "x", "--"))
        self.assertIn("--fault", self.offered("vehicle", "--fault", "ai-stop@2s", "--"))
        self.assertEqual(self.offered("replay", "--shadow", "--", "--"), ["--file"])
        self.assertEqual(self.offered("replay", "--topology", "g"), ["gateway"])


TESTS = {"bash": ("Completion", "EveryOption", "InBash"), "zsh": ("Completion",), "fish": ("Completion", "EveryOption")}

if __name__ == "__main__":
    SHELL = sys.argv.pop(1)
    if shutil.which(SHELL) is None:
        print(f"SKIPPED: there is no {SHELL}: completion in it was not tried. scripts/install-deps test installs it.")
        sys.exit(77)
    unittest.main(defaultTest=TESTS[SHELL], verbosity=2)
