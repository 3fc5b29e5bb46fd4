"""Heading of an opponent from its sightings; see docs/shield-proof.md."""

from collections.abc import Sequence
from math import asin, atan2, ceil, hypot, pi, sqrt
from typing import NamedTuple

from ..core.poses import wrap_angle
from .opponent_track import SeenOpponent

LEAST_CHORD = 0.002  # between two sightings that show a heading, in [m]
SPACING = 0.125  # of the sightings that are kept, in best chords
LONGEST = 2.0  # chord from which older sightings are dropped, likewise


class ChordModel(NamedTuple):
    """What the chord between two sightings of a person can be worth.

    The person turns by at most an angle per way that it walks, and, on the
    spot, by at most its greatest turning rate.
    """

    error: float  # of each sighting, in [m]
    speed: float  # greatest speed of the person, in [m/s]
    radius: float  # of its tightest turn, in [m]
    interval: float  # between two sightings at most, in [s]

    @property
    def best(self) -> float:
        """Length of the chord that is worth most, in [m]."""
        return max(LEAST_CHORD, 2.0 * sqrt(self.error * self.radius))

    @property
    def spacing(self) -> float:
        """Distance between sightings that are kept, in [m]."""
        return SPACING * self.best

    @property
    def bound(self) -> float:
        """Greatest error of a heading by the best chord there is, in [rad].

        Sightings are some way apart, so that none may end the best chord.
        """
        apart = self.speed * self.interval + 2.0 * self.error + self.spacing
        short = max(LEAST_CHORD, 2.0 * self.error, self.best - 0.5 * apart)
        return max(self.error_of(short), self.error_of(short + apart))

    def error_of(self, chord: float) -> float:
        """Return the greatest error of a heading by a chord [m], in [rad]."""
        hidden = 2.0 * self.error
        if chord < max(hidden, 0.999 * LEAST_CHORD):
            return pi
        turned = min(1.0, 0.5 * (chord + hidden) / self.radius)
        return asin(hidden / chord) + asin(turned)

    def spread_of(self, chord: float, passed: float) -> float:
        """Return the same of a person who may have turned on the spot.

        Meanwhile a time [s] has passed.
        """
        hidden = 2.0 * self.error
        if chord < max(hidden, 0.999 * LEAST_CHORD):
            return pi
        walked = 0.5 * max(0.0, chord - hidden) / self.speed
        turned = self.speed / self.radius * (passed - walked)
        return min(pi, asin(hidden / chord) + max(0.0, turned))

    def note(
        self, rows: tuple[SeenOpponent, ...], seen: SeenOpponent
    ) -> tuple[SeenOpponent, ...]:
        """Return the sightings that are kept, with a new one at the end."""
        if not rows:
            return (seen,)
        if seen.time <= rows[-1].time:
            return rows
        if len(rows) > 1 and apart(*rows[-2:]) < self.spacing:
            rows = rows[:-1]  # only the newest may be so near
        long, first = LONGEST * self.best, 0
        for i, row in enumerate(rows):
            if apart(row, seen) > long:
                first = i
        return (*rows[first:], seen)


def apart(one: SeenOpponent, other: SeenOpponent) -> float:
    """Return the distance between two sightings, in [m]."""
    return hypot(other.x - one.x, other.y - one.y)


class Course(NamedTuple):
    """Heading of an opponent, and how far it may be off."""

    time: float  # time of the last sighting [s]
    heading: float = 0.0  # heading in the map [rad]
    error: float = pi  # greatest error of the heading [rad]
    # the same if it may have turned on the spot [rad]
    spread: float = pi


def observed_course(
    before: Course | None, rows: Sequence[SeenOpponent], model: ChordModel
) -> Course:
    """Return the heading of an opponent after its last sighting.

    It follows the chord that is worth most, no faster than the opponent turns
    (docs/shield-proof.md). Errors up to the bound of the model count as known.
    """
    last, known = rows[-1], model.bound
    before = before or Course(last.time)
    turn = model.speed / model.radius
    turned = turn * max(0.0, last.time - before.time)
    unseen = before._replace(
        time=last.time,
        error=min(pi, before.error + turned),
        spread=min(pi, before.spread + turned),
    )
    if len(rows) < 2:
        return unseen
    chords = [(model.error_of(apart(row, last)), row) for row in rows[:-1]]
    error, row = min(chords, key=lambda chord: chord[0])
    error, chord = max(error, known), apart(row, last)
    direction = atan2(last.y - row.y, last.x - row.x)
    spread = model.spread_of(chord, last.time - row.time)
    if error < before.error:
        return Course(last.time, direction, error, max(error, spread))
    if error > unseen.error:  # the chord shows less than is known
        return unseen._replace(spread=max(unseen.error, unseen.spread))
    off = wrap_angle(direction - before.heading)
    moved = min(max(off, -turned), turned)
    spread = min(spread + abs(off - moved), unseen.spread + abs(moved))
    return Course(last.time, before.heading + moved, error, max(error, spread))


def tried_headings(course: Course, error: float, known: float) -> list[float]:
    """Return the headings of the opponent that count, in [rad].

    Several do where the error [rad] is above what is known.
    """
    count = ceil(error / 0.25) if error > known + 1e-9 else 0
    return [
        course.heading + error * i / max(count, 1)
        for i in range(-count, count + 1)
    ]
