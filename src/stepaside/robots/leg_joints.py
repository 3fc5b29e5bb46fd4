"""What the joint motion of a robot can move, and what it cannot.

The legs' free joints are unknown, followers move with their leaders, and
all other joints stay where the robot stands with them.
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

FIXED_ROWS = 15  # two feet, and the CoM
BASE = 4  # unknowns of a torso that stays level


@dataclass(frozen=True, slots=True, eq=False)
class LegJoints:
    """Legs of one robot, as joint motion sees them.

    Attributes:
        tree: The robot.
        free: Leg joints that are unknown.
        columns: Number of the free joint that moves each link; None for
            links that stay.
        fixed: Angles of all joints while the free ones are 0, in [rad].
        low: Least angles of the free joints, in [rad]. Shape (free,).
        high: Greatest ones. Shape (free,).
        speeds: Greatest speeds of the free joints, in [rad/s].
            Shape (free,).
        feet: Links that the soles are on, left and right.
        sites: Names of the soles, left and right.
        holds_heading: Whether the torso's heading has a row of its own: it
            does where legs have a joint to spare for it.
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
        """Find the legs of a robot in its tree.

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
        """Angles of all joints, from those of the free ones, in [rad]."""
        return [
            fixed if column is None else free[column]
            for column, fixed in zip(self.columns[1:], self.fixed, strict=True)
        ]

    def torso_axes(self, trace: ExpressionTrace) -> Matrix:
        """Axes of the torso in a level frame that heads as it does.

        Takes an argument of the trace where the torso leans: its roll.
        """
        if self.lean == 0.0:
            return LEVEL
        return rotation_about((1.0, 0.0, 0.0), trace.variable("roll"))

    def rolled(self, roll: float) -> tuple[float, ...]:
        """That argument: the roll of a torso that leans, in [rad]."""
        return (roll,) if self.lean > 0.0 else ()

    def chain(self, side: int) -> list[int]:
        """Links between the torso and a foot that the free joints move."""
        return [
            link
            for link in self.tree.chain(self.feet[side])
            if self.columns[link] is not None
        ]

    @property
    def is_plain(self) -> bool:
        """Whether rows and unknowns pair off: six hinges in either leg.

        There are then as many unknowns as rows, and the legs share one
        joint or the torso's heading has its row.
        """
        left, right = self.chain(0), self.chain(1)
        moved = [link for link, c in enumerate(self.columns) if c is not None]
        shared = 12 - len(self.free)
        return (
            len(left) == len(right) == 6
            and sorted(left + right) == moved
            and shared + self.holds_heading == 1
            and self._shares_across(left, right)
            and all(self.tree.links[i].kind == HINGE for i in moved)
        )

    def _shares_across(self, left: list[int], right: list[int]) -> bool:
        """Whether no leg has two joints that move as one."""
        return all(
            len({self.columns[link] for link in chain}) == 6
            for chain in (left, right)
        )
