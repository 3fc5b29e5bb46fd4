"""Simulated robot behind the body interface of control."""

from __future__ import annotations

from math import atan2, nan
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from ..core.constants import GRAVITY
from ..core.errors import ModelError
from ..core.poses import Array, Pose
from ..core.rotations import angles_of
from ..perception.measurement import RobotState, Sighting
from ..robots.description import REMEDY, RobotDescription
from .body_settings import IDEAL, BodySettings
from .ground_truth import IdealLineOfSight, TrueRobotState, TrueStance
from .servos import JointGains, Servos, set_joint_gains
from .world import World, transform_free_joint

EMPTY = np.empty(0)

if TYPE_CHECKING:
    from ..locomotion.policy.policy_legs import InitialPosture
    from ..robots.leg_kinematics import LegKinematics
    from .body_errors import SensorErrors, StrapdownImu
    from .push import Push, PushApplier, ScheduledPush
    from .ranging import Lidar
    from .sensor_suite import SensorSuite


def centers_of_pressure(forces: Array, corners: Array) -> Array:
    """Return the centres (..., 2) of forces (..., 8) at corners (..., 8, 3).

    NaN where there is no force.
    """
    total = forces.sum(axis=-1, keepdims=True)
    weighted = (forces[..., None] * corners[..., :2]).sum(axis=-2)
    pressed = total > 0.0
    return np.where(pressed, weighted / np.where(pressed, total, 1.0), nan)


