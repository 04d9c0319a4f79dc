#!/usr/bin/python3
"""Do by hand what a Dockerfile says, where there is no Docker: each stage in a copy of a bare Debian, by chroot.

usage: dockerfile.py BASE WORK DOCKERFILE CONTEXT [ARGUMENT...]
BASE is the bare Debian, for every FROM; WORK is emptied. Needs root. At the end the image is run with the arguments, or with its
CMD. Knows the instructions and forms that the Dockerfiles here have, and fails at others.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

ENVIRONMENT = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"}


def instructions(text):
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    for line in "\n".join(lines).replace("\\\n", " ").splitlines():
        word, _, rest = line.partition(" ")
        yield word, rest.strip()


class Image:
    def __init__(self, base, work, context):
        self.base, self.work, self.context = base, work, context
        self.stages = {}
        self.root = None
        self.user, self.folder, self.entrypoint, self.command = "root", "/", [], []

    def enter(self, *command):
        environment = {**ENVIRONMENT, "HOME": "/root" if self.user == "root" else f"/home/{self.user}"}
        subprocess.run(["mount", "-t", "proc", "proc", self.root / "proc"], check=True)
        try:
            subprocess.run(["chroot", f"--userspec={self.user}:", self.root, "sh", "-c", 'cd "$0" && exec "$@"', self.folder, *command],
                           env=environment, stdin=subprocess.DEVNULL, check=True)
        finally:
            subprocess.run(["umount", self.root / "proc"], check=True)

    def do_from(self, rest):
        self.root = self.work / f"stage{len(self.stages)}"
        self.stages[rest.partition(" AS ")[2] or str(len(self.stages))] = self.root
        subprocess.run(["cp", "-a", self.base, self.root], check=True)
        shutil.copy("/etc/resolv.conf", self.root / "etc")

    def do_copy(self, rest):
        words = rest.split()
        source = self.context
        if words[0].startswith("--from="):
            source = self.stages[words.pop(0).removeprefix("--from=")]
        pattern, target = words
        ignored = (self.context / ".dockerignore").read_text().split() if source == self.context else []
        into = self.root / target.lstrip("/")
        if pattern == "." or (source / pattern).is_dir():
            shutil.copytree(source / pattern, into, symlinks=True, dirs_exist_ok=True,
                            ignore=lambda folder, names: ignored if pathlib.Path(folder) == source else [])
        else:
            found = list(source.glob(pattern.lstrip("/")))
            if not found:
                sys.exit(f"dockerfile: COPY finds no {pattern}")
            for file in found:
                shutil.copy(file, into)

    def do_run(self, rest):
        self.enter("sh", "-c", rest)

    def do_user(self, rest):
        self.user = rest

    def do_workdir(self, rest):
        self.folder = rest

    def do_entrypoint(self, rest):
        self.entrypoint = json.loads(rest)

    def do_cmd(self, rest):
        self.command = json.loads(rest)


def main():
    base, work, dockerfile, context = map(pathlib.Path, sys.argv[1:5])
    if work.exists():
        shutil.rmtree(work)
    os.makedirs(work)
    image = Image(base, work, context)
    for word, rest in instructions(dockerfile.read_text()):
        print(f"== {word} {rest}", flush=True)
        getattr(image, "do_" + word.lower())(rest)
    command = [*image.entrypoint, *(sys.argv[5:] or image.command)]
    if command:
        image.enter(*command)


main()
