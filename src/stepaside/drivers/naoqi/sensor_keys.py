"""Keys of ALMemory for a robot's joints and sensors.

Signs and units are those of LoLA's frames: the accelerometer of an upright
robot reads z near -9.8 m/s^2, and foot sensors are in [kg].
"""

from collections.abc import Sequence
from math import isfinite, nan
from typing import Any

import numpy as np

from ..lola.conventions import (
    CHEST_BUTTON,
    COUNTER,
    FOOT_BUMPERS,
    LOCK_STEP,
    REAL_TIME,
)
from ..lola.lola_frames import SensorFrame
from ..lola.nao_joints import NAMES
from ..lola.wire import WireError

DEVICES = "Device/SubDeviceList"
# Key of a simulated robot: number of the frame, and 1 in lock step.
FRAME = "Stepaside/Frame"
_AXES = "XYZ"
TOUCH_COUNT = 14  # touch values of a frame
_CORNERS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")


def _joint_keys(quantity: str) -> list[str]:
    return [f"{DEVICES}/{name}/{quantity}/Value" for name in NAMES]


def _inertial(name: str, axes: str = _AXES) -> list[str]:
    return [
        f"{DEVICES}/InertialSensor/{name}{axis}/Sensor/Value" for axis in axes
    ]


GROUPS: dict[str, list[str]] = {
    "position": _joint_keys("Position/Sensor"),
    "stiffness": _joint_keys("Hardness/Actuator"),
    "temperature": _joint_keys("Temperature/Sensor"),
    "status": [f"{DEVICES}/{n}/Temperature/Sensor/Status" for n in NAMES],
    "accelerometer": _inertial("Accelerometer"),
    "gyroscope": _inertial("Gyroscope"),
    "angles": _inertial("Angle", "XY"),
    "fsr": [
        f"{DEVICES}/{side}Foot/FSR/{corner}/Sensor/Value"
        for side in "LR"
        for corner in _CORNERS
    ],
    "sonar": [f"{DEVICES}/US/{s}/Sensor/Value" for s in ("Left", "Right")],
    "chest": [f"{DEVICES}/ChestBoard/Button/Sensor/Value"],
    "bumper": [
        f"{DEVICES}/{side}Foot/Bumper/{half}/Sensor/Value"
        for side in "LR"
        for half in ("Left", "Right")
    ],
    "current": _joint_keys("ElectricCurrent/Sensor"),
    "charge": [f"{DEVICES}/Battery/Charge/Sensor/Value"],
}
KEYS = [key for keys in GROUPS.values() for key in keys]
SLOW = ("stiffness", "current", "temperature", "status", "charge")
# Keys that are read at every tick: half of all.
QUICK_KEYS = [
    key for name, keys in GROUPS.items() if name not in SLOW for key in keys
]
OPTIONAL_JOINTS = ("LWristYaw", "RWristYaw", "LHand", "RHand")
# Values of groups that a robot may lack.
DEFAULTS = {
    "status": 0.0,
    "temperature": 0.0,
    "current": 0.0,
    "bumper": 0.0,
    "sonar": 2.55,
    "charge": 1.0,
}
# Names of the inertial unit's values on NAO V3 and V4, whose gyro has two
# axes.
ACCELEROMETER, GYROSCOPE = GROUPS["accelerometer"], GROUPS["gyroscope"]
OLDER = dict(
    zip(
        [*ACCELEROMETER, *GYROSCOPE[:2]],
        [*_inertial("Acc"), *_inertial("Gyr", "XY")],
        strict=True,
    )
)


def values_of(frame: SensorFrame) -> dict[str, float]:
    """Return the values of a frame by key, as in ALMemory."""
    groups: dict[str, Sequence[float]] = {
        "position": frame.position.tolist(),
        "stiffness": frame.stiffness.tolist(),
        "temperature": frame.temperature.tolist(),
        "status": [float(status) for status in frame.status],
        "accelerometer": frame.accelerometer.tolist(),
        "gyroscope": frame.gyroscope.tolist(),
        "angles": frame.angles,
        "fsr": frame.fsr.tolist(),
        "sonar": frame.sonar,
        "chest": [frame.touch[CHEST_BUTTON]],
        "bumper": [frame.touch[at] for at in FOOT_BUMPERS],
        "current": frame.current.tolist(),
        "charge": [frame.battery[0]],
    }
    return {
        key: value
        for name, keys in GROUPS.items()
        for key, value in zip(keys, groups[name], strict=True)
    }


def frame_of(
    values: Sequence[Any], number: int, *, lock_step: bool
) -> SensorFrame:
    """Build a sensor frame from values of ALMemory.

    The gyro's third axis is NaN on a robot that lacks it.

    Args:
        values: Values of ``KEYS``, in that order; None where missing.
        number: Number of the frame.
        lock_step: Whether the simulation waits for answers.

    Raises:
        WireError: If a required value is missing, NaN or inf.
    """
    if len(values) != len(KEYS):
        raise WireError(f"{len(KEYS)} values are needed, got {len(values)}")
    groups: dict[str, list[float]] = {}
    rest = iter(zip(KEYS, values, strict=True))
    for name, keys in GROUPS.items():
        groups[name] = [_number(name, *next(rest)) for _ in keys]
    body = LOCK_STEP if lock_step else REAL_TIME
    battery = [groups["charge"][0], 0.0, 0.0, 0.0]
    battery[COUNTER] = float(number)
    charge, second, third, fourth = battery
    roll, pitch = groups["angles"]
    left, right = groups["sonar"]
    touch = TOUCH_COUNT * [0.0]
    for at, value in zip(FOOT_BUMPERS, groups["bumper"], strict=True):
        touch[at] = value
    touch[CHEST_BUTTON] = groups["chest"][0]
    arrays = {name: np.array(values) for name, values in groups.items()}
    return SensorFrame(
        arrays["position"],
        arrays["stiffness"],
        arrays["current"],
        arrays["temperature"],
        tuple(round(status) for status in groups["status"]),
        arrays["accelerometer"],
        arrays["gyroscope"],
        (roll, pitch),
        arrays["fsr"],
        (left, right),
        tuple(touch),
        (charge, second, third, fourth),
        (body, "6.0.0", body, "6.0.0"),
    )


def _number(group: str, key: str, value: Any) -> float:
    if value is None and group in DEFAULTS:
        return DEFAULTS[group]
    if value is None and key == GYROSCOPE[2]:
        return nan
    if value is None and group in ("position", "stiffness"):
        if key.split("/")[2] in OPTIONAL_JOINTS:
            return 0.0
    try:
        number = float(value)
    except (TypeError, ValueError) as error:
        raise WireError(f"{key} must be a number, got {value!r:.40}") from (
            error
        )
    if not isfinite(number):
        raise WireError(f"{key} must be finite, got {number}")
    return number
