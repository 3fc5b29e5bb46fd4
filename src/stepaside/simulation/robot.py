"""A simulated robot behind the interface that control moves."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

import numpy as np

from ..control.body import Measurement
from ..poses import Array, Pose
from ..robots.description import RobotDescription
from ..robots.kinematics import LegKinematics
from .sight import IdealLineOfSight
from .truth import TrueState
from .world import World, place_free_body

if TYPE_CHECKING:
    from .eyes import Eyes

FOOT_FORCES = tuple(
    f"{side}_fsr_{place}"
    for side in "lr"
    for place in ("front_left", "front_right", "rear_left", "rear_right")
)


class SimulatedRobot:
    """One robot of a world, through its own sensors and servos.

    The servos follow targets no faster than the joints' speed limits, and
    feed the targets' own speed forward.

    Attributes:
        name: Its name in the world.
        tick: Control period, in [s].
        sight: Sensor of the other robot, once there is one.
        eyes: Cameras and sonars, if it sees with those.
        truth: Its true state, for sensors that say so and for the record.
    """

    def __init__(
        self,
        world: World,
        name: str,
        description: RobotDescription,
        kinematics: LegKinematics,
        pose: Pose,
    ) -> None:
        """Stand a robot in the posture of its kinematics.

        Args:
            world: World that has it.
            name: Its name there.
            description: Its description.
            kinematics: Kinematics in standing posture.
            pose: Pose of the robot's odometry in the world.
        """
        self.world = world
        self.name = name
        self.tick = world.physics.tick
        self.sight: IdealLineOfSight | None = None
        self.eyes: Eyes | None = None
        model, data = world.model, world.data
        names = kinematics.joint_names
        joints = [model.joint(f"{name}/{n}") for n in names]
        self._qpos = np.array([j.qposadr[0] for j in joints])
        ids = np.array([model.actuator(f"{name}/{n}").id for n in names])
        self._ctrl = slice(int(ids[0]), int(ids[-1]) + 1)
        gains = model.actuator_gainprm[ids, 0]
        self._lead = -model.actuator_biasprm[ids, 2] / gains / self.tick
        limits = [description.speed_limits[n] for n in names]
        self._reach = np.array(limits) * self.tick
        self._gyro = self._sensor("gyro")
        self._accelerometer = self._sensor("accelerometer")
        first, last = (
            self._sensor(FOOT_FORCES[0]),
            self._sensor(FOOT_FORCES[-1]),
        )
        self._forces = slice(first.start, last.stop)
        sites = [model.site(f"{name}/{f}").id for f in FOOT_FORCES]
        self._corners = np.array(sites)
        root = model.body(f"{name}/{description.torso}")
        self._place(kinematics, pose, int(model.jnt_qposadr[root.jntadr[0]]))
        self._target = kinematics.joint_targets
        data.ctrl[self._ctrl] = self._target
        self.truth = TrueState(model, data, f"{name}/{description.torso}")

    def _sensor(self, sensor: str) -> slice:
        found = self.world.model.sensor(f"{self.name}/{sensor}")
        return slice(int(found.adr[0]), int(found.adr[0] + found.dim[0]))

    def _place(self, kinematics: LegKinematics, pose: Pose, at: int) -> None:
        posture = kinematics.posture
        qpos = self.world.data.qpos
        self.qpos_slice = slice(at, at + posture.size)
        qpos[self.qpos_slice] = posture
        qpos[at : at + 7] = place_free_body(posture[:7].tolist(), pose)

    def read(self) -> Measurement:
        """Read the sensors."""
        data = self.world.data
        sensors = data.sensordata
        now = self.world.time
        sighting = None if self.sight is None else self.sight.read(now)
        return Measurement(
            now,
            data.qpos[self._qpos],
            sensors[self._gyro].copy(),
            sensors[self._accelerometer].copy(),
            sensors[self._forces].copy(),
            sighting,
            () if self.eyes is None else self.eyes.read(now),
        )

    def write(self, joint_targets: Array) -> None:
        """Send joint targets, in [rad], to the servos. Shape (joints,)."""
        change = joint_targets - self._target
        np.minimum(change, self._reach, out=change)
        np.maximum(change, -self._reach, out=change)
        self._target = self._target + change
        change *= self._lead
        change += self._target
        self.world.data.ctrl[self._ctrl] = change

    def step(self) -> None:
        """Let time pass until the next control tick."""
        self.world.advance()

    def measured_zmp(self) -> tuple[float, float]:
        """Center of the foot forces in the world, in [m]; NaN in flight."""
        data = self.world.data
        forces = data.sensordata[self._forces]
        total = float(forces.sum())
        if total <= 0.0:
            return nan, nan
        corners = data.site_xpos[self._corners]
        x, y, _ = (forces @ corners / total).tolist()
        return x, y

    def close(self) -> None:
        """Let go of the eyes."""
        if self.eyes is not None:
            self.eyes.close()
