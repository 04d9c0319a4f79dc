#!/usr/bin/python3
"""Run a command in a virtual machine of with-vcan; pass on bytes, signals and exit status.

The machine is user-mode-linux, or QEMU with a kernel that is prepared. It is given one end of a socket pair for each of stdin,
stdout, stderr and control; scripts/tools/vcan/guest.sh is at the other end of them, and says how control is used.
"""
import argparse
import fcntl
import os
import pathlib
import platform
import select
import shlex
import shutil
import signal
import socket
import subprocess
import tempfile
import threading

FAILED = 125
QEMU_START_S = 300
UML_START_S = 60
MEMORY_MB = 768
STREAMS = ("stdin", "stdout", "stderr", "control")
OUTPUTS = {"stdout": "standard output", "stderr": "standard error"}
SIGNALS = ("INT", "QUIT", "HUP", "TERM", "USR1", "USR2")
RIGHTS = "-all,+net_admin,+net_raw"
# Without nopauth, signed return addresses take an emulated arm64 three quarters of its time.
MACHINES = {"x86_64": ("pc", "ttyS0", "tsc=reliable acpi=noirq"),
            "aarch64": ("virt,gic-version=max", "ttyAMA0", "arm64.nopauth")}


class Failure(Exception):
    pass


class NotStarted(Failure):
    pass


