"""A gait gone through by the joints alone, before anything has mass."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import inf
from typing import NamedTuple

import numpy as np

from ..control.scheme import ControlScheme
from ..control.scheme_builder import build_scheme
from ..core.poses import Array
from ..locomotion.zmp.control_settings import OPEN_LOOP
from ..perception.measurement import Measurement, Sighting
from ..planning import Direction, GaitSettings
from ..robots.description import RobotDescription
from ..robots.joint_loads import LegLoads
from ..strategies import Walk

TICK = 0.004  # of the rehearsal, in [s]
CYCLES = 2  # gait cycles after the first step: later ones are like them
SWIFT = 1e3  # of joints that follow whatever is asked, in [rad/s]
SPARE = 0.9  # of a joint's speed that a gait may ask for
LEAST = 0.35  # share of a gait's lengths that is still worth walking
TRIES = 4
PARTS = (0.5, 0.9)  # of a step, in which torques are looked at
BEARABLE = 0.95  # share of a torque that may be borne most of the time
HELPS = 0.9  # of a torque, if the ZMP is to be elsewhere all the same
LIFTED = 1e-3  # a foot that is higher bears nothing, in [m]


def speed_share(description: RobotDescription, gait: GaitSettings) -> float:
    """Greatest share of a joint's speed that straight walking asks for.

    Args:
        description: The robot, with the speed limits of its joints.
        gait: How it walks.

    Raises:
        ReachError: If its legs do not reach so far.
    """
    return max(_asked(description, gait, way) for way in Direction)


class TorqueShares(NamedTuple):
    """Greatest shares of their torque that joints bear in a step.

    Attributes:
        usual: In half of the time at which one foot is lifted: what is asked
            for a moment only, servos may miss.
        joint: That bears it.
        most: In a tenth of that time or more; more than 1 cannot be borne.
        most_joint: That bears it.
    """

    usual: float
    joint: str
    most: float
    most_joint: str


def torques_borne(
    description: RobotDescription,
    gait: GaitSettings,
    torques: Mapping[str, float],
) -> TorqueShares:
    """Shares of their torque that joints bear in a step.

    Args:
        description: The robot.
        gait: How it walks.
        torques: Greatest torque of each joint, in [N m].

    Raises:
        ReachError: If the legs do not reach so far.
    """
    scheme = _scheme(description, gait, Direction.FORWARD)
    legs = scheme.kinematics
    loads = LegLoads(legs, zmp_forward=gait.zmp_forward, tick=TICK)
    borne: dict[bool, list[Array]] = {True: [], False: []}
    for _ in _walk(scheme, gait):
        body = scheme.reference
        asked = np.abs(loads.torques(body, scheme.zmp_reference))
        left, right = (
            f[2] > LIFTED for f in (body.left_foot, body.right_foot)
        )
        if left != right:
            borne[left].append(asked)
    names = legs.legs.tree.motors
    limits = np.array([torques.get(name, inf) for name in names])
    found: list[float | str] = []
    for part in PARTS:
        steps = [np.quantile(each, part, axis=0) for each in borne.values()]
        shares = np.max(steps, axis=0) / limits
        joint = int(shares.argmax())
        found += [float(shares[joint]), names[joint]]
    return TorqueShares(*found)  # type: ignore[arg-type]


def zmp_share(
    description: RobotDescription,
    gait: GaitSettings,
    torques: Mapping[str, float],
) -> tuple[float, TorqueShares]:
    """Share of the ZMP's place ahead of the ankles that these can bear.

    The farther ahead it is, the more an ankle bears; nothing else of a gait
    changes so much of any torque.

    Args:
        description: The robot.
        gait: How it would walk.
        torques: Greatest torque of each joint, in [N m].

    Returns:
        The greatest of 1, 1/2 and 0 that leaves something of each torque, or
        else the one that leaves most, if it leaves much more than 1 does;
        and what is borne then.
    """
    tried = []
    for share in (1.0, 0.5, 0.0):
        forward = share * gait.zmp_forward
        walk = replace(gait, zmp_forward=forward)
        borne = torques_borne(description, walk, torques)
        tried.append((share, borne))
        if borne.most <= BEARABLE:
            return share, borne
    best = min(tried, key=lambda each: each[1].most)
    return best if best[1].most < HELPS * tried[0][1].most else tried[0]


def lengths_share(description: RobotDescription, gait: GaitSettings) -> float:
    """Share of stride and step height at which the joints keep up.

    A servo that cannot follow its target leaves the swing foot behind: it
    lands early, where nobody wants it. Steps of fewer metres in the same
    time ask for less speed of every joint.

    Args:
        description: The robot.
        gait: How it would walk.

    Returns:
        In [0.35, 1]; 1 if the joints are fast enough.
    """
    share = 1.0
    for _ in range(TRIES):
        asked = speed_share(description, shortened(gait, share))
        if asked <= 1.0:
            break
        share = max(LEAST, share * SPARE / asked)
    return share


def shortened(gait: GaitSettings, share: float) -> GaitSettings:
    """Gait with a share of its lengths, in the same time."""
    return replace(
        gait,
        speed=share * gait.speed,
        stride=share * gait.stride,
        step_height=share * gait.step_height,
    )


def _asked(
    description: RobotDescription, gait: GaitSettings, way: Direction
) -> float:
    """Greatest share of a joint's speed that walking one way asks for."""
    scheme = _scheme(description, gait, way)
    motors = scheme.kinematics.legs.tree.motors
    limits = np.array([description.speed_limits[name] for name in motors])
    last, greatest = scheme.joint_targets, 0.0
    for now in _walk(scheme, gait):
        speeds = np.abs(now - last) / TICK
        greatest = max(greatest, float((speeds / limits).max()))
        last = now
    return greatest


def _scheme(
    description: RobotDescription, gait: GaitSettings, way: Direction
) -> ControlScheme:
    """Control of a robot whose joints are as fast as it takes."""
    swift = dict.fromkeys(description.speed_limits, SWIFT)
    return build_scheme(
        Walk(0.0, way),
        replace(description, speed_limits=swift),
        gait,
        OPEN_LOOP,
        tick=TICK,
        sighting=Sighting(0.0, 0.0, inf),
    )


def _walk(scheme: ControlScheme, gait: GaitSettings) -> Iterator[Array]:
    """Joint targets of some steps, tick by tick, in [rad]."""
    still, none = np.zeros(scheme.joint_targets.size), np.zeros(3)
    duration = gait.start_support + 2 * CYCLES * gait.step_duration
    for i in range(round(duration / TICK)):
        yield scheme.update(
            Measurement(i * TICK, still, none, none, np.zeros(8), None)
        )
