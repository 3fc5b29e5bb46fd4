"""Where the other player is and how it walks, from sightings in odometry."""

from abc import ABC, abstractmethod
from math import atan2, cos, hypot, sin
from typing import NamedTuple

from ..core.poses import wrap_angle
from ..planning import Direction
from .knowledge import Intent, Knowledge, Limits
from .search.step_motion import PlayerPair, StepRules, pursue

KEPT = 3  # sightings, a step apart: over two steps no body sways
APART = 0.75  # of a step between them
STEPS_OFF = 0.05  # of a step of another from what was thought, in [m]
MOVED = 0.3  # of a stride: who moves less may look anywhere


class OpponentSighting(NamedTuple):
    """One sighting, all in the own odometry.

    Attributes:
        time: When, in [s].
        x: Of the other, in [m].
        y: Of the other, in [m].
        own_x: Of the own body, in [m].
        own_y: Of the own body, in [m].
        own_theta: Own heading, in [rad].
    """

    time: float
    x: float
    y: float
    own_x: float
    own_y: float
    own_theta: float


Trace = tuple[OpponentSighting, ...]
"""The last sightings, the oldest first, the last one always the newest."""


def note(trace: Trace, knowledge: Knowledge) -> Trace:
    """Take a sighting in; those that lie close together are thinned out.

    One that is not sure counts as much as it is, beside where the other
    would be by now that goes on as it went.
    """
    pose = knowledge.pose
    sight = pose.theta + knowledge.bearing
    time = knowledge.time - knowledge.age
    x = pose.x + knowledge.distance * cos(sight)
    y = pose.y + knowledge.distance * sin(sight)
    if trace and knowledge.spread > 0.0:
        u, v = _gone_on(trace, time, knowledge.limits)
        trust = STEPS_OFF**2 / (STEPS_OFF**2 + knowledge.spread**2)
        x, y = u + trust * (x - u), v + trust * (y - v)
    seen = OpponentSighting(time, x, y, pose.x, pose.y, pose.theta)
    step = knowledge.limits.step_duration
    kept = [s for s in trace if 0.0 < seen.time - s.time < 2 * KEPT * step]
    # The newest makes way if it came too soon after the one before.
    if len(kept) > 1 and kept[-1].time - kept[-2].time < APART * step:
        kept.pop()
    return tuple([*kept, seen][-KEPT:])


def _gone_on(trace: Trace, time: float, limits: Limits) -> tuple[float, float]:
    """Where the other is if it goes on as it went, as fast as the own gait.

    Args:
        trace: At least one sighting.
        time: When, in [s].
        limits: Of the own gait.
    """
    first, last = trace[0], trace[-1]
    passed, ahead = last.time - first.time, max(time - last.time, 0.0)
    if passed <= 0.0:
        return last.x, last.y
    rate = ahead / passed
    dx, dy = rate * (last.x - first.x), rate * (last.y - first.y)
    most = limits.stride * ahead / limits.step_duration
    share = min(1.0, most / max(hypot(dx, dy), most, 1e-12))
    return last.x + share * dx, last.y + share * dy


def pursuer_heading(trace: Trace, rules: StepRules) -> float:
    """Heading of a pursuer in odometry, in [rad].

    The pursuer of eqs. (1)-(2) is stepped along the sightings; the heading
    with which it began is the one that takes it where it was seen. One that
    has not moved is taken to look here.

    Args:
        trace: At least one sighting.
        rules: What its steps do.
    """
    last = trace[-1]
    facing = atan2(last.own_y - last.y, last.own_x - last.x)
    if len(trace) < 2:
        return facing
    first = trace[0]
    dx, dy = last.x - first.x, last.y - first.y
    steps = len(trace) - 1
    if hypot(dx, dy) < MOVED * steps * rules.pursuer_stride:
        return facing
    way = atan2(dy, dx)
    begin = end = way
    for _ in range(5):
        x, y, c, s = first.x, first.y, cos(begin), sin(begin)
        for seen in trace[:-1]:
            own_c, own_s = cos(seen.own_theta), sin(seen.own_theta)
            x, y, c, s = pursue(
                PlayerPair(seen.own_x, seen.own_y, own_c, own_s, x, y, c, s),
                rules,
            )
        end = atan2(s, c)
        begin += wrap_angle(way - atan2(y - first.y, x - first.x))
    return end


def heading_of_way(trace: Trace) -> float | None:
    """Direction in which the other moves, in [rad]; None while unknown.

    Its turn goes on as it was: over two steps the heading is ahead of the
    way by what the way of one turned.
    """
    if len(trace) < 2:
        return None
    before, last = trace[-2], trace[-1]
    if hypot(last.x - before.x, last.y - before.y) < 1e-3:
        return None
    way = atan2(last.y - before.y, last.x - before.x)
    if len(trace) < 3:
        return way
    first = trace[-3]
    earlier = atan2(before.y - first.y, before.x - first.x)
    return way + 0.5 * wrap_angle(way - earlier)


class PathPursuit(ABC):
    """A pursuer that points at the other until its way is known."""

    __slots__ = ()

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return Direction.FORWARD

    @property
    def saturated(self) -> bool:
        """It turns by (2), up to what that may ask for."""
        return False

    def begin(self) -> Trace:
        """Nothing seen."""
        return ()

    def decide(
        self, knowledge: Knowledge, memory: Trace
    ) -> tuple[Intent, Trace]:
        """Point at the other, or where its way tells."""
        trace = note(memory, knowledge)
        way = heading_of_way(trace)
        if way is None:
            return Intent(knowledge.bearing), trace
        return Intent(self.heading(knowledge, trace[-1], way)), trace

    @abstractmethod
    def heading(
        self, knowledge: Knowledge, seen: OpponentSighting, way: float
    ) -> float:
        """Heading to ask for, from the own one, in [rad].

        Args:
            knowledge: What is known.
            seen: The newest sighting.
            way: Direction in which the other moves in odometry, in [rad].
        """
