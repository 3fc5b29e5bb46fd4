"""Gait of a robot by its size, and what its joints can follow of it.

Speeds and torques come from kinematics and inverse dynamics.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import inf, pi, sqrt
from typing import NamedTuple

import numpy as np

from ..control.scheme import ControlScheme, build_walk
from ..control.sight_sources import MeasuredSight
from ..core.constants import GRAVITY
from ..core.poses import Array
from ..locomotion.control_settings import OPEN_LOOP
from ..perception.measurement import RobotState, Sighting
from ..planning import Direction, GaitSettings
from ..robots.description import RobotDescription
from ..robots.description_types import RobotGames
from ..robots.joint_loads import LegLoads
from ..robots.leg_kinematics import LegKinematics
from ..strategies import Walk

# Robots of one shape walk alike if lengths scale with the CoM height z and
# times with sqrt(z / g). The ratios are those of NAO's gait, except that steps
# are quicker: heavier robots walked best with shorter steps in trials.
# Lengths by the CoM height, times and rates by the time constant of the
# pendulum, speeds by its speed sqrt(g z).
STRIDE = 0.15
STEP_HEIGHT = 0.075
PATH = 2.42  # path time of a stride
TURNING = 0.033  # steering gain times the time constant
SUPPORTS = {
    "single_support": 2.0,
    "double_support": 0.58,
    "start_support": 4.8,
}
STABILISER_LENGTHS = {
    "dead_zone": 0.056,
    "edge": 0.0075,
    "reach_forward": 2.0 * STRIDE,
    "reach_backward": 2.0 * STRIDE,
    "reach_outward": 0.075,
}
STABILISER_RATES = {"yielding": 0.83, "joint_gain": 1.65, "joint_leak": 0.165}
GAP = 0.045
ANKLE_RATE = 0.18
STEP_SPEED = 0.92
PUSH = 0.12
INVERSE_NAO_MASS = 0.1885  # in [1/kg]
INVERSE_NAO_HEIGHT = 3.73  # of the CoM, in [1/m]
# Distances by that on the circle, 4 v sqrt(2) / (pi k).
SAFETY_RADIUS = 0.89
START_LEAST = 0.45
START_NEAR = 0.67
START_FAR = 1.67


@dataclass(frozen=True, slots=True)
class RobotSize:
    """Size of a robot, by which its gait is scaled."""

    com_height: float  # walking height of the CoM [m]
    mass: float  # mass of the robot [kg]
    foot_spacing: float  # distance between the feet [m]
    # edges back, front, outer and inner [m]; only the back edge is negative
    sole: tuple[float, float, float, float]
    reach: float  # radius of the standing robot [m]

    @property
    def time(self) -> float:
        """Time constant of the pendulum, in [s]."""
        return sqrt(self.com_height / GRAVITY)

    @property
    def speed(self) -> float:
        """Speed of the pendulum, in [m/s]."""
        return sqrt(self.com_height * GRAVITY)


def gait_of(size: RobotSize, lengths: float = 1.0) -> dict[str, float]:
    """Return the gait entries of a description, in SI units."""
    z, time = size.com_height, size.time
    stride = rounded(lengths * STRIDE * z)
    back, front, *_ = size.sole
    return {
        "speed": rounded(stride / (PATH * time)),
        "gain": rounded(TURNING / time),
        "stride": stride,
        "foot_spacing": rounded(size.foot_spacing, 4),
        "step_height": rounded(lengths * STEP_HEIGHT * z),
        **{name: rounded(part * time) for name, part in SUPPORTS.items()},
        "com_height": round(z, 4),
        "zmp_forward": round(0.45 * (front + back), 4),
    }


def stabiliser_of(size: RobotSize) -> dict[str, float]:
    """Return the stabiliser entries of a description, in SI units."""
    z, time = size.com_height, size.time
    lengths = {k: rounded(v * z) for k, v in STABILISER_LENGTHS.items()}
    rates = {k: rounded(v / time) for k, v in STABILISER_RATES.items()}
    gap = size.foot_spacing - 2.0 * size.sole[3]  # of soles abreast
    return {
        **lengths,
        **rates,
        "ankle_rate": rounded(ANKLE_RATE * time),
        "gap": rounded(min(GAP * z, 0.5 * gap)),
        "step_speed": rounded(STEP_SPEED * size.speed),
        "stride_gain": 0.0,
        "load_share": 1.0,
    }


def game_of_size(size: RobotSize, gait: dict[str, float]) -> RobotGames:
    """Return distances, by the circle of two equal robots, and scales."""
    circle = 4.0 * sqrt(0.5) * gait["speed"] / (pi / 2 * gait["gain"])
    least = max(START_LEAST * circle, 2.0 * size.reach)
    return RobotGames(
        safety_radius=rounded(max(SAFETY_RADIUS * circle, 1.2 * least)),
        start_least=rounded(least),
        start_near=rounded(max(START_NEAR * circle, 1.1 * least)),
        start_far=rounded(max(START_FAR * circle, 1.7 * least)),
        push_unit=rounded(PUSH * size.mass * size.speed),
        force_unit=rounded(INVERSE_NAO_MASS * size.mass),
        length_unit=rounded(INVERSE_NAO_HEIGHT * size.com_height),
    )


def rounded(value: float, digits: int = 3) -> float:
    """Return a value with so many significant digits."""
    return float(f"{value:.{digits}g}")


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
        motors = scheme.walk.kinematics.joint_names
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
    names = legs.joint_names
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

    The torque of an ankle grows with it. The greatest of 1, 1/2 and 0 of the
    nominal offset within the torque limits, else the one with the least load.
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

    Shorter steps of the same duration need less speed of every joint. In
    [0.35, 1].
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
    limits = dict.fromkeys(description.speed_limits, NO_LIMIT)
    unlimited = replace(description, speed_limits=limits)
    walk = build_walk(unlimited, gait, OPEN_LOOP, tick=TICK)
    senses = MeasuredSight(Sighting(0.0, 0.0, inf))
    return ControlScheme(Walk(0.0, direction), walk, senses)


def _walk(scheme: ControlScheme, gait: GaitSettings) -> Iterator[Array]:
    """Yield the joint targets of some steps, tick by tick, in [rad]."""
    joints, zero = np.zeros(scheme.joint_targets.size), np.zeros(3)
    duration = gait.start_support + 2 * CYCLES * gait.step_duration
    for i in range(round(duration / TICK)):
        yield scheme.update(
            RobotState(i * TICK, joints, zero, zero, np.zeros(8), None)
        )
