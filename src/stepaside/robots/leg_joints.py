"""Leg joints of a robot as inverse kinematics uses them.

The free joints of the legs are unknowns, followers move with their leaders,
and all other joints stay at their standing angles.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .description import RobotDescription
from .expression_tracing import ExpressionTrace, Number
from .link_poses import LEVEL
from .robot_tree import HINGE, RobotTree
from .scalar_algebra import Matrix, rotation_about

FIXED_ROWS = 15  # of two feet and the CoM
BASE = 4  # unknowns of the torso, whose roll and pitch are given


@dataclass(frozen=True, slots=True, eq=False)
class LegJoints:
    """Leg joints of one robot.

    Attributes:
        tree: Kinematic tree of the robot.
        free: Independent leg joints: the unknowns.
        columns: Index of the free joint that moves each link; None for
            links that are fixed to the torso.
        fixed: Angles of all joints with the free ones at 0, in [rad].
        low: Lower limits of the free joints, in [rad]. Shape (free,).
        high: Upper limits of the free joints, in [rad]. Shape (free,).
        speeds: Speed limits of the free joints, in [rad/s]. Shape (free,).
        feet: Links of the soles, left and right.
        sites: Sites of the soles, left and right.
        holds_heading: Whether the torso heading is a row: legs with
            independent hip yaws have one more unknown than the other rows.
        lean: See :class:`~.description.RobotDescription`, in [rad].
    """

    tree: RobotTree
    free: tuple[str, ...]
    columns: tuple[int | None, ...]
    fixed: tuple[float, ...]
    low: Array
    high: Array
    speeds: Array
    feet: tuple[int, int]
    sites: tuple[str, str]
    holds_heading: bool
    lean: float = 0.0

    @classmethod
    def of(cls, description: RobotDescription, tree: RobotTree) -> "LegJoints":
        """Look up the leg joints of a robot in its tree.

        Raises:
            ModelError: If a leg joint has neither motor nor leader.
        """
        free = tuple(
            name for name in description.legs if name not in tree.followers
        )
        for name in free:
            if name not in description.speed_limits:
                raise ModelError(
                    f"legs of {description.name}: joint {name!r} has neither "
                    "a motor with a speed limit nor a joint to follow"
                )
        columns: list[int | None] = []
        fixed = []
        for name in tree.joints:
            leader = tree.followers.get(name, name)
            moves = leader in free
            columns.append(free.index(leader) if moves else None)
            angle = description.standing.get(leader, 0.0)
            fixed.append(0.0 if moves else float(angle))
        links = [tree.links[tree.link_of(name)] for name in free]
        working = description.working_limits
        limits = [
            working.get(link.joint, (link.low, link.high)) for link in links
        ]
        low, high = np.array(limits, dtype=np.float64).T
        sites = (description.left_foot, description.right_foot)
        left, right = (tree.sites[name].link for name in sites)
        return cls(
            tree,
            free,
            (None, *columns),
            tuple(fixed),
            low,
            high,
            np.array([description.speed_limits[name] for name in free]),
            (left, right),
            sites,
            len(free) + BASE > FIXED_ROWS,
            description.lean,
        )

    def angles(self, free: Sequence[Number]) -> list[Number]:
        """Return the angles of all joints from the free ones, in [rad]."""
        return [
            fixed if column is None else free[column]
            for column, fixed in zip(self.columns[1:], self.fixed, strict=True)
        ]

    def torso_axes(self, trace: ExpressionTrace) -> Matrix:
        """Return the axes of the torso in the level torso frame.

        Adds the roll as a variable of the trace if the torso leans.
        """
        if self.lean == 0.0:
            return LEVEL
        return rotation_about((1.0, 0.0, 0.0), trace.variable("roll"))

    def chain(self, side: int) -> list[int]:
        """Return the links of the left (0) or right (1) leg."""
        return [
            link
            for link in self.tree.chain(self.feet[side])
            if self.columns[link] is not None
        ]

    @property
    def key(self) -> tuple[RobotTree, *tuple[object, ...]]:
        """Tree, and all else that the formulas of the legs depend on."""
        lean = self.lean > 0.0
        return self.tree, self.columns, self.fixed, self.sites, lean

    @property
    def is_plain(self) -> bool:
        """Whether each leg has six hinges and rows match unknowns.

        The legs then share one joint, or the torso heading is a row.
        """
        left, right = self.chain(0), self.chain(1)
        moved = [link for link, c in enumerate(self.columns) if c is not None]
        shared = 12 - len(self.free)
        return (
            len(left) == len(right) == 6
            and sorted(left + right) == moved
            and shared + self.holds_heading == 1
            and self._are_distinct(left)
            and self._are_distinct(right)
            and all(self.tree.links[i].kind == HINGE for i in moved)
        )

    def _are_distinct(self, chain: list[int]) -> bool:
        """Return whether no two joints of a leg are coupled."""
        return len({self.columns[link] for link in chain}) == 6
