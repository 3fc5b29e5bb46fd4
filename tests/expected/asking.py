"""Commands that the tests of known faults give, and what they read."""

import json
from pathlib import Path
from typing import Any

from click.testing import CliRunner, Result

from flows.calls import stepaside
from stepaside.cli.main import main

GAME = """
level = "unicycle"
duration = 1.0
[[players]]
name = "red"
role = "pursuer"
[[players]]
name = "blue"
role = "evader"
"""
OWN = """
import signal
from stepaside import Direction, Intent
class Own:
    direction = Direction.BACKWARD
    saturated = False
    def __init__(self, turn={turn}):
        self.turn = turn
    def begin(self):
        return None
    def decide(self, knowledge, memory):
        if {number} and knowledge.time > 0.5:
            signal.raise_signal({number})
        return Intent(self.turn), None
"""


def own_evader(file: Path, turn: float = 0.4, number: int = 0) -> str:
    """Write an evader as a user does; return how a command names it.

    Args:
        file: File to write.
        turn: Its only intent, in [rad].
        number: Signal that it raises after 0.5 s; 0 for none.
    """
    file.write_text(OWN.format(turn=turn, number=number))
    return f"{file}:Own"


def command(*words: object) -> Result:
    """Give a command in this process."""
    return CliRunner().invoke(main, [str(word) for word in words])


def answer(*words: object) -> Any:
    """Return the JSON document that a command prints."""
    done = command(*words, "--json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def refused(*words: object, cwd: Path | None = None) -> str:
    """Return the words with which a command refuses its input."""
    said = stepaside(*words, status=2, cwd=cwd).err
    assert "Traceback" not in said
    return said
