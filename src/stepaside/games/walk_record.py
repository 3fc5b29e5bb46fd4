"""The record of a walk, seen from the support foot.

Odometry and the world drift apart by slip, so what was asked, what was
estimated and what is true are compared in the frame of the support foot.
"""

from math import atan2

import mujoco
import numpy as np

from ..control.balance.mpc import MpcResult
from ..planning import Foot, ManeuverPlan
from ..poses import Array, Pose
from .match import Match
from .outcome import Outcome
from .walker import Walker

PERIOD = 0.02  # between samples, in [s]
COLUMNS = (
    *("time", "support", "single", "com_x", "com_y", "velocity_x"),
    *("velocity_y", "reference_x", "reference_y", "zmp_x", "zmp_y"),
    *("zmp_reference_x", "zmp_reference_y", "roll", "pitch"),
    *("estimated_com_x", "estimated_com_y", "estimated_velocity_x"),
    *("estimated_velocity_y", "estimated_zmp_x", "estimated_zmp_y"),
    *("estimated_roll", "estimated_pitch"),
    *("world_x", "world_y", "heading", "asked_x", "asked_y"),
    *("asked_heading", "foot_x", "foot_y"),
)


class WalkRecorder:
    """Samples a walk; columns are named in ``COLUMNS``.

    Attributes:
        every: Control ticks between samples.
        steps: Steps begun so far.
        plans: Plans walked so far, for their margins afterwards.
        solved: Answers of the MPC so far, if there is one.
    """

    def __init__(self, walker: Walker) -> None:
        """Record a robot that walks."""
        self._walker = walker
        robot, scheme = walker.robot, walker.scheme
        world = robot.world
        self._model, self._data = world.model, world.data
        self.every = max(1, round(PERIOD / world.physics.tick))
        description = scheme.kinematics.description
        soles = (
            (Foot.LEFT, description.left_foot),
            (Foot.RIGHT, description.right_foot),
        )
        self._sites = {
            foot: world.model.site(f"{robot.name}/{sole}").id
            for foot, sole in soles
        }
        self._torso = world.model.body(f"{robot.name}/{description.torso}").id
        self._rows: list[tuple[float, ...]] = []
        self.steps = 0
        self.plans: list[ManeuverPlan] = []
        self.solved: list[MpcResult] = []

    def before(self, match: Match) -> None:
        """Take a sample when one is due, but not of the start."""
        if match.world.ticks > 0:
            self._sample_if_due(match)

    def acted(self, match: Match) -> None:
        """Note what began, and what a solver answered."""
        walker = self._walker
        if walker.begun is not None:
            self.steps += 1
            self.plans.append(walker.begun.plan)
        solved = walker.scheme.balance.solved
        if solved is not None:
            self.solved.append(solved)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Take the last sample, unless the robot lies."""
        if outcome in (Outcome.COMPLETED, Outcome.INTERRUPTED):
            self.before(match)

    def _sample_if_due(self, match: Match) -> None:
        now = match.world.time
        sampled = bool(self._rows) and self._rows[-1][0] == now
        if match.world.ticks % self.every == 0 and not sampled:
            self._rows.append(self._row(now))

    def _row(self, now: float) -> tuple[float, ...]:
        """One sample."""
        walker, data = self._walker, self._data
        walk = walker.scheme.state
        step = walk.step(now)
        foot = step.swing.other
        site = self._sites[foot]
        x, y, _ = data.site_xpos[site].tolist()
        frame = data.site_xmat[site]
        true = Pose(x, y, atan2(frame[3], frame[0])).inverse()
        asked = step.support.inverse()
        mujoco.mj_subtreeVel(self._model, data)
        velocity = data.subtree_linvel[self._torso].tolist()
        com = walker.truth.com.tolist()
        torso = data.xmat[self._torso].tolist()
        estimate: tuple[float, ...] = (np.nan,) * 8
        if walk.estimate is not None:
            state = walk.estimate
            estimate = (
                *_point(asked, state.com),
                *_vector(asked, state.velocity),
                *_point(asked, state.zmp),
                *state.tilt,
            )
        reference = walk.reference.com
        return (
            now,
            foot.value,
            float(step.walking and step.remaining > 0.0),
            *_point(true, com[:2]),
            *_vector(true, velocity[:2]),
            *_point(asked, reference[:2]),
            *_point(true, walker.robot.measured_zmp()),
            *_point(asked, walk.zmp_reference),
            atan2(torso[7], torso[8]),
            -np.arcsin(torso[6]),
            *estimate,
            *com[:2],
            atan2(torso[3], torso[0]),
            *reference[:2],
            walk.torso_heading,
            x,
            y,
        )

    def arrays(self) -> dict[str, Array]:
        """Columns by name. Shape (n,) each."""
        table = np.array(self._rows, dtype=np.float64)
        table = table.reshape(-1, len(COLUMNS))
        return {name: table[:, i] for i, name in enumerate(COLUMNS)}


def _point(frame: Pose, point: tuple[float, ...]) -> tuple[float, float]:
    there = frame.compose(Pose(point[0], point[1], 0.0))
    return there.x, there.y


def _vector(frame: Pose, vector: tuple[float, ...]) -> tuple[float, float]:
    turned = Pose(0.0, 0.0, frame.theta)
    return _point(turned, vector)
