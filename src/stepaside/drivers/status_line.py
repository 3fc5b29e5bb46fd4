"""Status line of the robot on the terminal."""

import re
from collections.abc import Callable
from contextlib import suppress
from enum import Enum
from math import degrees
from time import monotonic
from typing import TextIO

from .play_log import PlayTick

PERIOD = 0.2  # between two updates of the line, in [s]
_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")


def status_text(tick: PlayTick) -> str:
    """Return one line about a tick."""
    sighting = tick.sighting
    opponent = "opponent not detected"
    if sighting is not None:
        opponent = (
            f"opponent at {sighting.distance:.2f} m, "
            f"{degrees(sighting.bearing):+.0f} deg"
        )
    return f"{tick.time:7.1f} s  {tick.words}, {opponent}"


class StatusLine:
    """Line that is overwritten periodically, and kept at each change.

    A change is a new state or a new reason; reasons that differ only in
    their numbers ("no odometry for 0.31 s") count as the same.
    """

    def __init__(
        self, stream: TextIO, clock: Callable[[], float] = monotonic
    ) -> None:
        """Write to a stream; if it is not a terminal, write changes only."""
        self._stream, self._clock = stream, clock
        self._is_terminal = stream.isatty()
        self._written = -PERIOD
        self._last: tuple[Enum, str] | None = None

    def note(self, tick: PlayTick) -> None:
        """Show a tick, if the status changed or an update is due."""
        now = self._clock()
        kind = tick.state, _NUMBER.sub("", tick.reason)
        changed = kind != self._last
        if not changed and not self._is_terminal:
            return
        if not changed and now - self._written < PERIOD:
            return
        self._last, self._written = kind, now
        text = status_text(tick)
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
        """Write, ignoring errors: a closed terminal must not end the walk."""
        with suppress(OSError):
            self._stream.write(text)
            self._stream.flush()
