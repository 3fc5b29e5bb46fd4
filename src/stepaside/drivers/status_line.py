"""One line on the terminal that says what the robot does."""

import re
from collections.abc import Callable
from contextlib import suppress
from enum import Enum
from math import degrees
from time import monotonic
from typing import Protocol, TextIO

from ..perception.measurement import Sighting

PERIOD = 0.2  # between two looks of the line, in [s]
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")


class TickStatus(Protocol):
    """What a tick says of itself."""

    @property
    def state(self) -> Enum:
        """What the robot is doing."""

    @property
    def reason(self) -> str:
        """Why, in words."""

    @property
    def time(self) -> float:
        """When, in [s]."""

    @property
    def words(self) -> str:
        """All of it, in a few words."""

    @property
    def sighting(self) -> Sighting | None:
        """The other, as far as is known."""


def words_of(tick: TickStatus) -> str:
    """What one tick was, in one line."""
    seen = tick.sighting
    other = "sees nobody"
    if seen is not None:
        other = (
            f"other at {seen.distance:.2f} m, {degrees(seen.bearing):+.0f} deg"
        )
    return f"{tick.time:7.1f} s  {tick.words}, {other}"


class StatusLine:
    """Keeps a line up to date, and leaves one behind at each change.

    A change is another state, or another reason for it; a reason whose
    numbers alone differ ("no odometry for 0.31 s") is the same.
    """

    def __init__(
        self, stream: TextIO, clock: Callable[[], float] = monotonic
    ) -> None:
        """Write to a stream; only changes if it is no terminal."""
        self._stream, self._clock = stream, clock
        self._is_terminal = stream.isatty()
        self._said = -PERIOD
        self._last: tuple[Enum, str] | None = None

    def note(self, tick: TickStatus) -> None:
        """Say what a tick was, if it is time to."""
        now = self._clock()
        kind = tick.state, _NUMBER.sub("", tick.reason)
        changed = kind != self._last
        if not changed and not self._is_terminal:
            return
        if not changed and now - self._said < PERIOD:
            return
        self._last, self._said = kind, now
        text = words_of(tick)
        if self._is_terminal:
            text = f"\r{text:<79.120}" + ("\n" if changed else "")
        else:
            text += "\n"
        self._write(text)

    def close(self) -> None:
        """End the line."""
        if self._is_terminal:
            self._write("\n")

    def _write(self, text: str) -> None:
        """Write what can be written: a terminal that hung up ends no walk."""
        with suppress(OSError):
            self._stream.write(text)
            self._stream.flush()
