"""Programs on no disk. In a virtual machine a disk may be slow, and a clock that is counted leaps while the machine waits
for it (docs/vcan.md): so what a test starts lies in memory before the test begins, its libraries too."""
import atexit
import os
import re
import shutil
import subprocess
import tempfile

MEMORY = "/dev/shm"


def folder():
    """A folder in memory that is gone at the end of this program; None where there is no such memory."""
    if not os.access(MEMORY, os.W_OK):
        return None
    made = tempfile.mkdtemp(prefix="programs.", dir=MEMORY)
    owner = os.getpid()
    atexit.register(lambda: os.getpid() == owner and shutil.rmtree(made))
    return made


def libraries_of(program):
    said = subprocess.run(["ldd", program], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False, text=True)
    return re.findall(r"=> (/\S+)", said.stdout)


def bring(programs, into):
    """Copies of these programs, and of what they are linked with. What is started from now on finds them."""
    libraries = {library for program in programs for library in libraries_of(program)}
    for path in [*programs, *libraries]:
        if os.path.dirname(path) != into:
            shutil.copy(path, into)
    os.environ["PATH"] = into + ":" + os.environ.get("PATH", "")
    os.environ["LD_LIBRARY_PATH"] = into
