"""Checks of the reports of a user's joint-driven robot."""

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np

from ...core.poses import Array
from ...core.user_file import FAILURES, shown_briefly
from ...perception.measurement import Sighting
from ..guardian_process import SessionLost
from ..sighting_checks import sighting_fault
from .joint_map import MotorTable
from .joint_robot import JointReport

BEYOND = 0.35  # a joint's angle may be outside its range by, in [rad]
FASTEST = 35.0  # plausible angular velocity of a torso, in [rad/s]
FOOT_SENSORS = 8


def values_of(by_joint: Mapping[str, float], names: tuple[str, ...]) -> Array:
    """Return the values of joints in an order. Shape (joints,)."""
    return np.array([by_joint[name] for name in names], dtype=np.float64)


def joint_report_fault(report: JointReport, motors: MotorTable) -> str:
    """Return why a report is implausible; empty if it is plausible.

    Args:
        report: The report.
        motors: Joints of the description.
    """
    position = values_of(report.positions, motors.names)
    off = np.maximum(motors.low - position, position - motors.high)
    vectors: dict[str, Any] = {
        "positions": position,
        "velocities": values_of(report.velocities, motors.names),
        "gyro": report.gyro,
        "accelerometer": report.accelerometer,
        "tilt": report.tilt,
    }
    if report.foot_forces is not None:
        vectors["foot_forces"] = report.foot_forces
    for name, vector in vectors.items():
        if not np.all(np.isfinite(vector)):
            return f"{name} must be finite, got {shown_briefly(vector)}"
    if off.max() > BEYOND:
        at = int(off.argmax())
        return (
            f"{motors.names[at]} is at {position[at]:.2f} rad, outside "
            f"its range [{motors.low[at]:.2f}, {motors.high[at]:.2f}] "
            "rad: is it in degrees?"
        )
    if max(map(abs, report.tilt)) > pi:
        return f"tilt is {report.tilt} rad: is it in degrees?"
    if max(map(abs, report.gyro)) > FASTEST:
        return f"gyro reads {list(report.gyro)} rad/s: is it in deg/s?"
    if report.sighting is not None:
        return sighting_fault(*report.sighting[1:3])
    return ""


def converted_joint_report(
    got: Any, name: str, joints: tuple[str, ...]
) -> JointReport:
    """Return a report of plain numbers.

    Args:
        got: Result of listen().
        name: Name of the method, for messages.
        joints: Joints that it must have.

    Raises:
        SessionLost: If it is no report.
    """
    try:
        time, positions, velocities, gyro, force, tilt, feet, seen, why = got
        vectors = [_floats(gyro, 3), _floats(force, 3)]
        roll, pitch = (float(value) for value in tilt)
        if seen is not None:
            seen = Sighting(*seen)
        feet = None if feet is None else _floats(feet, FOOT_SENSORS)
        report = JointReport(
            *(float(time), dict(positions), dict(velocities)),
            *(*vectors, (roll, pitch), feet, seen, str(why)),
        )
    except FAILURES as error:
        raise SessionLost(
            f"{name} must return a JointReport(time, positions, velocities, "
            f"gyro, accelerometer, tilt) or None, got {shown_briefly(got)}"
        ) from error
    for entry in ("positions", "velocities"):
        values = getattr(report, entry)
        missing = [joint for joint in joints if joint not in values]
        if missing:
            raise SessionLost(f"{name}: {entry} lack {', '.join(missing)}")
    return report


def _floats(values: Any, count: int) -> tuple[float, ...]:
    found = tuple(float(value) for value in values)
    if len(found) != count:
        raise ValueError(f"{count} values, got {len(found)}")
    return found
