"""Sensor and actuator frames of LoLA."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from ...core.poses import Array
from .wire import (
    ACTUATOR_FIELDS,
    LIGHTS,
    SENSOR_BYTES,
    SENSOR_FIELDS,
    WireError,
    check_map,
    decode,
    encode,
)

NO_LIGHTS: Mapping[str, tuple[float, ...]] = MappingProxyType({})


class SensorFrame(NamedTuple):
    """Sensor frame of one tick of 12 ms, in LoLA's conventions.

    Attributes:
        position: Joint angles, in [rad]. Shape (25,).
        stiffness: Stiffness, from 0 to 1. Shape (25,).
        current: Motor currents, in [A]. Shape (25,).
        temperature: Motor temperatures, in [degC]. Shape (25,).
        status: Status of each motor: 0 normal, 1 hot with reduced
            stiffness, 2 reduced by more than 30 %, 3 critical without
            stiffness.
        accelerometer: Minus the specific force, in [m/s^2]. Shape (3,).
        gyroscope: Angular velocity, in [rad/s]. Shape (3,).
        angles: Roll and pitch of the torso, in [rad].
        fsr: Foot forces as masses, in [kg]; left front-left, front-right,
            rear-left, rear-right, then right. Shape (8,).
        sonar: Distances of the left and right sonar, in [m].
        touch: The 14 buttons, 1 where pressed; the chest's is the first.
        battery: Charge from 0 to 1, then values whose order differs
            between published sources.
        robot_config: Serial number and version of body, then of head.
    """

    position: Array
    stiffness: Array
    current: Array
    temperature: Array
    status: tuple[int, ...]
    accelerometer: Array
    gyroscope: Array
    angles: tuple[float, float]
    fsr: Array
    sonar: tuple[float, float]
    touch: tuple[float, ...]
    battery: tuple[float, float, float, float]
    robot_config: tuple[str, str, str, str]


class ActuatorFrame(NamedTuple):
    """Command of a client; None leaves a value unchanged.

    Attributes:
        position: Joint targets, in [rad]. Shape (25,).
        stiffness: Stiffness, from 0 to 1. Shape (25,).
        lights: Brightness of lights, from 0 to 1, by key.
        sonar: Whether the left and the right sonar are on.
    """

    position: Array | None = None
    stiffness: Array | None = None
    lights: Mapping[str, tuple[float, ...]] = NO_LIGHTS
    sonar: tuple[bool, bool] | None = None


def pack_sensors(frame: SensorFrame) -> bytes:
    """Encode a sensor frame, which always has 896 bytes.

    Raises:
        WireError: If a value has the wrong length or is not finite, or the
            texts have the wrong length.
    """
    values = {
        field.key: value.tolist() if isinstance(value, np.ndarray) else value
        for field, value in zip(SENSOR_FIELDS, frame, strict=True)
    }
    data = encode(values, SENSOR_FIELDS)
    if len(data) != SENSOR_BYTES:
        raise WireError(
            f"a sensor frame must have {SENSOR_BYTES} bytes, got {len(data)}; "
            "RobotConfig must have 20, 5, 20 and 5 characters"
        )
    return data


def unpack_sensors(data: bytes) -> SensorFrame:
    """Decode a sensor frame.

    Raises:
        WireError: If the bytes are not a valid sensor frame.
    """
    if len(data) != SENSOR_BYTES:
        raise WireError(
            f"a sensor frame must have {SENSOR_BYTES} bytes, got {len(data)}"
        )
    values = check_map(decode(data), SENSOR_FIELDS)
    position, stiffness, current, temperature = (
        np.array(values[field.key]) for field in SENSOR_FIELDS[:4]
    )
    roll, pitch = values["Angles"]
    left, right = values["Sonar"]
    charge, second, third, fourth = values["Battery"]
    body, body_version, head, head_version = values["RobotConfig"]
    return SensorFrame(
        position,
        stiffness,
        current,
        temperature,
        tuple(values["Status"]),
        np.array(values["Accelerometer"]),
        np.array(values["Gyroscope"]),
        (roll, pitch),
        np.array(values["FSR"]),
        (left, right),
        tuple(values["Touch"]),
        (charge, second, third, fourth),
        (body, body_version, head, head_version),
    )


def pack_actuators(frame: ActuatorFrame) -> bytes:
    """Encode an actuator frame, which has 786 bytes with all keys.

    Raises:
        WireError: If a value has the wrong length or is not finite, or a
            light is unknown.
    """
    values: dict[str, object] = {}
    if frame.position is not None:
        values["Position"] = frame.position.tolist()
    if frame.stiffness is not None:
        values["Stiffness"] = frame.stiffness.tolist()
    for key, light in frame.lights.items():
        if key not in LIGHTS:
            raise WireError(
                f"light must be one of {', '.join(sorted(LIGHTS))}, got "
                f"{key!r:.40}"
            )
        values[key] = light
    if frame.sonar is not None:
        values["Sonar"] = frame.sonar
    return encode(values, ACTUATOR_FIELDS)


def clip_actuators(decoded: object) -> ActuatorFrame:
    """Convert a decoded object to an actuator frame.

    Stiffness and lights are clipped to their range, as some peers send
    uninitialised memory.

    Raises:
        WireError: If it is not a valid actuator frame.
    """
    values = check_map(decoded, ACTUATOR_FIELDS, partial=True)
    position, stiffness = values.get("Position"), values.get("Stiffness")
    sonar = values.get("Sonar")
    return ActuatorFrame(
        None if position is None else np.array(position),
        None if stiffness is None else np.clip(stiffness, 0.0, 1.0),
        {
            key: tuple(min(max(entry, 0.0), 1.0) for entry in entries)
            for key, entries in values.items()
            if key in LIGHTS
        },
        None if sonar is None else (sonar[0], sonar[1]),
    )
