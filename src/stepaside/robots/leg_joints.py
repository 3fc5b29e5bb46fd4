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
    """Leg joints of one robot."""

    tree: RobotTree
    free: tuple[str, ...]  # independent leg joints: the unknowns
    links: JointTree  # links that they move, with the frames of both soles
    # index of the free joint that moves each joint; -1 for those that are
    # fixed to the torso, (joints,)
    columns: NDArray[np.int64]
    # angles of all joints with the free ones at 0 [rad], (joints,)
    fixed: Array
    standing: Array  # standing angles of the free joints [rad], (free,)
    # lower and upper limit [rad] and speed limit [rad/s] of the free joints,
    # (free, 3)
    limits: Array
    # whether the torso heading is a row: legs with independent hip yaws have
    # one more unknown than the other rows
    holds_heading: bool
    lean: float  # of the torso, see `RobotDescription` [rad]

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