class SimulatedRobot:
    """Robot in a world, with its sensors and servos."""

    def __init__(
        self,
        world: World,
        name: str,
        description: RobotDescription,
        kinematics: LegKinematics | InitialPosture,
        pose: Pose,
        body: BodySettings = IDEAL,
        *,
        gains: JointGains | None = None,
        generator: np.random.Generator | None = None,
        integrates_imu: bool = False,
        sights: tuple[IdealLineOfSight, ...] = (),
        eyes: SensorSuite | Lidar | None = None,
        truth: TrueRobotState | None = None,
        knows_pose: bool = False,
    ) -> None:
        """Place a robot in the posture of its kinematics at a pose.

        Gains are of a body that is driven by joint torques. The generator
        draws errors of sensors, which are exact without one. An IMU on the
        body with the free joint may give the change of orientation and
        velocity between readings, as real ones do, instead of samples. An
        ideal sensor of the pose in a room replaces localisation.
        """
        self.world, self.name, self.eyes = world, name, eyes
        self.tick, self._sights = world.physics.tick, sights
        model, data = world.model, world.data
        self.joint_names = names = kinematics.joint_names
        joints = [model.joint(f"{name}/{n}") for n in names]
        self._qpos = np.array([j.qposadr[0] for j in joints])
        self._dofs = None
        moved = model.actuator_trnid[:, 0].tolist()
        motors = np.array([moved.index(j.id) for j in joints])
        if gains is not None:
            set_joint_gains(model, motors, names, gains)
            self._dofs = np.array([j.dofadr[0] for j in joints])
        self.servos = Servos(
            *(model, data, motors),
            np.array([description.speed_limits[n] for n in names]),
            *(self.tick, body),
            body.backlash * np.array([n in description.legs for n in names]),
            feedforward=gains is None,
            others=world.servos,
        )
        if not self.servos.ideal:
            world.servos = self.servos
        self.servos.reset(kinematics.joint_targets)
        self._find_sensors(description)
        root = model.body(f"{name}/{description.torso}")
        posture, free = kinematics.posture, int(root.jntadr[0])
        at, dof = int(model.jnt_qposadr[free]), int(model.jnt_dofadr[free])
        self.qpos_slice = slice(at, at + posture.size)
        data.qpos[self.qpos_slice] = posture
        placed = transform_free_joint(posture[:7].tolist(), pose)
        data.qpos[at : at + 7] = placed
        # A quaternion has three degrees of freedom.
        self._dof_slice = slice(dof, dof + posture.size - 1)
        self._torso = root.id
        self.pusher: PushApplier | None = None
        self.truth = truth or TrueRobotState(model, data, root.name)
        self._knows_pose, self._sites = knows_pose, data.site_xpos
        self._positions, self._velocities = data.qpos, data.qvel  # views
        self._motion = {  # views
            "com": self.truth.position_com_in_world,
            "origin": self.truth.origin_torso_in_world,
            "axes": self.truth.axes_torso_in_world,
            "qpos": data.qpos[self.qpos_slice],
        }
        self._errors: SensorErrors | None = None
        self._imu: StrapdownImu | None = None
        if generator is None or body == IDEAL and not integrates_imu:
            return
        means = None
        if body.has_sensor_errors:
            from .body_errors import SensorErrors

            unit = description.game.force_unit
            self._errors = SensorErrors(
                body, generator, len(names), force_unit=unit
            )
            means = self._errors.exact[:9].reshape(3, 3)
        gyro = model.sensor(f"{name}/{description.sensors.gyro}").id
        site = int(model.sensor_objid[gyro])
        if integrates_imu and model.site_bodyid[site] == root.id:
            from .body_errors import StrapdownImu

            self._imu = StrapdownImu(model, data, root.id, site, means)

    def _find_sensors(self, description: RobotDescription) -> None:
        """Find the sensors of the model."""
        model, sensors = self.world.model, description.sensors
        self._gyro = self._sensor(sensors.gyro)
        self._accelerometer = self._sensor(sensors.accelerometer)
        pressing = [self._sensor(foot).start for foot in sensors.feet]
        self._force_addresses = np.array(pressing)
        sites = [model.site(f"{self.name}/{f}").id for f in sensors.feet]
        self._corner_sites = np.array(sites)
        feet = description.left_foot, description.right_foot
        self._soles = [model.site(f"{self.name}/{foot}").id for foot in feet]

    def _sensor(self, sensor: str) -> slice:
        try:
            found = self.world.model.sensor(f"{self.name}/{sensor}")
        except KeyError:
            raise ModelError(
                f"the model of {self.name} has no sensor {sensor!r}; {REMEDY}"
            ) from None
        return slice(int(found.adr[0]), int(found.adr[0] + found.dim[0]))

    @property
    def weight(self) -> float:
        """Weight of the robot, in [N]."""
        mass = self.world.model.body_subtreemass[self._torso]
        return GRAVITY * float(mass)

    def read(self, *, sees: bool = True, feels: bool = True) -> RobotState:
        """Read the sensors, or without sightings, or without the body."""
        now = self.world.time
        seen = self._sightings(now) if sees else ()
        first = seen[0] if seen and len(self._sights) == 1 else None
        percepts = () if self.eyes is None else self.eyes.read(now)
        place = self._pose_in_room() if self._knows_pose else None
        if not feels:
            return RobotState(
                now, *(EMPTY,) * 4, first, percepts, place, players=seen
            )
        sensors = self.world.sensordata
        angles = self._positions[self._qpos]
        forces = sensors[self._force_addresses]
        velocities = latest = None
        if self._dofs is not None:
            velocities = self._velocities[self._dofs]
        if (errors := self._errors) is None and self._imu is not None:
            gyro, force, latest = self._imu.read().copy()
        elif errors is None:
            gyro = sensors[self._gyro].copy()
            force = sensors[self._accelerometer].copy()
        else:
            errors.exact[9:17], errors.exact[17:] = forces, angles
            if self._imu is None:
                errors.exact[:3] = errors.exact[6:9] = sensors[self._gyro]
                errors.exact[3:6] = sensors[self._accelerometer]
            else:
                self._imu.read()
            angles, gyro, force, now_turns, forces = errors.readings()
            latest = None if self._imu is None else now_turns
            if velocities is not None:
                velocities = errors.velocities(velocities, angles, now)
        felt = angles, gyro, force, forces
        return RobotState(
            now, *felt, first, percepts, place, velocities, seen, latest
        )

    def _pose_in_room(self) -> Pose:
        """Return the CoM on the floor, [m], and the torso heading, [rad]."""
        x, y, _ = self.truth.position_com_in_world.tolist()
        return Pose(x, y, self.truth.heading_in_world)

    def _sightings(self, now: float) -> tuple[Sighting, ...]:
        """Return the latest sightings of all other players."""
        read = (sight.read(now) for sight in self._sights)
        return tuple(seen for seen in read if seen is not None)

    @property
    def sees_exactly(self) -> bool:
        """Whether all its sightings are ideal and without any error."""
        return (
            self.eyes is None
            and bool(self._sights)
            and all(sight.is_exact for sight in self._sights)
        )

    def write(self, joint_targets: Array) -> None:
        """Send joint targets, in [rad], to the servos. Shape (joints,)."""
        self.servos.write(joint_targets)

    def push(self, *pushes: Push) -> None:
        """Schedule pushes of the torso."""
        if self.pusher is None:
            from .push import PushApplier

            world = self.world
            self.pusher = PushApplier(world.model, world.data, self._torso)
            world.before_step.append(self.pusher.before_step)
        for push in pushes:
            self.pusher.add(push)

    @property
    def stance(self) -> TrueStance:
        """True stance at this instant."""
        model, data = self.world.model, self.world.data
        mujoco.mj_subtreeVel(model, data)
        vx, vy, _ = data.subtree_linvel[self._torso].tolist()
        roll, pitch, _ = angles_of(data.xmat[self._torso].reshape(3, 3))
        soles = []
        for site in self._soles:
            x, y, _ = data.site_xpos[site].tolist()
            frame = data.site_xmat[site]
            soles.append(Pose(x, y, atan2(frame[3], frame[0])))
        return TrueStance((vx, vy), (roll, pitch), *soles)

    @property
    def pushes(self) -> tuple[ScheduledPush, ...]:
        """Most recent pushes that have started."""
        return () if self.pusher is None else tuple(self.pusher.given)

    def step(self) -> None:
        """Advance the world to the next control tick."""
        self.world.advance()

    @property
    def foot_forces(self) -> Array:
        """Exact forces of the left foot, then of the right one, in [N]."""
        forces: Array = self.world.sensordata[self._force_addresses]
        return forces

    def measured_zmp(self) -> Array:
        """Return the centre of pressure in the world, [m]; NaN in flight."""
        corners = self.world.data.site_xpos[self._corner_sites]
        return centers_of_pressure(self.foot_forces, corners)

    def motion(self) -> dict[str, Array]:
        """Return what :meth:`trajectory` computes a motion from, now."""
        corners = self._sites.take(self._corner_sites, axis=0)
        return self._motion | {"forces": self.foot_forces, "corners": corners}

    def trajectory(self, samples: dict[str, Array]) -> dict[str, Array]:
        """Return samples of :meth:`motion` by name in a trajectory."""
        raw = ("com", "origin", "axes", "forces", "corners")
        com, origin, axes, forces, corners = map(samples.pop, raw)
        place, torso = self.truth.places(com, origin, axes)
        zmp = centers_of_pressure(forces, corners.reshape(-1, 8, 3))
        found = {"com": com.copy(), "place": place, "torso": torso, "zmp": zmp}
        return samples | found

    def signals(self, joint_targets: Array) -> dict[str, Array]:
        """Return exact sensors and efforts, by name in a record.

        Joint targets are put in the order of qpos.
        """
        data, dofs = self.world.data, self._dof_slice
        start, end = self.qpos_slice.start + 7, self.qpos_slice.stop
        targets = np.full(end - start, nan)
        targets[self._qpos - start] = joint_targets
        velocity, effort = data.qvel[dofs], data.qfrc_actuator[dofs]
        force = self.world.sensordata[self._accelerometer]
        if data.time == 0.0:  # the soles do not press on the floor yet
            axes = data.xmat[self._torso].reshape(3, 3)
            force = -(self.world.model.opt.gravity @ axes)
        return {
            "torso_velocity": velocity[:6],
            "joint_velocity": velocity[6:],
            "joint_effort": effort[6:],
            "joint_targets": targets,
            "gyro": self.world.sensordata[self._gyro],
            "accelerometer": force,
            "foot_forces": self.foot_forces,
        }

    def close(self) -> None:
        """Release the graphics of the cameras."""
        if self.eyes is not None:
            self.eyes.close()
