"""Frames that a driver exchanges with the joint control of any robot."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from ...core.errors import StepAsideError
from ...core.poses import Array
from ...perception.images import Percept, SonarEcho
from ...perception.measurement import Measurement, Sighting
from .joint_map import JointMap
from .safety_state_machine import RobotState


class FrameError(StepAsideError, ValueError):
    """Data that are not a valid sensor frame."""


class JointFrame(NamedTuple):
    """Sensor frame of one tick, in the conventions of control.

    Attributes:
        position: Joint angles, in [rad]. Shape (motors,).
        stiffness: Stiffness, from 0 to 1. Shape (motors,).
        current: Motor currents, in [A]. Shape (motors,).
        temperature: Motor temperatures, in [degC]. Shape (motors,).
        status: Status of each motor: 0 normal, 1 hot with reduced
            stiffness, 2 reduced by more than 30 %, 3 critical without
            stiffness.
        accelerometer: Specific force in the torso frame, in [m/s^2].
            Shape (3,).
        gyroscope: Angular velocity in the torso frame, in [rad/s].
            Shape (3,).
        angles: Roll and pitch of the torso by the robot, in [rad].
        foot_forces: Forces on the foot sensors, in [N]. Shape (sensors,).
        load: Sum of all foot sensors, in [kg].
        echoes: Distances of the sonars, in [m], by name; None without an
            echo.
        chest_pressed: Whether the chest button is pressed.
        bumper_pressed: Whether a foot bumper is pressed.
        charge: Charge of the battery, from 0 to 1.
        number: Number of the frame, modulo ``COUNTER_RANGE``, if counted.
        counted: Whether the robot numbers its frames.
        lock_step: Whether the robot is simulated and waits for answers.
        velocity: Joint velocities, in [rad/s], from a robot that measures
            them; else None. Shape (motors,).
        hindrance: Reason why the robot must not walk now; empty if it may.
    """

    position: Array
    stiffness: Array
    current: Array
    temperature: Array
    status: tuple[int, ...]
    accelerometer: Array
    gyroscope: Array
    angles: tuple[float, float]
    foot_forces: Array
    load: float
    echoes: Mapping[str, float | None]
    chest_pressed: bool
    bumper_pressed: bool
    charge: float
    number: float
    counted: bool
    lock_step: bool
    velocity: Array | None = None
    hindrance: str = ""


class MotorGains(NamedTuple):
    """Gains of the torque of each motor, from target to angle.

    Attributes:
        stiffness: In [N m/rad]. Shape (motors,).
        damping: In [N m s/rad]. Shape (motors,).
    """

    stiffness: Array
    damping: Array


class JointCommand(NamedTuple):
    """Command of one tick; None leaves a value unchanged.

    Attributes:
        position: Joint targets, in [rad]. Shape (motors,).
        stiffness: Stiffness, from 0 to 1. Shape (motors,).
        state: State of the robot, for its display.
        has_sighting: Whether there is a sighting of the opponent, likewise.
        charge: Charge of the battery, from 0 to 1, likewise.
        gains: Gains of the motors while control moves them; None for the
            robot's own.
    """

    position: Array | None
    stiffness: Array | None
    state: RobotState
    has_sighting: bool
    charge: float
    gains: MotorGains | None = None


class Codec(NamedTuple):
    """Conversion between frames and what a link carries.

    Attributes:
        read: Function that decodes a sensor frame, or raises FrameError.
        write: Function that encodes a command.
    """

    read: Callable[[Any], JointFrame]
    write: Callable[[JointCommand], Any]


def measurement_of(
    frame: JointFrame,
    joints: JointMap,
    time: float,
    sighting: Sighting | None = None,
) -> Measurement:
    """Convert a sensor frame to a measurement.

    Args:
        frame: Sensor frame.
        joints: Map to the order of the description's joints.
        time: Time of the frame, in [s].
        sighting: Newest sighting of the opponent, if there is one.
    """
    echoes: tuple[Percept, ...] = tuple(
        SonarEcho(time, name, distance)
        for name, distance in frame.echoes.items()
    )
    return Measurement(
        time,
        joints.from_motors(frame.position),
        frame.gyroscope,
        frame.accelerometer,
        frame.foot_forces,
        sighting,
        echoes,
        joint_velocities=None
        if frame.velocity is None
        else joints.from_motors(frame.velocity),
        tilt=frame.angles,
    )
