"""A gait gone through by the joints alone, before anything has mass."""

from dataclasses import replace
from math import inf

import numpy as np

from ..control.assembly import build_scheme
from ..control.balance.settings import OPEN_LOOP
from ..planning import Direction, GaitSettings
from ..robots.description import RobotDescription
from ..sensing.measurement import Measurement, Sighting
from ..strategies import Walk

TICK = 0.004  # of the rehearsal, in [s]
CYCLES = 2  # gait cycles after the first step: later ones are like them
SWIFT = 1e3  # of joints that follow whatever is asked, in [rad/s]
SPARE = 0.9  # of a joint's speed that a gait may ask for
LEAST = 0.35  # share of a gait's lengths that is still worth walking
TRIES = 4


def speed_share(description: RobotDescription, gait: GaitSettings) -> float:
    """Greatest share of a joint's speed that straight walking asks for.

    Args:
        description: The robot, with the speed limits of its joints.
        gait: How it walks.

    Raises:
        ReachError: If its legs do not reach so far.
    """
    return max(_asked(description, gait, way) for way in Direction)


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
    swift = dict.fromkeys(description.speed_limits, SWIFT)
    scheme = build_scheme(
        Walk(0.0, way),
        replace(description, speed_limits=swift),
        gait,
        OPEN_LOOP,
        tick=TICK,
        sighting=Sighting(0.0, 0.0, inf),
    )
    limits = np.array(
        [
            description.speed_limits[name]
            for name in scheme.kinematics.legs.tree.motors
        ]
    )
    still, none = np.zeros(limits.size), np.zeros(3)
    now = scheme.joint_targets
    greatest = 0.0
    duration = gait.start_support + 2 * CYCLES * gait.step_duration
    for i in range(round(duration / TICK)):
        last = now
        now = scheme.update(
            Measurement(i * TICK, still, none, none, np.zeros(8), None)
        )
        speeds = np.abs(now - last) / TICK
        greatest = max(greatest, float((speeds / limits).max()))
    return greatest
