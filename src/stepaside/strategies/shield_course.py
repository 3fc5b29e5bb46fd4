"""Heading of the opponent of a shield, from where it was seen."""

from collections.abc import Sequence
from math import asin, atan2, ceil, hypot, pi
from typing import NamedTuple

from ..core.poses import wrap_angle
from .opponent_track import SeenOpponent

LEAST_MOTION = 0.002  # between two sightings that show a heading, in [m]
SPACING = 0.25  # of the headings of an opponent who stands, in [rad]


class Course(NamedTuple):
    """Heading of an opponent, and how far it may be off.

    Attributes:
        time: Time of the last sighting, in [s].
        heading: Heading in the map, in [rad].
        error: Greatest error of the heading, in [rad].
    """

    time: float
    heading: float
    error: float

    def headings(self, known: float) -> list[float]:
        """Return the heading, and others if its error is above a bound."""
        if self.error <= known + 1e-9:
            return [self.heading]
        count = ceil(self.error / SPACING)
        return [
            self.heading + self.error * i / count
            for i in range(-count, count + 1)
        ]


def observed_course(
    before: Course | None,
    seen: Sequence[SeenOpponent],
    window: float,
    person: tuple[float, float],
    known: float,
) -> Course | None:
    """Return the heading of an opponent after its last sighting.

    The direction of the chord between two positions, at least a window [s]
    apart, is off by at most the turn between them, and by the errors of both.
    The heading follows it no faster than the opponent turns: then it turns as
    the opponent may, and stays within the error of the chord.

    The person is given by its greatest turning rate [rad/s] and the error of a
    position [m]; errors of a heading up to a bound [rad] count as known. None
    before a window has passed for the first time.
    """
    turn, sighting_error = person
    last = seen[-1]
    turned = (
        0.0 if before is None else turn * max(0.0, last.time - before.time)
    )
    before_it = last.time - window + 1e-6
    earlier = [row for row in seen if row.time <= before_it]
    if not earlier:
        if before is None:
            return None
        return Course(
            last.time, before.heading, min(pi, before.error + turned)
        )
    time, x, y, _ = earlier[-1]
    chord = hypot(last.x - x, last.y - y)
    error, hidden = pi, 2.0 * sighting_error
    if chord > max(LEAST_MOTION, hidden):
        error = min(pi, turn * (last.time - time) + asin(hidden / chord))
    error = max(error, known)
    direction = atan2(last.y - y, last.x - x)
    if before is None:
        return Course(last.time, direction, error)
    if error > before.error + turned:  # the chord shows less than is known
        return Course(last.time, before.heading, before.error + turned)
    off = wrap_angle(direction - before.heading)
    if error < before.error:
        return Course(last.time, direction, error)
    heading = before.heading + min(max(off, -turned), turned)
    return Course(last.time, heading, error)
