"""Track of the opponent: its motion over the floor, from sightings."""

from math import atan2, hypot
from typing import NamedTuple

from ..core.poses import Pose, wrap_angle
from .knowledge import Knowledge

LEAST = 0.75  # steps that positions must span to show a motion
CYCLE = 2.25  # steps over which the sway of a walking body cancels
PREDICTION_STD = 0.05  # of a predicted position, in [m]
ORIGIN = Pose(0.0, 0.0, 0.0)


class SeenOpponent(NamedTuple):
    """Position [m] of the opponent at a time [s], and the own pose then."""

    time: float
    x: float
    y: float
    own: Pose = ORIGIN


class OpponentTrack(NamedTuple):
    """Positions of the opponent in a fixed frame, the oldest first."""

    step: float  # duration of a step of a gait [s]
    span: float = 3.25  # age up to which positions are kept, in steps
    spacing: float = 0.125  # least, but before the newest, in steps
    rows: tuple[SeenOpponent, ...] = ()  # the positions

    def note(
        self, time: float, position: tuple[float, float], own: Pose = ORIGIN
    ) -> "OpponentTrack":
        """Return the track with a newer position [m] at a time [s]."""
        oldest = time - self.span * self.step
        rows = [row for row in self.rows if oldest <= row.time < time]
        near = self.spacing * self.step - 1e-9
        # The newest is replaced if it is too close to the one before.
        if len(rows) > 1 and rows[-1].time - rows[-2].time < near:
            rows.pop()
        x, y = position
        rows.append(SeenOpponent(time, x, y, own))
        return OpponentTrack(self.step, self.span, self.spacing, tuple(rows))

    @property
    def velocity(self) -> tuple[float, float] | None:
        """Slope of a line fitted to the positions [m/s]; None if unknown."""
        rows = self.rows
        if not rows or rows[-1].time - rows[0].time <= LEAST * self.step:
            return None
        count, last = len(rows), rows[-1].time
        middle = sum(row.time - last for row in rows) / count
        square = along = across = 0.0
        for time, x, y, _ in rows:
            dt = time - last - middle
            square += dt * dt
            along += dt * (x - rows[0].x)
            across += dt * (y - rows[0].y)
        return along / square, across / square

    @property
    def course(self) -> float | None:
        """Direction of motion now, in [rad]; None while unknown.

        With a constant turn, it leads the chord of the last step by half the
        angle between the last two chords.
        """
        if len(self.rows) < 2:
            return None
        before, last = self.rows[-2:]
        dx, dy = last.x - before.x, last.y - before.y
        if hypot(dx, dy) < 1e-3:
            return None
        way = atan2(dy, dx)
        if len(self.rows) < 3:
            return way
        first = self.rows[-3]
        earlier = atan2(before.y - first.y, before.x - first.x)
        return way + 0.5 * wrap_angle(way - earlier)

    @property
    def sight_rates(self) -> tuple[float | None, float | None]:
        """Turning rate of the line of sight, and decrease of its length.

        In [rad/s] and [m/s], over the last gait cycle; None while unknown.
        """
        was = now = self.rows[-1]
        begin = now.time - CYCLE * self.step - 1e-9
        for was in self.rows:
            if was.time >= begin:
                break
        passed = now.time - was.time
        if passed <= LEAST * self.step:
            return None, None
        x, y = now.x - now.own.x, now.y - now.own.y
        u, v = was.x - was.own.x, was.y - was.own.y
        turned = atan2(u * y - v * x, u * x + v * y)
        return turned / passed, (hypot(u, v) - hypot(x, y)) / passed


def track_of_steps(
    track: OpponentTrack | None, knowledge: Knowledge
) -> OpponentTrack:
    """Return the track of the opponent at each step, with this sighting.

    A sighting with a known variance is fused with the predicted position.
    """
    limits, time = knowledge.limits, knowledge.time - knowledge.age
    if track is None:
        track = OpponentTrack(limits.step_duration, 6.0, LEAST)
    x, y = knowledge.position_in_map
    if track.rows and knowledge.spread > 0.0:
        last = track.rows[-1]
        u, v = track.velocity or (0.0, 0.0)
        fastest = limits.stride / limits.step_duration
        ahead = max(time - last.time, 0.0)
        ahead *= min(1.0, fastest / max(hypot(u, v), 1e-12))
        weight = PREDICTION_STD**2 / (PREDICTION_STD**2 + knowledge.spread**2)
        x = weight * x + (1.0 - weight) * (last.x + ahead * u)
        y = weight * y + (1.0 - weight) * (last.y + ahead * v)
    return track.note(time, (x, y), knowledge.pose_in_map)
