"""Every call that the flows make: commands, processes and public names.

Flows state what users do and what comes out. How a thing is called stands
here alone, so that a new name of a command changes one line.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

TIMEOUT = 280.0  # [s], for what hangs


class Output(NamedTuple):
    """What a command answered."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """The one JSON document on standard output."""
        return json.loads(self.out)


def stepaside(
    *words: object,
    status: int = 0,
    cwd: Path | None = None,
    env: dict[str, str] | None = None,
) -> Output:
    """Run a command as a user does, and check its exit status."""
    done = subprocess.run(
        [sys.executable, "-m", "stepaside", *map(str, words)],
        capture_output=True,
        text=True,
        cwd=cwd,
        env=os.environ | (env or {}),
        timeout=TIMEOUT,
    )
    output = Output(done.returncode, done.stdout, done.stderr)
    assert output.status == status, output
    return output


def start_stepaside(
    *words: object,
    cwd: Path | None = None,
    env: dict[str, str] | None = None,
) -> subprocess.Popen[str]:
    """Start a command that goes on until it is told to stop."""
    return subprocess.Popen(
        [sys.executable, "-m", "stepaside", *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
        env=os.environ | (env or {}),
    )


# Duels, walks and theory.


# Games of many, levels, strategies, studies and environments.


# Robots, legs, drivers and safety.


# Pages, runs and files.
