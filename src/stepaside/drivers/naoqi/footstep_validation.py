"""Validation of footsteps that a client commands to a simulated robot."""

from collections.abc import Sequence
from math import isfinite
from typing import Any

from ...core.poses import Pose
from ...planning import Foot, GaitSettings
from ..velocity.footstep_commands import FootCommand, path_segment_of
from ..velocity.velocity_body import VelocityCommand
from .footstep_mover import LEGS

FEET = {leg: foot for foot, leg in LEGS.items()}
MAX_LATERAL = 0.02  # lateral displacement that is tolerated, in [m]
MAX_STRIDE, MAX_TURN = 0.08, 0.524  # of NAO's own walk, in [m] and [rad]
MIN_INTERVAL = 0.01  # between two landings, in [s]
MIN_SPEED = 2e-3  # of a step in place, in [m/s]


def read_steps(
    legs: Any, poses: Any, times: Any, before: Foot | None
) -> list[FootCommand]:
    """Validate the arguments of ``setFootSteps``.

    Args:
        legs: Names, LLeg or RLeg.
        poses: x, y [m] and theta [rad] of each step in the frame of the
            other foot.
        times: Landing times, in [s], increasing.
        before: Foot that lands before them, if a step is under way.

    Raises:
        ValueError: If they are not footsteps of alternating feet.
    """
    legs, poses, times = _as_list(legs), _as_list(poses), _as_list(times)
    if not legs or not len(legs) == len(poses) == len(times):
        raise ValueError(
            "legs, steps and times must have the same length > 0, got "
            f"{len(legs)}, {len(poses)} and {len(times)}"
        )
    steps = []
    earlier, previous = 0.0, before
    for leg, pose, time in zip(legs, poses, times, strict=True):
        if leg not in FEET:
            raise ValueError(f"leg must be LLeg or RLeg, got {leg!r:.40}")
        foot = FEET[leg]
        if foot is previous:
            raise ValueError(f"feet must alternate, got {leg} twice")
        at = float(time)
        if not (isfinite(at) and at >= earlier + MIN_INTERVAL):
            raise ValueError(
                f"times must increase by at least {MIN_INTERVAL:g} s, got "
                f"{times!r:.80}"
            )
        steps.append(FootCommand(foot, _pose(pose), at))
        earlier, previous = at, foot
    return steps


def velocity_of(step: FootCommand, gait: GaitSettings) -> VelocityCommand:
    """Return the velocity at which one step of the gait is this footstep.

    Raises:
        ValueError: If the footstep is beyond the limits of the gait.
    """
    length, turn, lateral = path_segment_of(
        step.pose, step.foot, gait.foot_spacing
    )
    if abs(lateral) > MAX_LATERAL:
        raise ValueError(
            "the lateral displacement of a step must be at most "
            f"{MAX_LATERAL} m, got {abs(lateral):.3f} m"
        )
    if abs(length) > MAX_STRIDE or abs(turn) > MAX_TURN:
        raise ValueError(
            f"a step must be at most {MAX_STRIDE} m and {MAX_TURN} rad, got "
            f"{length:.3f} m and {turn:.3f} rad"
        )
    forward = length / gait.step_duration
    if abs(forward) < MIN_SPEED:
        forward = MIN_SPEED if forward >= 0.0 else -MIN_SPEED
    return VelocityCommand(forward, turn / gait.step_duration)


def footstep_entry(step: FootCommand) -> list[Any]:
    """Return a footstep as an entry of ``getFootSteps``."""
    return [LEGS[step.foot], step.time, list(step.pose)]


def _as_list(values: Any) -> list[Any]:
    is_single = isinstance(values, str) or not isinstance(values, Sequence)
    return [values] if is_single else list(values)


def _pose(values: Any) -> Pose:
    try:
        x, y, theta = (float(value) for value in values)
    except TypeError as error:
        raise ValueError(
            f"a step must be x, y and theta, got {values!r}"
        ) from error
    if not (isfinite(x) and isfinite(y) and isfinite(theta)):
        raise ValueError(f"steps must be finite, got {values!r}")
    return Pose(x, y, theta)
