"""Measurements of a robot's own sensors."""

from math import atan2, hypot, nan
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.player_identity import PlayerIdentity
from ..core.poses import Array, Pose

if TYPE_CHECKING:
    from .images import AnyPercept


class Sighting(NamedTuple):
    """Bearing and distance of an opponent, as measured by the robot.

    Attributes:
        time: Time of the observation, in [s].
        bearing: Horizontal direction of the opponent from the heading of the
            own torso, in [rad], positive leftward.
        distance: Horizontal distance to the opponent, in [m].
        target_id: Number of its track, where several people may approach; else
            0.
        settled: Whether it was observed long enough for its velocity.
        spread: Standard deviation of its position, in [m].
        identity: Name, role and team, from sensors that recognise players.
    """

    time: float
    bearing: float
    distance: float
    target_id: int = 0
    settled: bool = True
    spread: float = 0.0
    identity: PlayerIdentity | None = None

    @classmethod
    def of_position(cls, time: float, x: float, y: float) -> "Sighting":
        """Return the sighting of an opponent at a position.

        Args:
            time: Time of the observation, in [s].
            x: Position ahead of the own torso, in [m].
            y: Position to its left, in [m].
        """
        return cls(time, atan2(y, x), hypot(x, y))


class RobotStatus(NamedTuple):
    """State of the motors, the battery and the buttons of a robot.

    Attributes:
        stiffness: Stiffness that the motors have, from 0 to 1.
            Shape (joints,).
        temperature: Temperatures of the motors, in [degC]. Shape (joints,).
        heat: Status of each motor: 0 normal, 1 hot with reduced stiffness,
            2 reduced by more than 30 %, 3 critical without stiffness.
            Shape (joints,).
        current: Current of each motor over its stall current.
            Shape (joints,).
        charge: Charge of the battery, from 0 to 1.
        pressed: Whether the button is pressed that starts and stops a walk.
        bumped: Whether a foot bumper is pressed.
    """

    stiffness: Array
    temperature: Array
    heat: Array
    current: Array
    charge: float
    pressed: bool
    bumped: bool


NO_JOINTS = np.zeros(0)
NOWHERE = Pose(nan, nan, nan)
UNMEASURED = np.full(8, np.nan)  # forces on the corners of the soles
AT_REST = np.zeros(3)


class RobotState(NamedTuple):
    """State of a robot at one instant, as its sensors measure it.

    A simulated robot, a driver and a user's robot report it, and control
    reads it. All but the time has a default, as each robot measures a part
    of it: one that is driven by its joints at least joint angles and
    velocities, gyro, accelerometer and tilt; one that walks by itself its
    pose.

    Attributes:
        time: Time of the measurement, in [s], on the robot's clock.
        joint_positions: Joint angles from the encoders, in [rad], in the
            order of the joint targets. Shape (joints,).
        gyro: Angular velocity of the torso in its frame (x forward, y left,
            z up), in [rad/s]; its z component is NaN for a gyro with two
            axes. Shape (3,).
        accelerometer: Specific force at the torso in its frame, in [m/s^2]:
            about (0, 0, 9.8) when standing. Shape (3,).
        foot_forces: Normal force at the corners of the soles, in [N]:
            left front-left, front-right, rear-left, rear-right, then right.
            NaN from a robot without such sensors. Shape (8,).
        sighting: Latest sighting of the opponent, if there is one other
            player and it is seen.
        percepts: Images and echoes that arrived since the last tick.
        pose_in_room: CoM and heading of the torso in the frame of a known
            room, from a localisation sensor; None without one.
        joint_velocities: Joint velocities, in [rad/s], in the order of the
            joint angles, from a body that measures them; else None.
            Shape (joints,).
        players: Latest sightings of all other players, with their
            identities, from a sensor that recognises them.
        latest_gyro: Angular velocity of the torso at this instant, in
            [rad/s], where ``gyro`` is a mean since the last tick; None where
            it is the only reading. Shape (3,).
        tilt: Roll and pitch of the torso, in [rad], from a robot whose IMU
            estimates them; else None.
        pose: Pose in the odometry of a robot that walks by itself; else
            NaN.
        hindrance: Reason why the robot must not walk now; empty if it may.
        status: State of motors, battery and button, from a robot that has a
            button and reports them; else None.
    """

    time: float
    joint_positions: Array = NO_JOINTS
    gyro: Array = AT_REST
    accelerometer: Array = AT_REST
    foot_forces: Array = UNMEASURED
    sighting: Sighting | None = None
    percepts: tuple["AnyPercept", ...] = ()
    pose_in_room: Pose | None = None
    joint_velocities: Array | None = None
    players: tuple[Sighting, ...] = ()
    latest_gyro: Array | None = None
    tilt: tuple[float, float] | None = None
    pose: Pose = NOWHERE
    hindrance: str = ""
    status: RobotStatus | None = None
