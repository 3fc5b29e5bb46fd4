"""The record of a walk, seen from the support foot.

Odometry and the world drift apart by slip, so what was asked, what was
estimated and what is true are compared in the frame of the support foot.
"""

from math import atan2

import mujoco
import numpy as np

from ..control import ControlScheme
from ..planning import Foot
from ..poses import Array, Pose
from ..world.robot import SimulatedRobot

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
    """

    def __init__(self, robot: SimulatedRobot, scheme: ControlScheme) -> None:
        """Record a robot driven by a scheme."""
        self._robot, self._scheme = robot, scheme
        world = robot.world
        self._model, self._data = world.model, world.data
        self.every = max(1, round(PERIOD / world.physics.tick))
        description = scheme.kinematics.description
        self._sites = {
            Foot.LEFT: world.model.site(
                f"{robot.name}/{description.left_foot}"
            ).id,
            Foot.RIGHT: world.model.site(
                f"{robot.name}/{description.right_foot}"
            ).id,
        }
        self._torso = world.model.body(f"{robot.name}/{description.torso}").id
        self._rows: list[tuple[float, ...]] = []

    def sample(self) -> None:
        """Take one sample."""
        scheme, data = self._scheme, self._data
        now = self._robot.world.time
        step = scheme.step(now)
        foot = step.swing.other
        site = self._sites[foot]
        x, y, _ = data.site_xpos[site].tolist()
        frame = data.site_xmat[site]
        true = Pose(x, y, atan2(frame[3], frame[0])).inverse()
        asked = step.support.inverse()
        mujoco.mj_subtreeVel(self._model, data)
        velocity = data.subtree_linvel[self._torso].tolist()
        com = self._robot.truth.com.tolist()
        torso = data.xmat[self._torso].tolist()
        estimate: tuple[float, ...] = (np.nan,) * 8
        stabiliser = scheme.stabiliser
        if stabiliser is not None and stabiliser.state is not None:
            state = stabiliser.state
            estimate = (
                *_point(asked, state.com),
                *_vector(asked, state.velocity),
                *_point(asked, state.zmp),
                *state.tilt,
            )
        reference = scheme.reference.com
        self._rows.append(
            (
                now,
                foot.value,
                float(step.walking and step.remaining > 0.0),
                *_point(true, com[:2]),
                *_vector(true, velocity[:2]),
                *_point(asked, reference[:2]),
                *_point(true, self._robot.measured_zmp()),
                *_point(asked, scheme.zmp_reference),
                atan2(torso[7], torso[8]),
                -np.arcsin(torso[6]),
                *estimate,
                *com[:2],
                atan2(torso[3], torso[0]),
                *reference[:2],
                scheme.kinematics.torso_heading,
                x,
                y,
            )
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
