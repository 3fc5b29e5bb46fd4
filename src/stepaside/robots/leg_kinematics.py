"""Joint motion generation by Newton's method (paper, Sec. III-A)."""

from math import remainder, tau
from typing import NamedTuple

import numpy as np

from ..core.compilation import bound
from ..core.errors import ModelError, ReachError
from ..core.poses import Array
from ..core.rotations import quaternion_of
from .description import RobotDescription
from .joint_tree import joint_tree, place_frames
from .newton_step import (
    BASE,
    FIXED_ROWS,
    SINGULAR,
    STATE,
    BodyReference,
    linearise,
    newton_steps,
)
from .tree_cache import load_tree

__all__ = ["ROWS", "BodyReference", "LegKinematics"]

STAND_STEP = 0.3  # joint motion per iteration while standing, in [rad]
ITERATIONS = 60  # of a standing posture
TOLERANCE = 1e-4  # residual at which a posture counts as reached
GREATEST_ERROR = 0.5  # residual that is refused, in [m] or [rad]
ROWS = (
    *(f"left foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"right foot {c}" for c in ("x", "y", "z", "roll", "pitch", "yaw")),
    *(f"CoM {c}" for c in ("x", "y", "z")),
    "torso heading",
)


class LegStates(NamedTuple):
    """Postures of the legs at consecutive ticks."""

    # angles of the free joints [rad]; position (x, y, z) of the torso [m], and
    # its heading [rad], in the frame of the reference; its heading a tick
    # earlier; its roll, all [rad]. The first row is the posture before the
    # first tick, (ticks + 1, free + 6)
    rows: Array
    targets: Array  # [rad], (ticks, joints)

    @property
    def torso_headings(self) -> list[float]:
        """:attr:`LegKinematics.torso_heading` after each tick, in [rad]."""
        return [remainder(x, tau) for x in self.rows[1:, -2].tolist()]


def _reaches(residuals: Array) -> bool:
    return float(np.abs(residuals).max()) < TOLERANCE


class LegKinematics:
    """Floating-base inverse kinematics of one robot.

    ``state`` is the present posture, a row of :class:`LegStates`; ``error``
    the remaining error of each row of the last solution.
    """

    def __init__(self, description: RobotDescription, *, tick: float) -> None:
        self.description = description
        self.tree = tree = load_tree(description)
        self.joint_names = motors = tree.motors
        # Independent leg joints: the unknowns.
        self.free = free = tuple(
            name for name in description.legs if name not in tree.followers
        )
        speeds, standing = description.speed_limits, description.standing
        for name in free:
            if name not in speeds:
                raise ModelError(
                    f"legs of {description.name}: joint {name!r} has neither "
                    "a motor with a speed limit nor a joint to follow"
                )
        columns, fixed = tree.moved_by(free, standing)
        feet = description.left_foot, description.right_foot
        soles = [tree.sites[name] for name in feet]
        # Links that the legs move, with the frames of both soles.
        self.links = joint_tree(tree, columns, fixed, soles)
        self._moved, self._still = columns, fixed
        self._columns = np.array([columns.get(x, -1) for x in motors])
        self._fixed = np.array([fixed.get(x, 0.0) for x in motors])
        self._still_motors = self._columns < 0
        self._standing = np.array([standing.get(x, 0.0) for x in free], float)
        limits = []
        for name in free:
            link, own = tree.links[tree.link_of(name)], speeds[name]
            range_ = description.working_limits.get(
                name, (link.low, link.high)
            )
            limits.append((*range_, own, own * tick))
        self._stand_limits = np.array(limits, dtype=np.float64)
        self._stand_limits[:, 3] = STAND_STEP
        n = len(free)
        self.state = np.zeros(n + STATE)
        self.state[:n] = self._standing
        # Legs with independent hip yaws have one more unknown than the other
        # rows: the torso heading is a row then.
        self.error = np.zeros(FIXED_ROWS + (n + BASE > FIXED_ROWS))
        self._check_rank()
        self._states: LegStates
        # Reference of one tick, and the states before and after it.
        self._row, self._pair = np.zeros((1, 15)), np.zeros((2, n + STATE))
        self._steps = bound(
            *(newton_steps, self.links, np.array(limits, dtype=np.float64)),
            *(description.lean, True, GREATEST_ERROR),
            more=(self._row, self._pair, self.error),
        )

    def _check_rank(self) -> None:
        """Refuse joints that cannot move all rows at the standing angles."""
        state, rows = self.state, self.error.size
        jacobian = np.empty((rows, state.size - STATE + BASE))
        linearise(
            self.links, np.zeros(15), state, 0.0, np.empty(rows), jacobian
        )
        least = min(jacobian.shape)
        if np.linalg.matrix_rank(jacobian, tol=SINGULAR) < least:
            raise ModelError(
                f"the legs of {self.description.name} cannot place both feet: "
                "joints that follow each other must not turn about parallel "
                "axes"
            )

    @property
    def joint_targets(self) -> Array:
        """Angles of the actuated joints, in [rad]. Shape (joints,)."""
        return self._targets(self.state)

    def _targets(self, states: Array) -> Array:
        """Return the joint targets of states. Shape (..., joints)."""
        targets: Array = states.take(self._columns, axis=-1)
        np.copyto(targets, self._fixed, where=self._still_motors)
        return targets

    @property
    def posture(self) -> Array:
        """Position and quaternion of the torso, then all joints."""
        n = len(self.free)
        turned = quaternion_of(self.state[n + 5], 0.0, self.state[n + 3])
        angles, moved = self.state.tolist(), self._moved
        angles_of = self._still | {x: angles[i] for x, i in moved.items()}
        joints = (angles_of[name] for name in self.tree.joints)
        return np.array([*angles[n : n + 3], *turned, *joints])

    @property
    def torso_heading(self) -> float:
        """Heading of the torso before the last step, in [rad].

        That is where the body is by the time of the next one.
        """
        return remainder(self.state[-2], tau)

    def stand(self, reference: BodyReference) -> Array:
        """Solve a posture from the standing angles; return joint targets.

        Raises:
            ReachError: If the legs cannot reach it; names the worst row.
        """
        state, self.error[:] = self.posture_of(reference)
        if not _reaches(self.error):
            from .com_heights import stopped_joints

            worst = int(np.argmax(np.abs(self.error)))
            least, greatest = self.com_heights(reference)
            heights = f"{least:.3f} m to {greatest:.3f} m"
            if greatest == 0.0:
                heights = "no height at all"
            elif reference.com[2] > greatest:
                heights = f"at most {greatest:.3f} m"
            raise ReachError(
                f"{self.description.name} cannot reach {ROWS[worst]} with a "
                f"CoM height of {reference.com[2]:g} m; it reaches {heights} "
                "in this stance"
                + stopped_joints(self.free, state, self._stand_limits)
            )
        self.state = state
        return self.joint_targets

    def com_heights(self, reference: BodyReference) -> tuple[float, float]:
        """Return least and greatest CoM height [m] over the feet, or zeros."""
        from .com_heights import search_heights

        x, y, _ = reference.com
        com, soles, axes = np.empty(3), np.empty((2, 3)), np.empty((2, 3, 3))
        place_frames(self.links, self._standing, com, soles, axes)
        return search_heights(
            lambda z: _reaches(
                self.posture_of(reference._replace(com=(x, y, z)))[1]
            ),
            float(com[2] - soles[:, 2].max()),
        )

    def posture_of(self, reference: BodyReference) -> tuple[Array, Array]:
        """Return the state and the residuals of a posture."""
        n, lean = len(self.free), self.description.lean
        states, errors = np.zeros((2, n + STATE)), np.empty_like(self.error)
        states[1, :n] = self._standing
        states[1, n : n + BASE] = *reference.com, reference.heading
        row = np.array([reference.row()], dtype=np.float64)
        for _ in range(ITERATIONS):
            states[0] = states[1]
            newton_steps(
                *(self.links, self._stand_limits, lean),
                *(False, np.inf),
                *(row, states, errors),
            )
            if _reaches(errors):
                break
        return states[1], errors

    def track(self, reference: BodyReference) -> Array:
        """Track a reference by one step from the last posture; return targets.

        A joint at a limit of its range or speed stays there, and the torso and
        the other joints minimise the residuals.

        Raises:
            ReachError: If a residual is too large; names the worst row.
        """
        self._row[0], self._pair[0] = reference.row(), self.state
        self._follow(self._row, self._pair)
        self.state = self._pair[1].copy()
        return self.joint_targets

    def track_rows(self, references: Array) -> LegStates:
        """Track rows (ticks, 15) up to one out of reach; see :meth:`track`."""
        rows = np.empty((len(references) + 1, self.state.size))
        rows[0] = self.state
        count = self._follow(references, rows)
        targets = self._targets(rows[1 : count + 1])
        self._states = LegStates(rows[: count + 1], targets)
        self.rewind(count)
        return self._states

    def _follow(self, references: Array, rows: Array) -> int:
        """Set the states after the first; return how many are in reach."""
        count = self._steps(references, rows, self.error)
        if count == 0:
            worst = int(np.argmax(np.abs(self.error)))
            raise ReachError(
                f"{self.description.name} cannot follow: {ROWS[worst]} is "
                f"off by {self.error[worst]:.3f}, more than "
                f"{GREATEST_ERROR:g} [m, rad]"
            )
        return count

    def rewind(self, ticks: int) -> None:
        """Return to the posture after the first ``ticks`` of the last rows."""
        self.state = self._states.rows[ticks]
