"""Test the status line on a stream that is not a terminal."""

import io
from enum import Enum
from typing import NamedTuple

from stepaside.drivers.status_line import StatusLine
from stepaside.perception.measurement import Sighting


class State(Enum):
    """State of a fake robot."""

    WAITING = "waiting"
    WALKING = "walking"


class Shown(NamedTuple):
    """Fake tick."""

    state: State
    reason: str
    time: float = 0.0
    sighting: Sighting | None = None

    @property
    def words(self) -> str:
        """The tick in one line."""
        return f"{self.state.value} ({self.reason})"


def lines(*ticks: Shown) -> list[str]:
    """Return the lines on a stream that is not a terminal."""
    stream = io.StringIO()
    line = StatusLine(stream, clock=lambda: 0.0)
    for tick in ticks:
        line.note(tick)
    line.close()
    return stream.getvalue().splitlines()


def test_each_changed_reason_is_one_line() -> None:
    said = lines(
        Shown(State.WAITING, "no odometry received yet"),
        Shown(State.WAITING, "no odometry received yet"),
        Shown(State.WAITING, "opponent not detected"),
        Shown(State.WAITING, "opponent not detected"),
        Shown(State.WALKING, "opponent detected"),
        Shown(State.WAITING, "opponent not detected"),
    )
    reasons = ["no odometry received yet", "opponent not detected"]
    reasons += ["opponent detected", "opponent not detected"]
    assert len(said) == len(reasons)
    for line, reason in zip(said, reasons, strict=True):
        assert f"({reason})" in line


def test_a_reason_that_counts_is_one_line() -> None:
    """Reasons that differ only in their numbers are one line."""
    ages = (0.55, 0.6, 9.95, 10.0, 123.4)
    said = lines(
        *(
            Shown(State.WAITING, f"the sighting is {age:.1f} s old")
            for age in ages
        ),
        *(
            Shown(State.WAITING, f"no odometry for {age:.2f} s")
            for age in ages
        ),
    )
    assert len(said) == 2
    assert "is 0.6 s old" in said[0] or "0.5 s old" in said[0]
    assert "no odometry for 0.55 s" in said[1]