class Machine:
    """A virtual machine with its channels; ends when this process ends, however that comes."""

    def __init__(self, args, session):
        self.session = session
        self.runs = False
        self.channels = {}
        ends = {}
        for name in STREAMS:
            self.channels[name], ends[name] = socket.socketpair()
        command = uml_command(args, session, ends) if args.uml else qemu_command(args, ends)
        environment = {"PATH": os.defpath}  # without a TMPDIR, user-mode-linux has its memory in /dev/shm
        with open(session / "machine.log", "wb") as log:
            self.process = subprocess.Popen(command, cwd=session, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment,
                                            pass_fds=[end.fileno() for end in ends.values()], start_new_session=True)
        for end in ends.values():
            end.close()
        # Not by --pdeathsig: the processes of user-mode-linux would go on, outside of it, once their kernel is gone.
        self.guard = subprocess.Popen(["sh", "-c", "read -r line; kill -KILL -$0", str(self.process.pid)],
                                      stdin=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True)
        threading.Thread(target=self.reap, daemon=True).start()
        self.control = self.channels["control"].makefile("r")

    def tell(self, line):
        try:
            self.channels["control"].send(line.encode() + b"\n", socket.MSG_DONTWAIT)
        except OSError:
            pass  # it has ended, or has not taken the last hundred signals either

    def start(self, timeout):
        self.channels["control"].settimeout(timeout)
        try:
            self.hear()
        except TimeoutError:
            raise NotStarted(f"the virtual machine has not started within {timeout} s{self.last_words()}") from None
        self.channels["control"].settimeout(None)
        self.runs = True

    def hear(self):
        """The words of the next line."""
        words = self.control.readline().split()
        if not words:
            kind = Failure if self.runs else NotStarted
            raise kind(f"the virtual machine ended before the command did{self.last_words()}")
        return words

    def last_words(self):
        for name in ("console.log", "machine.log"):
            path = self.session / name
            lines = path.read_text(errors="replace").split("\n") if path.exists() else []
            telling = [line.strip() for line in lines if "with-vcan: " in line or "Kernel panic" in line]
            lines = telling[:1] or [line.strip() for line in lines if line.strip()][-1:]
            if lines:
                return f" ({lines[0]})"
        return ""

    def reap(self):
        """When the kernel has ended, by itself or killed, so do the processes that it ran."""
        try:
            os.waitid(os.P_PID, self.process.pid, os.WEXITED | os.WNOWAIT)
            os.killpg(self.process.pid, signal.SIGKILL)
        except (ChildProcessError, ProcessLookupError):
            pass  # end() was faster

    def end(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.guard.kill()
        self.guard.wait()
        self.process.wait()


class Output(threading.Thread):
    """Copies what the machine sends to a file of ours."""

    def __init__(self, machine, name, file):
        super().__init__(daemon=True)
        self.machine, self.name_of_stream, self.file = machine, name, file
        self.written = 0
        self.open = True
        self.lost = False
        self.changed = threading.Condition()
        self.start()

    def run(self):
        while data := self.machine.channels[self.name_of_stream].recv(65536):
            if not self.open:
                continue
            try:
                write_all(self.file, data)
            except BrokenPipeError:
                self.close()  # nobody reads: so shall it be for the command
            except OSError as error:
                self.lost = True
                say(f"{OUTPUTS[self.name_of_stream]}: {error.strerror}")
                self.close()
            with self.changed:
                self.written += len(data)
                self.changed.notify()

    def close(self):
        self.open = False
        self.machine.tell(f"closed {self.name_of_stream}")

    def wait_for(self, count):
        with self.changed:
            self.changed.wait_for(lambda: self.written >= count or not self.open or not self.is_alive())


def say(message):
    try:
        os.write(2, f"with-vcan: {message}\n".encode(errors="replace"))
    except OSError:
        pass  # there is no other place to say it


def write_all(file, data):
    while data:
        select.select([], [file], [])  # who shares the file may have made it one that does not wait
        data = data[os.write(file, data):]


def copy_input(channel, has_sizes):
    """has_sizes: each piece follows a line with its size, and 0 is the end."""
    try:
        while not os.isatty(0) and (data := os.read(0, 65536)):
            channel.sendall((b"%d\n" % len(data) if has_sizes else b"") + data)
        channel.sendall(b"0\n" if has_sizes else b"")
    except OSError:
        pass  # there is no input, or no command any more that reads it
    if not has_sizes:
        channel.shutdown(socket.SHUT_WR)


def qemu_command(args, ends):
    machine, console, parameters = MACHINES[platform.machine()]
    # One processor whose clock advances 2 ns an instruction, and jumps to the next timer when there is nothing to do.
    clock = ["-icount", "shift=1,sleep=off", "-smp", "1"] if args.steady else ["-smp", "2"]
    command = [args.qemu, "-nodefaults", "-no-user-config", "-display", "none", "-no-reboot",
               "-machine", machine, "-cpu", "max", "-accel", args.accel, *clock, "-m", str(MEMORY_MB),
               "-kernel", str(args.kernel / "kernel"), "-initrd", str(args.kernel / "initramfs"),
               "-append", f"console={console} quiet loglevel=3 panic=-1 mitigations=off nokaslr cryptomgr.notests {parameters}",
               "-serial", "file:console.log", "-device", "virtio-serial-pci"]
    for tag, path in (("root", "/"), ("usr", "/usr"), ("session", ".")):
        command += ["-fsdev", f"local,id={tag},path={path},security_model=none,multidevs=remap",
                    "-device", f"virtio-9p-pci,fsdev={tag},mount_tag={tag}"]
    for name, end in ends.items():
        command += ["-chardev", f"socket,id={name},fd={end.fileno()}",
                    "-device", f"virtserialport,chardev={name},name={name}"]
    return command


def uml_memory_mb():
    """It lies in /dev/shm, which is small in some containers: a machine that runs out of it crashes."""
    folder = os.statvfs("/dev/shm")
    free_mb = folder.f_bavail * folder.f_frsize >> 20
    if free_mb < MEMORY_MB:
        raise NotStarted(f"/dev/shm has only {free_mb} MB, and it needs {MEMORY_MB}")
    return MEMORY_MB


def uml_command(args, session, ends):
    return [args.uml, f"mem={uml_memory_mb()}M", "rootfstype=hostfs", "rw", f'init="{session}/init-uml.sh"', "quiet", "loglevel=3",
            f"uml_dir={session}/", "con=null", "con0=null,fd:1",
            *(f"ssl{number}=fd:{ends[name].fileno()}" for number, name in enumerate(STREAMS))]


def quoted(words):
    return b" ".join(os.fsencode(shlex.quote(os.fsdecode(word))) for word in words)


def enter_folder(folder):
    absent = f"with-vcan: no way into {folder} in the virtual machine, whose /run, /dev, /proc and /sys are its own"
    return b"cd -- " + quoted([folder]) + b" 2>/dev/null || { echo " + quoted([absent]) + b" >&2; exit 125; }\n"


def command_script(command):
    """What bash runs in the machine: the same command in the same place as the same user with the same environment."""
    become = []
    if os.geteuid() != 0:
        groups = ",".join(map(str, os.getgroups()))
        become = ["setpriv", "--reuid", str(os.geteuid()), "--regid", str(os.getegid()),
                  *(["--groups", groups] if groups else ["--clear-groups"]),
                  "--inh-caps", RIGHTS, "--ambient-caps", RIGHTS]
    environment = [name + b"=" + value for name, value in os.environb.items()]
    umask = os.umask(0)
    os.umask(umask)
    return (b"PATH=/usr/sbin:/usr/bin:/sbin:/bin\n" + enter_folder(os.getcwd()) + b"umask %04o\n" % umask + b"exec " +
            quoted([*become, "env", "-i", *environment, *command]) + b"\n")


def boot_id():
    return pathlib.Path("/proc/sys/kernel/random/boot_id").read_text()


def hold(session):
    """Lock the session as long as this process lives. The lock has its name only once it is locked."""
    lock = open(session / "lock.new", "w+")
    lock.write(boot_id())
    lock.flush()
    fcntl.flock(lock, fcntl.LOCK_EX)
    os.rename(session / "lock.new", session / "lock")
    return lock


def is_left(session):
    """Whether it is our user's, and of a process that was killed. Another kernel's locks cannot be seen here."""
    try:
        if session.lstat().st_uid != os.geteuid():
            return False
        with open(session / "lock") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return lock.read() == boot_id()
    except OSError:
        return False


def remove_left():
    for session in pathlib.Path(tempfile.gettempdir()).glob("with-vcan.*"):
        if is_left(session):
            shutil.rmtree(session, ignore_errors=True)


def write_session(session, args, merged):
    pieces = pathlib.Path(__file__).parent
    shutil.copy(pieces / "guest.sh", session / "guest")
    shutil.copy(pieces / "init-uml.sh", session)
    (session / "command").write_bytes(command_script(args.command))
    settings = {"machine": "uml" if args.uml else "qemu", "interfaces": args.interfaces, "owner": f"{os.geteuid()}:{os.getegid()}",
                "host_name": platform.node() or "localhost", "merged": "yes" if merged else ""}
    (session / "settings").write_text("".join(f"{name}={shlex.quote(value)}\n" for name, value in settings.items()))


def same_file(one, other):
    try:
        return os.path.sameopenfile(one, other)
    except OSError:
        return False  # closed


def run(args, session):
    lock = hold(session)
    merged = same_file(1, 2)  # one stream then, which keeps the order between the two
    write_session(session, args, merged)
    machine = Machine(args, session)
    running = False

    def on_signal(number, _frame):
        if not running:
            raise SystemExit(128 + number)
        machine.tell("signal " + signal.Signals(number).name.removeprefix("SIG"))

    for name in SIGNALS:
        number = getattr(signal, "SIG" + name)
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, on_signal)
    try:
        outputs = [Output(machine, "stdout", 1), Output(machine, "stderr", 2)]
        machine.start(UML_START_S if args.uml else QEMU_START_S)
        running = True
        threading.Thread(target=copy_input, args=(machine.channels["stdin"], args.uml), daemon=True).start()
        _, status, *counts = machine.hear()
        for output, count in zip(outputs, counts):
            output.wait_for(int(count))
        lost = any(output.lost for output in outputs)
        return FAILED if lost and status == "0" else int(status)
    finally:
        machine.end()
        lock.close()


def main():
    parser = argparse.ArgumentParser(description="a part of with-vcan")
    parser.add_argument("--uml", help="the program of user-mode-linux; else QEMU")
    parser.add_argument("--otherwise", metavar="WITH-VCAN", help="to take this one's place where user-mode-linux does not start")
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--kernel", type=pathlib.Path)
    parser.add_argument("--qemu")
    parser.add_argument("--accel")
    parser.add_argument("--interfaces", required=True)
    parser.add_argument("--steady", action="store_true")
    parser.add_argument("command", nargs="+")
    args = parser.parse_args()
    remove_left()
    try:
        with tempfile.TemporaryDirectory(prefix="with-vcan.") as session:
            status = run(args, pathlib.Path(session))
    except NotStarted as failure:
        if args.otherwise:
            if not args.quiet:
                say(f"user-mode-linux does not start here: {failure}")
            os.execv(args.otherwise, [args.otherwise, "--with", "qemu", *(["--quiet"] if args.quiet else []), "--", *args.command])
        say(failure)
        status = FAILED
    except Failure as failure:
        say(failure)
        status = FAILED
    os._exit(status)  # a thread may still wait for input


main()
