"""Leg joints of a robot as inverse kinematics uses them.

The free joints of the legs are unknowns, followers move with their leaders,
and all other joints stay at their standing angles.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ModelError
from ..core.poses import Array
from .description import RobotDescription
from .joint_tree import JointTree, joint_tree
from .newton_step import BASE, FIXED_ROWS
from .robot_tree import RobotTree


@dataclass(frozen=True, slots=True, eq=False)
class LegJoints:
    """Leg joints of one robot.

    Attributes:
        tree: Kinematic tree of the robot.
        free: Independent leg joints: the unknowns.
        links: Links that they move, with the frames of both soles.
        columns: Index of the free joint that moves each joint; -1 for those
            that are fixed to the torso. Shape (joints,).
        fixed: Angles of all joints with the free ones at 0, in [rad]. Shape
            (joints,).
        standing: Standing angles of the free joints, in [rad]. Shape (free,).
        limits: Lower and upper limit [rad] and speed limit [rad/s] of the
            free joints. Shape (free, 3).
        holds_heading: Whether the torso heading is a row: legs with
            independent hip yaws have one more unknown than the other rows.
        lean: See :class:`~.description.RobotDescription`, in [rad].
    """

    tree: RobotTree
    free: tuple[str, ...]
    links: JointTree
    columns: NDArray[np.int64]
    fixed: Array
    standing: Array
    limits: Array
    holds_heading: bool
    lean: float

    @classmethod
    def of(cls, description: RobotDescription, tree: RobotTree) -> "LegJoints":
        """Look up the leg joints of a robot in its tree."""
        free = tuple(
            name for name in description.legs if name not in tree.followers
        )
        for name in free:
            if name not in description.speed_limits:
                raise ModelError(
                    f"legs of {description.name}: joint {name!r} has neither "
                    "a motor with a speed limit nor a joint to follow"
                )
        columns, fixed = {}, {}
        for name in tree.joints:
            leader = tree.followers.get(name, name)
            if leader in free:
                columns[name] = free.index(leader)
            else:
                fixed[name] = float(description.standing.get(leader, 0.0))
        limits = []
        for name in free:
            link = tree.links[tree.link_of(name)]
            low, high = description.working_limits.get(
                name, (link.low, link.high)
            )
            limits.append((low, high, description.speed_limits[name]))
        soles = [
            tree.sites[name]
            for name in (description.left_foot, description.right_foot)
        ]
        return cls(
            tree,
            free,
            joint_tree(tree, columns, fixed, soles),
            np.array([columns.get(name, -1) for name in tree.joints]),
            np.array([fixed.get(name, 0.0) for name in tree.joints]),
            np.array([description.standing.get(n, 0.0) for n in free], float),
            np.array(limits, dtype=np.float64),
            len(free) + BASE > FIXED_ROWS,
            description.lean,
        )

    def angles(self, free: Array) -> Array:
        """Return the angles of all joints from the free ones, in [rad]."""
        return np.where(self.columns < 0, self.fixed, free[self.columns])
