"""Position and heading of the opponent, from sightings in odometry."""

from abc import ABC, abstractmethod
from math import atan2, cos, hypot, sin
from typing import NamedTuple

from ..core.poses import wrap_angle
from ..planning import Direction
from .knowledge import Intent, Knowledge, Limits
from .search.step_motion import PlayerPair, StepRules, pursue

MAX_SIGHTINGS = 3  # a step apart: over two steps the sway cancels
SPACING = 0.75  # least time between them, in steps
PREDICTION_STD = 0.05  # of the position predicted a step ahead, in [m]
MIN_MOTION = 0.3  # per step, in strides, that determines a heading


class OpponentSighting(NamedTuple):
    """Positions of both players at one sighting, in the own odometry.

    Attributes:
        time: Time of the sighting, in [s].
        x: Position of the opponent, in [m].
        y: Likewise.
        own_x: Position of the own body, in [m].
        own_y: Likewise.
        own_theta: Own heading, in [rad].
    """

    time: float
    x: float
    y: float
    own_x: float
    own_y: float
    own_theta: float


Trace = tuple[OpponentSighting, ...]
"""Last sightings, the oldest first; the last one is always the newest."""


def note(trace: Trace, knowledge: Knowledge) -> Trace:
    """Add a sighting; those that are close in time are thinned out.

    A sighting with a known variance is fused with the predicted position.
    """
    pose = knowledge.pose_in_map
    sight = pose.theta + knowledge.bearing
    time = knowledge.time - knowledge.age
    x = pose.x + knowledge.distance * cos(sight)
    y = pose.y + knowledge.distance * sin(sight)
    if trace and knowledge.spread > 0.0:
        u, v = _predicted(trace, time, knowledge.limits)
        weight = PREDICTION_STD**2 / (PREDICTION_STD**2 + knowledge.spread**2)
        x, y = u + weight * (x - u), v + weight * (y - v)
    sighting = OpponentSighting(time, x, y, pose.x, pose.y, pose.theta)
    step = knowledge.limits.step_duration
    recent = [
        s
        for s in trace
        if 0.0 < sighting.time - s.time < 2 * MAX_SIGHTINGS * step
    ]
    # The newest is replaced if it is too close to the one before.
    if len(recent) > 1 and recent[-1].time - recent[-2].time < SPACING * step:
        recent.pop()
    return tuple([*recent, sighting][-MAX_SIGHTINGS:])


def _predicted(
    trace: Trace, time: float, limits: Limits
) -> tuple[float, float]:
    """Predict the position of the opponent at the speed of the trace.

    Args:
        trace: At least one sighting.
        time: Time of the prediction, in [s].
        limits: Limits of the own gait, which bound the speed.
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
    """Estimate the heading of a pursuer in odometry, in [rad].

    The pursuer of eqs. (1)-(2) is simulated along the sightings, and its
    initial heading is fitted to its last position. A pursuer that has not
    moved is assumed to face the own robot.

    Args:
        trace: At least one sighting.
        rules: Model of its steps.
    """
    last = trace[-1]
    facing = atan2(last.own_y - last.y, last.own_x - last.x)
    if len(trace) < 2:
        return facing
    first = trace[0]
    dx, dy = last.x - first.x, last.y - first.y
    steps = len(trace) - 1
    if hypot(dx, dy) < MIN_MOTION * steps * rules.pursuer_stride:
        return facing
    way = atan2(dy, dx)
    begin = end = way
    for _ in range(5):
        x, y, c, s = first.x, first.y, cos(begin), sin(begin)
        for sighting in trace[:-1]:
            own_c, own_s = cos(sighting.own_theta), sin(sighting.own_theta)
            x, y, c, s = pursue(
                PlayerPair(
                    sighting.own_x, sighting.own_y, own_c, own_s, x, y, c, s
                ),
                rules,
            )
        end = atan2(s, c)
        begin += wrap_angle(way - atan2(y - first.y, x - first.x))
    return end


def direction_of_motion(trace: Trace) -> float | None:
    """Estimate the direction of motion, in [rad]; None while it is unknown.

    With a constant turn, the heading after two steps leads the chord of the
    last step by half the angle between the two chords.
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
    """Base of pursuers that use the opponent's direction of motion."""

    __slots__ = ()

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return Direction.FORWARD

    @property
    def saturated(self) -> bool:
        """False: it turns by (2)."""
        return False

    def begin(self) -> Trace:
        """Return an empty trace."""
        return ()

    def decide(
        self, knowledge: Knowledge, memory: Trace
    ) -> tuple[Intent, Trace]:
        """Head for the opponent until its direction of motion is known."""
        trace = note(memory, knowledge)
        course = direction_of_motion(trace)
        if course is None:
            return Intent(knowledge.bearing), trace
        return Intent(self.heading(knowledge, trace[-1], course)), trace

    @abstractmethod
    def heading(
        self, knowledge: Knowledge, sighting: OpponentSighting, course: float
    ) -> float:
        """Return the desired heading in the own frame, in [rad].

        Args:
            knowledge: Knowledge of the player.
            sighting: The newest sighting.
            course: Direction of motion of the opponent in odometry, in
                [rad].
        """
