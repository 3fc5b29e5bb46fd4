"""Feasibility of a gait: joint speeds and torques of the reference motion.

Computed by kinematics and inverse dynamics, without a physics simulation.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import inf
from typing import NamedTuple

import numpy as np

from ..control.scheme import ControlScheme
from ..control.scheme import build_scheme
from ..control.sight_sources import MeasuredSight
from ..core.poses import Array
from ..locomotion.control_settings import OPEN_LOOP
from ..perception.measurement import RobotState, Sighting
from ..planning import Direction, GaitSettings
from ..robots.description import RobotDescription
from ..robots.joint_loads import LegLoads
from ..robots.leg_kinematics import LegKinematics
from ..strategies import Walk

TICK = 0.004  # control period, in [s]
CYCLES = 2  # gait cycles after the first step, which are representative
NO_LIMIT = 1e3  # joint speed limit that is never reached, in [rad/s]
SPEED_MARGIN = 0.9  # fraction of the speed limits that a gait is scaled to
LEAST_LENGTHS = 0.35  # least fraction of the nominal step lengths
ITERATIONS = 4
QUANTILES = (0.5, 0.9)  # of the torques in single support
GREATEST_LOAD = 0.95  # fraction of a torque limit
ZMP_GAIN = 0.9  # load ratio below which another ZMP offset is preferred
LIFTED = 1e-3  # height above which a foot is lifted, in [m]


def speed_ratio(description: RobotDescription, gait: GaitSettings) -> float:
    """Return the greatest joint speed of straight walking by its limit."""
    greatest = 0.0
    for direction in Direction:
        scheme = _scheme(description, gait, direction)
        motors = scheme.walk.kinematics.legs.tree.motors
        limits = [description.speed_limits[name] for name in motors]
        path = np.array([scheme.joint_targets, *_walk(scheme, gait)])
        speeds = np.abs(np.diff(path, axis=0)) / TICK
        greatest = max(greatest, float((speeds / limits).max()))
    return greatest


class JointLoads(NamedTuple):
    """Greatest joint torques of single support, by the torque limits."""

    usual: float  # median over time: short peaks may exceed the servos
    joint: str
    most: float  # exceeded in a tenth of the time


def step_loads(
    description: RobotDescription,
    gait: GaitSettings,
    torques: Mapping[str, float],
) -> JointLoads:
    """Compute the joint loads of a step by inverse dynamics."""
    scheme = _scheme(description, gait, Direction.FORWARD)
    # The scheme computes many ticks at once; loads need them one by one.
    legs = LegKinematics(scheme.walk.kinematics.description, tick=TICK)
    walk = scheme.walk
    legs.stand(walk.reference)
    dynamics = LegLoads(legs, zmp_forward=gait.zmp_forward, tick=TICK)
    by_swing_foot: dict[bool, list[Array]] = {True: [], False: []}
    for _ in _walk(scheme, gait):
        body = walk.reference
        legs.track(body)
        required = np.abs(dynamics.torques(body, walk.planned_centers[2:]))
        left, right = (
            f[2] > LIFTED for f in (body.left_foot, body.right_foot)
        )
        if left != right:
            by_swing_foot[left].append(required)
    names = legs.legs.tree.motors
    limits = np.array([torques.get(name, inf) for name in names])
    usual, most = (
        np.max([np.quantile(f, q, axis=0) for f in by_swing_foot.values()], 0)
        / limits
        for q in QUANTILES
    )
    return JointLoads(
        float(usual.max()), names[int(usual.argmax())], float(most.max())
    )


def choose_zmp_offset(
    description: RobotDescription,
    gait: GaitSettings,
    torques: Mapping[str, float],
) -> tuple[float, JointLoads]:
    """Choose how far ahead of the ankles the ZMP reference is.

    The torque of an ankle grows with this offset; no other gait parameter
    has as much influence on any torque.

    Fraction of the nominal offset, and the loads with it: the greatest of 1,
    1/2 and 0 within the torque limits; else the one with the least load, if
    that is much less than with 1.
    """
    candidates = []
    for fraction in (1.0, 0.5, 0.0):
        changed = replace(gait, zmp_forward=fraction * gait.zmp_forward)
        loads = step_loads(description, changed, torques)
        candidates.append((fraction, loads))
        if loads.most <= GREATEST_LOAD:
            return fraction, loads
    best = min(candidates, key=lambda each: each[1].most)
    nominal = candidates[0]
    return best if best[1].most < ZMP_GAIN * nominal[1].most else nominal


def feasible_lengths(
    description: RobotDescription, gait: GaitSettings
) -> float:
    """Return the fraction of stride and step height that joints can track.

    A servo that falls behind its target makes the swing foot land early and
    in the wrong position. Shorter steps of the same duration need less speed
    of every joint.

    Fraction in [0.35, 1]; 1 if the joints are fast enough.
    """
    fraction = 1.0
    for _ in range(ITERATIONS):
        shorter = replace(
            gait,
            speed=fraction * gait.speed,
            stride=fraction * gait.stride,
            step_height=fraction * gait.step_height,
        )
        ratio = speed_ratio(description, shorter)
        if ratio <= 1.0:
            break
        fraction = max(LEAST_LENGTHS, fraction * SPEED_MARGIN / ratio)
    return fraction


def _scheme(
    description: RobotDescription, gait: GaitSettings, direction: Direction
) -> ControlScheme:
    """Build an open-loop control scheme without joint speed limits."""
    unlimited = dict.fromkeys(description.speed_limits, NO_LIMIT)
    return build_scheme(
        Walk(0.0, direction),
        replace(description, speed_limits=unlimited),
        gait,
        OPEN_LOOP,
        tick=TICK,
        senses=MeasuredSight(Sighting(0.0, 0.0, inf)),
    )


def _walk(scheme: ControlScheme, gait: GaitSettings) -> Iterator[Array]:
    """Yield the joint targets of some steps, tick by tick, in [rad]."""
    joints, zero = np.zeros(scheme.joint_targets.size), np.zeros(3)
    duration = gait.start_support + 2 * CYCLES * gait.step_duration
    for i in range(round(duration / TICK)):
        yield scheme.update(
            RobotState(i * TICK, joints, zero, zero, np.zeros(8), None)
        )
