"""Motors of a described robot."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..robots.description import RobotDescription
from ..robots.tree_cache import load_tree
from .robot import JointRobot


class Motors(NamedTuple):
    """Motors of a described robot, in the order of the joint targets.

    Attributes:
        names: Names of their joints.
        low: Minimum angles, in [rad]. Shape (motors,).
        high: Maximum angles, in [rad]. Shape (motors,).
        speed: Maximum speeds, in [rad/s]. Shape (motors,).
        legs: Indices of the motors that carry the robot. Shape (legs,).
        order: Index of each motor among the joints of the robot's class.
            Shape (motors,).
        stiffness: Gains that hold a posture, in [N m/rad]. Shape (motors,).
        damping: Likewise, in [N m s/rad]. Shape (motors,).
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    speed: Array
    legs: NDArray[np.intp]
    order: NDArray[np.intp]
    stiffness: Array
    damping: Array


def motors_of(robot: JointRobot, description: RobotDescription) -> Motors:
    """Return the motors of a robot with ranges, speeds and gains.

    Raises:
        ConfigurationError: If the robot lacks a joint, or gains of one.
    """
    tree, kind = load_tree(description), type(robot).__name__
    names, joints = tree.motors, list(robot.joints)
    missing = [name for name in names if name not in joints]
    if missing:
        raise ConfigurationError(
            f"{kind}: joints lack {', '.join(missing)} of the description; "
            f"they are {', '.join(joints)}"
        )
    servos = description.overlay.servos.items()
    gains = {name: (own.stiffness, own.damping) for name, own in servos}
    gains |= dict(robot.gains or {})
    missing = [name for name in names if name not in gains]
    if missing:
        raise ConfigurationError(f"{kind}: gains lack {', '.join(missing)}")
    links = [tree.links[tree.link_of(name)] for name in names]
    pairs = np.array([gains[name] for name in names], dtype=np.float64)
    speeds = [description.speed_limits.get(name, np.inf) for name in names]
    # Legs may share a motor.
    legs = [names.index(leg) for leg in description.legs if leg in names]
    return Motors(
        names,
        low=np.array([link.low for link in links]),
        high=np.array([link.high for link in links]),
        speed=np.array(speeds),
        legs=np.array(legs),
        order=np.array([joints.index(name) for name in names]),
        stiffness=pairs[:, 0],
        damping=pairs[:, 1],
    )
