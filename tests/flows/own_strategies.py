"""Strategies of a user, for the flows; each tells where it must lead."""

import os
from math import sin
from pathlib import Path
from time import sleep
from typing import Any

from stepaside import Evasion, Intent, Knowledge

FILE = Path(__file__)


class HalfBack(Evasion):
    """Backs off at half the speed, turning like the sine of the bearing."""

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Return what it wants, and what it remembers."""
        return Intent(sin(knowledge.bearing), 0.5), memory


class FiveSteps(Evasion):
    """Backs off for five decisions, and stands from then on."""

    def begin(self) -> Any:
        """Return the memory of a game that begins."""
        return 0

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Return what it wants, and what it remembers."""
        return Intent(knowledge.bearing, float(memory < 5)), memory + 1


class Still(Evasion):
    """Stands."""

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Return what it wants, and what it remembers."""
        return Intent(speed_factor=0.0), memory


class Straight(Evasion):
    """Walks straight on, backward, whatever comes."""

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Return what it wants, and what it remembers."""
        return Intent(0.0), memory


class Counted(Evasion):
    """The paper's evader; adds a line to a file when a game begins.

    Where games are to be slow, it takes its time for that.
    """

    def begin(self) -> Any:
        """Return the memory of a game that begins."""
        with open(os.environ["GAMES_BEGUN"], "a", encoding="ascii") as file:
            file.write("x\n")
        sleep(float(os.environ.get("GAMES_PAUSE", 0.0)))
        return super().begin()


class Telling(Evasion):
    """The paper's evader; makes a file when a game is a second old.

    Before a game a few decisions of strategies are tried.
    """

    def begin(self) -> Any:
        """Return the memory of a game that begins."""
        return 0, super().begin()

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Return what it wants, and what it remembers."""
        count, inner = memory
        if knowledge.time > 1.0 and count > 10:
            Path(os.environ["SECOND_OVER"]).touch()
        intent, inner = super().decide(knowledge, inner)
        return intent, (count + 1, inner)
