"""Process groups: processor time, and handling of Ctrl-C."""

import os
import resource
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path


def obey_ctrl_c() -> None:
    """Enable Ctrl-C for this process and its children.

    A shell that starts a process in the background disables it, and children
    inherit that.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)


class Worked:
    """Processor time of a command and its child processes.

    Attributes:
        process: Command, which leads a process group.
    """

    def __init__(self, process: "subprocess.Popen[str]") -> None:
        """Store a new child process, which this process must wait for."""
        self.process = process
        self._before = _of_the_ended()

    def until_now(self) -> float:
        """Return the group's processor time while the command runs, in [s]."""
        ticks = sum(
            int(fields[number])
            for fields in members(self.process.pid)
            for number in (11, 12, 13, 14)
        )
        return ticks / os.sysconf("SC_CLK_TCK")

    def until_its_end(self) -> float:
        """Return the group's processor time after waiting for it, in [s]."""
        return _of_the_ended() - self._before


def members(group: int) -> Iterator[list[str]]:
    """Yield the fields of ``/proc/PID/stat`` of the processes of a group."""
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                text = (entry / "stat").read_text()
            except OSError:
                continue  # it ended meanwhile
            fields = text.rpartition(")")[2].split()
            if int(fields[2]) == group and fields[0] != "Z":
                yield fields


def _of_the_ended() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
