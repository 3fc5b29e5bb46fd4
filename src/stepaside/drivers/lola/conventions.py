"""Conversion between LoLA's conventions and those of control."""

import numpy as np

from ...core.poses import Array
from ...perception.images import SonarEcho
from ...perception.measurement import Measurement
from ..joint.frame_clock import COUNTER_RANGE
from ..joint.frames import Codec, JointCommand, JointFrame
from ..joint.joint_map import JointMap
from .lights import lights_for
from .lola_frames import (
    ActuatorFrame,
    SensorFrame,
    pack_actuators,
    unpack_sensors,
)
from .nao_joints import JOINT_COUNT

CHEST_BUTTON = 0  # index in Touch
FOOT_BUMPERS = (4, 5, 9, 10)  # likewise: left and right of each foot
NEWTONS_PER_KILOGRAM = 9.81  # foot sensors read in kilograms
SONARS = ("left", "right")
NO_ECHO = 2.55  # reading of a sonar without an echo, in [m]
MAX_ECHO = 2.545  # readings are float32, in which 2.55 is less, in [m]
ROOM_TEMPERATURE = 25.0  # in [degC]
# Serial numbers by which a simulated robot identifies itself. The fourth
# value of its battery is the number of the frame, modulo 2^16.
REAL_TIME = "stepaside-realtime-0"
LOCK_STEP = "stepaside-lockstep-0"
COUNTER = 3


def joint_frame_of(frame: SensorFrame) -> JointFrame:
    """Convert a sensor frame to the conventions of control.

    LoLA's accelerometer is minus the specific force on every axis: an
    upright robot reads z near -9.8 m/s^2. Its foot sensors are in [kg].
    """
    serial = frame.robot_config[0]
    return JointFrame(
        position=frame.position,
        stiffness=frame.stiffness,
        current=frame.current,
        temperature=frame.temperature,
        status=frame.status,
        accelerometer=-frame.accelerometer,
        gyroscope=frame.gyroscope,
        angles=frame.angles,
        foot_forces=NEWTONS_PER_KILOGRAM * frame.fsr,
        load=float(frame.fsr.sum()),
        echoes={
            name: echo if 0.0 < echo < MAX_ECHO else None
            for name, echo in zip(SONARS, frame.sonar, strict=True)
        },
        chest_pressed=frame.touch[CHEST_BUTTON] > 0.5,
        bumper_pressed=any(frame.touch[at] > 0.5 for at in FOOT_BUMPERS),
        charge=frame.battery[0],
        number=frame.battery[COUNTER],
        counted=serial in (LOCK_STEP, REAL_TIME),
        lock_step=serial == LOCK_STEP,
    )


def sensor_frame_of(
    measurement: Measurement,
    joints: JointMap,
    *,
    angles: tuple[float, float],
    stiffness: Array,
    count: int,
    chest_pressed: bool,
    lock_step: bool,
) -> SensorFrame:
    """Convert a measurement of a simulated robot to a sensor frame.

    Args:
        measurement: Measurement at this tick.
        joints: Map to the order of the description's joints.
        angles: Roll and pitch of the torso, in [rad].
        stiffness: Stiffness of the motors. Shape (25,).
        count: Number of the frame.
        chest_pressed: Whether the chest button is pressed.
        lock_step: Whether the simulation waits for answers.
    """
    nothing = np.zeros(JOINT_COUNT)
    echoes = dict.fromkeys(SONARS, NO_ECHO)
    for percept in measurement.percepts:
        if isinstance(percept, SonarEcho) and percept.distance is not None:
            echoes[percept.sonar] = percept.distance
    touch = [0.0] * 14
    touch[CHEST_BUTTON] = float(chest_pressed)
    body = LOCK_STEP if lock_step else REAL_TIME
    return SensorFrame(
        joints.to_motors(measurement.joint_positions, nothing),
        stiffness,
        nothing,
        np.full(JOINT_COUNT, ROOM_TEMPERATURE),
        (0,) * JOINT_COUNT,
        -measurement.accelerometer,
        measurement.gyro,
        angles,
        measurement.foot_forces / NEWTONS_PER_KILOGRAM,
        (echoes["left"], echoes["right"]),
        tuple(touch),
        (1.0, 0.0, 0.0, float(count % COUNTER_RANGE)),
        (body, "6.0.0", body, "6.0.0"),
    )


def actuator_frame_of(command: JointCommand) -> ActuatorFrame:
    """Convert a command to an actuator frame, with lights for the state."""
    lights = lights_for(
        command.state, sees=command.has_sighting, charge=command.charge
    )
    return ActuatorFrame(command.position, command.stiffness, lights)


CODEC = Codec(
    lambda data: joint_frame_of(unpack_sensors(data)),
    lambda command: pack_actuators(actuator_frame_of(command)),
)
