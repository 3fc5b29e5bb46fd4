"""NAO in a MuJoCo loop of its own, driven by its joints.

A stand-in for any simulator::

    stepaside play mujoco_robot.py:MujocoRobot --set delay_ticks=0
"""

from math import asin, atan2, cos, hypot, sin

import mujoco
import numpy as np

import stepaside as sa

NAO = sa.load_robot("nao")
STANCE = 0.32  # height of the torso above the floor, in [m]
PERSON, SPEED = (1.2, 0.3), 0.1  # begins at, in [m], and walks at, in [m/s]
NEAREST = 0.4  # distance at which the person stands, in [m]
FEET = [
    f"{side}_fsr_{end}_{edge}"
    for side in "lr"
    for end in ("front", "rear")
    for edge in ("left", "right")
]


class MujocoRobot(sa.JointRobot):
    """NAO in a simulation, which a person approaches."""

    tick = 0.012
    paced = False  # the simulation runs as fast as it is answered
    joints = sa.load_tree(NAO).motors
    gains = dict.fromkeys(joints, (200.0, 10.0))

    def open(self) -> None:
        """Compile the model, and stand on the floor."""
        spec = NAO.spec()
        spec.option.timestep = 0.002
        plane = mujoco.mjtGeom.mjGEOM_PLANE
        spec.worldbody.add_geom(type=plane, size=[20, 20, 0.1])
        self.model = model = spec.compile()
        self.data = data = mujoco.MjData(model)
        actuators = [model.actuator(name).id for name in self.joints]
        joints = model.actuator_trnid[actuators, 0]
        self.actuators = np.array(actuators)
        self.qpos = model.jnt_qposadr[joints]
        self.qvel = model.jnt_dofadr[joints]
        data.qpos[2] = STANCE
        stance = [NAO.standing.get(name, 0.0) for name in self.joints]
        data.qpos[self.qpos] = data.ctrl[self.actuators] = stance
        mujoco.mj_forward(model, data)
        soles = [data.site(name).xpos[2] for name in FEET]
        data.qpos[2] -= min(soles)
        self.person = np.array(PERSON)

    def listen(self) -> sa.RobotState:
        """Go on by one tick, and return the new state."""
        data, steps = self.data, round(self.tick / self.model.opt.timestep)
        mujoco.mj_step(self.model, data, steps)
        mujoco.mj_rnePostConstraint(self.model, data)
        torso = data.body(NAO.torso)
        rotation = torso.xmat.reshape(3, 3)
        heading = atan2(rotation[1, 0], rotation[0, 0])
        x, y = self.walk_person(torso.xpos[:2])
        ahead = cos(heading) * x + sin(heading) * y
        left = cos(heading) * y - sin(heading) * x
        return sa.RobotState(
            data.time,
            data.qpos[self.qpos],
            data.sensor("gyro").data,
            data.sensor("accelerometer").data,
            np.array([data.sensor(foot).data[0] for foot in FEET]),
            sa.Sighting.of_position(data.time, ahead, left),
            joint_velocities=data.qvel[self.qvel],
            tilt=(
                atan2(rotation[2, 1], rotation[2, 2]),
                -asin(rotation[2, 0]),
            ),
        )

    def walk_person(self, robot: np.ndarray) -> np.ndarray:
        """Walk the person by one tick; return its place from the robot."""
        way = robot - self.person
        distance = hypot(*way)
        if distance > NEAREST:
            self.person += self.tick * SPEED * way / distance
        place: np.ndarray = self.person - robot
        return place

    def command(self, targets: sa.JointTargets) -> None:
        """Set targets and gains of all joints."""
        model, at = self.model, self.actuators
        self.data.ctrl[at] = targets.angles
        model.actuator_gainprm[at, 0] = targets.stiffness
        model.actuator_biasprm[at, 1] = -targets.stiffness
        model.actuator_biasprm[at, 2] = -targets.damping

    def release(self) -> None:
        """Damp the joints."""
        none = np.zeros(len(self.joints))
        self.command(sa.JointTargets(none, none, none + 1.0))
