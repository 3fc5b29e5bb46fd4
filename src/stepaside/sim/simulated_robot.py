"""A simulated robot behind the interface that control moves."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ..core.constants import GRAVITY
from ..core.errors import ModelError
from ..core.poses import Array, Pose
from ..perception.measurement import Measurement
from ..robots.description import REMEDY, RobotDescription
from ..robots.leg_kinematics import LegKinematics
from .body_settings import BodySettings
from .ground_truth import TrueRobotState
from .ideal_sensors import IdealLineOfSight, IdealPose
from .push import Push, ScheduledPush
from .push_forces import PushApplier
from .sensor_errors import AveragedImu, SensorErrors
from .servos import IdealServos, RealisticServos
from .true_stance import StanceWatch, TrueStance
from .world import World, place_free_body

if TYPE_CHECKING:
    from .sensor_suite import SensorSuite


def motor_of(model: mujoco.MjModel, joint: int) -> int:
    """Number of the actuator that moves a joint, by the joint's number.

    Raises:
        ModelError: If none does, or several do.
    """
    moving = (model.actuator_trnid[:, 0] == joint) & (
        model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT
    )
    found = np.flatnonzero(moving)
    if len(found) != 1:
        raise ModelError(
            f"joint {model.joint(joint).name!r} must have one actuator, got "
            f"{len(found)}"
        )
    return int(found[0])


class SimulatedRobot:
    """One robot of a world, through its own sensors and servos.

    Attributes:
        name: Its name in the world.
        tick: Control period, in [s].
        sight: Ideal sensor of the other robot, if it has one.
        eyes: Cameras and sonars, if it sees with those.
        place: Ideal sensor of its place in a room, if it has one.
        truth: Its true state, for sensors that say so and for the record.
    """

    def __init__(
        self,
        world: World,
        name: str,
        description: RobotDescription,
        kinematics: LegKinematics,
        pose: Pose,
        body: BodySettings | None = None,
        generator: np.random.Generator | None = None,
        *,
        sight: IdealLineOfSight | None = None,
        eyes: SensorSuite | None = None,
        averages_imu: bool = False,
        truth: TrueRobotState | None = None,
        knows_place: bool = False,
    ) -> None:
        """Stand a robot in the posture of its kinematics.

        Args:
            world: World that has it.
            name: Its name there.
            description: Its description.
            kinematics: Kinematics in standing posture.
            pose: Pose of the robot's odometry in the world.
            body: How far it is from an ideal one; not at all by default.
            generator: Of its errors and noise.
            sight: Ideal sensor of the other, if it has one.
            eyes: Cameras and sonars, if it sees with those.
            averages_imu: Whether the IMU averages between readings, as real
                ones do, instead of sampling.
            truth: Its true state, if somebody watches that already.
            knows_place: Whether a sensor tells it its place in the room.
        """
        body = body or BodySettings()
        self.world = world
        self.name = name
        self.tick = world.physics.tick
        self.sight = sight
        self.eyes = eyes
        model, data = world.model, world.data
        names = kinematics.joint_names
        joints = [model.joint(f"{name}/{n}") for n in names]
        self._qpos = np.array([j.qposadr[0] for j in joints])
        ids = np.array([motor_of(model, j.id) for j in joints])
        speeds = np.array([description.speed_limits[n] for n in names])
        self.servos: IdealServos
        if body.has_ideal_servos:
            self.servos = IdealServos(model, data, ids, speeds, self.tick)
        else:
            legs = np.array([n in description.legs for n in names])
            servos = RealisticServos(
                model, data, ids, speeds, self.tick, body, body.backlash * legs
            )
            world.before_step.append(servos.before_step)
            self.servos = servos
        self._imu: AveragedImu | None = None
        self._errors: SensorErrors | None = None
        if generator is not None and body.has_sensor_errors:
            unit = description.game.get("force_unit", 1.0)
            self._errors = SensorErrors(body, generator, force_unit=unit)
        sensors = description.sensors
        self._gyro = self._sensor(sensors.gyro)
        self._accelerometer = self._sensor(sensors.accelerometer)
        # Views of the state, which stays where it is: slicing takes time.
        self._angles: Array = data.qpos
        self._sensed: Array = data.sensordata
        self._turning: Array = data.sensordata[self._gyro]
        self._pushing: Array = data.sensordata[self._accelerometer]
        pressing = [self._sensor(foot).start for foot in sensors.feet]
        self._pressing = np.array(pressing)
        sites = [model.site(f"{name}/{f}").id for f in sensors.feet]
        self._corners = np.array(sites)
        root = model.body(f"{name}/{description.torso}")
        self._place(kinematics, pose, int(model.jnt_qposadr[root.jntadr[0]]))
        self.servos.reset(kinematics.joint_targets)
        self._torso = root.id
        self.pusher: PushApplier | None = None
        self.truth = truth or TrueRobotState(model, data, root.name)
        self._stance = StanceWatch(model, data, name, description)
        self.place = IdealPose(self.truth) if knows_place else None
        if averages_imu:
            self._imu = AveragedImu(data, self._gyro, self._accelerometer)
            world.before_step.append(self._imu.before_step)

    def _sensor(self, sensor: str) -> slice:
        try:
            found = self.world.model.sensor(f"{self.name}/{sensor}")
        except KeyError:
            raise ModelError(
                f"the model of {self.name} has no sensor {sensor!r}; {REMEDY}"
            ) from None
        return slice(int(found.adr[0]), int(found.adr[0] + found.dim[0]))

    def _place(self, kinematics: LegKinematics, pose: Pose, at: int) -> None:
        posture = kinematics.posture
        qpos = self.world.data.qpos
        self.qpos_slice = slice(at, at + posture.size)
        qpos[self.qpos_slice] = posture
        qpos[at : at + 7] = place_free_body(posture[:7].tolist(), pose)

    @property
    def weight(self) -> float:
        """Of the whole robot, in [N]."""
        mass = self.world.model.body_subtreemass[self._torso]
        return GRAVITY * float(mass)

    def read(self) -> Measurement:
        """Read the sensors."""
        now = self.world.time
        sighting = None if self.sight is None else self.sight.read(now)
        angles = self._angles.take(self._qpos)
        if self._imu is None:
            gyro, force = self._turning.copy(), self._pushing.copy()
        else:
            gyro, force = self._imu.read()
        forces = self._sensed.take(self._pressing)
        if self._errors is not None:
            angles = self._errors.encoders(angles)
            gyro, force = self._errors.imu(gyro, force)
            forces = self._errors.foot_forces(forces)
        percepts = () if self.eyes is None else self.eyes.read(now)
        place = None if self.place is None else self.place.read()
        return Measurement(
            now, angles, gyro, force, forces, sighting, percepts, place
        )

    def write(self, joint_targets: Array) -> None:
        """Send joint targets, in [rad], to the servos. Shape (joints,)."""
        self.servos.write(joint_targets)

    def push(self, *pushes: Push) -> None:
        """Let somebody push the torso, now or later."""
        if self.pusher is None:
            world = self.world
            self.pusher = PushApplier(world.model, world.data, self._torso)
            world.before_step.append(self.pusher.before_step)
        for push in pushes:
            self.pusher.add(push)

    @property
    def stance(self) -> TrueStance:
        """How it truly stands at this instant."""
        return self._stance.read()

    @property
    def pushes(self) -> tuple[ScheduledPush, ...]:
        """Last pushes that began."""
        return () if self.pusher is None else tuple(self.pusher.given)

    def step(self) -> None:
        """Let time pass until the next control tick."""
        self.world.advance()

    @property
    def posture(self) -> Array:
        """Position and quaternion of the torso, then all joints; a copy."""
        posture: Array = self.world.data.qpos[self.qpos_slice].copy()
        return posture

    def measured_zmp(self) -> tuple[float, float]:
        """Center of the foot forces in the world, in [m]; NaN in flight."""
        data = self.world.data
        forces = self._sensed.take(self._pressing)
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
