"""Processes of a group: what they have worked, and that they obey."""

import os
import resource
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path


def obey_ctrl_c() -> None:
    """Let Ctrl-C reach us and those that we start.

    A shell that starts us in the background lets it pass by, and so would
    all that we start.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)


class Worked:
    """Processor time of a command and of those that it starts.

    Attributes:
        process: The command, which leads a group of its own.
    """

    def __init__(self, process: "subprocess.Popen[str]") -> None:
        """Take a command that has just begun; it is waited for by us."""
        self.process = process
        self._before = _of_the_ended()

    def until_now(self) -> float:
        """Time that all have worked, while the command lives, in [s]."""
        ticks = sum(
            int(fields[number])
            for fields in members(self.process.pid)
            for number in (11, 12, 13, 14)
        )
        return ticks / os.sysconf("SC_CLK_TCK")

    def until_its_end(self) -> float:
        """Time that all have worked, once the command was waited for [s]."""
        return _of_the_ended() - self._before


def members(group: int) -> Iterator[list[str]]:
    """What the system says of the processes of a group, field by field."""
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
