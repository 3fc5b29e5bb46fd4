"""Footsteps that a simulated robot is told, checked, and those it makes."""

from collections.abc import Sequence
from math import isfinite
from typing import Any

from ...core.poses import Pose
from ...planning import Foot, GaitSettings
from ..velocity.footstep_commands import FootCommand, stride_of
from ..velocity.velocity_body import VelocityCommand
from .footstep_mover import LEGS

FEET = {leg: foot for foot, leg in LEGS.items()}
ASIDE = 0.02  # by which a foot may stand beside its path, in [m]
MAX_STRIDE, MAX_TURN = 0.08, 0.524  # of NAO's own walk, in [m] and [rad]
LEAST = 0.01  # between two landings, in [s]
CREEPING = 2e-3  # of a step on the spot, in [m/s]


def read_steps(
    legs: Any, places: Any, times: Any, before: Foot | None
) -> list[FootCommand]:
    """Footsteps as they are told, checked.

    Args:
        legs: Names, LLeg or RLeg.
        places: Of each x, y [m] and theta [rad] in the frame of the other
            foot.
        times: Of the landings, in [s], rising.
        before: Foot that lands before them, if one is under way.

    Raises:
        ValueError: If they are none, or cannot be walked.
    """
    legs, places, times = _listed(legs), _listed(places), _listed(times)
    if not legs or not len(legs) == len(places) == len(times):
        raise ValueError(
            "as many legs as steps and times are needed, got "
            f"{len(legs)}, {len(places)} and {len(times)}"
        )
    steps = []
    earlier, previous = 0.0, before
    for leg, place, time in zip(legs, places, times, strict=True):
        if leg not in FEET:
            raise ValueError(f"leg must be LLeg or RLeg, got {leg!r:.40}")
        foot = FEET[leg]
        if foot is previous:
            raise ValueError(f"feet must take turns, got {leg} twice")
        at = float(time)
        if not (isfinite(at) and at >= earlier + LEAST):
            raise ValueError(f"times must rise [s], got {times!r:.80}")
        steps.append(FootCommand(foot, _place(place), at))
        earlier, previous = at, foot
    return steps


def velocity_of(step: FootCommand, gait: GaitSettings) -> VelocityCommand:
    """Velocity of a gait that walks one footstep as one step.

    Raises:
        ValueError: If no unicycle would step so.
    """
    length, turn, aside = stride_of(step.pose, step.foot, gait.foot_spacing)
    if abs(aside) > ASIDE:
        raise ValueError(
            f"it walks no way aside: a foot {abs(aside):.3f} m beside its "
            f"path, at most {ASIDE} m"
        )
    if abs(length) > MAX_STRIDE or abs(turn) > MAX_TURN:
        raise ValueError(
            f"a step must be at most {MAX_STRIDE} m and {MAX_TURN} rad, got "
            f"{length:.3f} m and {turn:.3f} rad"
        )
    forward = length / gait.step_duration
    if abs(forward) < CREEPING:
        forward = CREEPING if forward >= 0.0 else -CREEPING
    return VelocityCommand(forward, turn / gait.step_duration)


def told(step: FootCommand) -> list[Any]:
    """A footstep as ``getFootSteps`` tells it."""
    return [LEGS[step.foot], step.time, list(step.pose)]


def _listed(values: Any) -> list[Any]:
    alone = isinstance(values, str) or not isinstance(values, Sequence)
    return [values] if alone else list(values)


def _place(values: Any) -> Pose:
    try:
        x, y, theta = (float(value) for value in values)
    except TypeError as error:
        raise ValueError(f"a step is x, y, theta, got {values!r}") from error
    if not (isfinite(x) and isfinite(y) and isfinite(theta)):
        raise ValueError(f"steps must be finite, got {values!r}")
    return Pose(x, y, theta)
