"""From LoLA's conventions to ours, and back."""

import numpy as np

from ...core.poses import Array
from ...perception.images import Percept, SonarEcho
from ...perception.measurement import Measurement, Sighting
from ..joint.frames import SensorFrame
from ..joint.joint_map import JOINT_COUNT, JointMap

CHEST_BUTTON = 0  # in the order of Touch
FOOT_BUMPERS = (4, 5, 9, 10)  # likewise: left and right of either foot
NEWTONS_PER_KILOGRAM = 9.81  # foot sensors weigh
SONARS = ("left", "right")
HEARD = (0.0, 2.55)  # echoes beyond this mean that all was silent, in [m]
ROOM_TEMPERATURE = 25.0  # in [degC]
# How a simulated robot says what it is, where a real one has its number.
# Its fourth battery value counts frames, modulo 2^16.
REAL_TIME = "stepaside-realtime-0"
LOCK_STEP = "stepaside-lockstep-0"
COUNTER = 3
COUNTER_RANGE = 1 << 16


def measurement_of(
    frame: SensorFrame,
    joints: JointMap,
    time: float,
    sighting: Sighting | None = None,
) -> Measurement:
    """What a sensor frame says, in the conventions of control.

    LoLA's accelerometer is minus the specific force on every axis: an
    upright robot reads z near -9.8. Its foot sensors weigh in [kg].

    Args:
        frame: The frame.
        joints: Order of the description's joints.
        time: Time of the frame, in [s].
        sighting: Newest sighting of the other robot, if there is any.
    """
    near, far = HEARD
    echoes: tuple[Percept, ...] = tuple(
        SonarEcho(time, name, heard if near < heard < far else None)
        for name, heard in zip(SONARS, frame.sonar, strict=True)
    )
    return Measurement(
        time,
        joints.from_lola(frame.position),
        frame.gyroscope,
        -frame.accelerometer,
        NEWTONS_PER_KILOGRAM * frame.fsr,
        sighting,
        echoes,
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
    """What a simulated robot says in LoLA's conventions.

    Args:
        measurement: What its sensors give.
        joints: Order of the description's joints.
        angles: Roll and pitch of the torso, in [rad].
        stiffness: Of its motors. Shape (25,).
        count: Number of the frame.
        chest_pressed: Whether somebody presses the chest button.
        lock_step: Whether its world waits for answers.
    """
    nothing = np.zeros(JOINT_COUNT)
    heard = dict.fromkeys(SONARS, HEARD[1])
    for percept in measurement.percepts:
        if isinstance(percept, SonarEcho) and percept.distance is not None:
            heard[percept.sonar] = percept.distance
    touch = [0.0] * 14
    touch[CHEST_BUTTON] = float(chest_pressed)
    body = LOCK_STEP if lock_step else REAL_TIME
    return SensorFrame(
        joints.to_lola(measurement.joint_positions, nothing),
        stiffness,
        nothing,
        np.full(JOINT_COUNT, ROOM_TEMPERATURE),
        (0,) * JOINT_COUNT,
        -measurement.accelerometer,
        measurement.gyro,
        angles,
        measurement.foot_forces / NEWTONS_PER_KILOGRAM,
        (heard["left"], heard["right"]),
        tuple(touch),
        (1.0, 0.0, 0.0, float(count % COUNTER_RANGE)),
        (body, "6.0.0", body, "6.0.0"),
    )
