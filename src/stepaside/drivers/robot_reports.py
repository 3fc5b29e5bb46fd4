"""Checks of what robots report: types, units, jumps, sightings, clocks."""

from math import degrees, hypot, inf, isfinite, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.errors import FAILURES, shown
from ..core.poses import Array, Pose, wrap_angle
from ..perception.measurement import RobotState, RobotStatus, Sighting
from .joint_motion import Motors
from .method_thread import SessionLost
from .robot import JointRobot

FOOT_SENSORS = 8
ALWAYS = (
    "joint_positions",
    "joint_velocities",
    "gyro",
    "accelerometer",
    "tilt",
)
MAX_DISTANCE = 1e3  # far beyond the range of any sensor used, in [m]
ROUNDING = 1e-6  # of a bearing in single precision, in [rad]
BEYOND = 0.35  # a joint's angle may be outside its range by, in [rad]
FASTEST_JOINT = 40.0  # plausible speed of a joint, in [rad/s]
PLAUSIBLE = 3.0  # such speed over that of the motor: others may move a joint
FASTEST_TORSO = 35.0  # plausible angular velocity of a torso, in [rad/s]
FASTEST = 10.0  # plausible speed of a walking robot, in [m/s]
FASTEST_TURN = 15.0  # plausible turning rate, in [rad/s]
MIN_PASSED = 0.02  # over which a jump is judged at least, in [s]
LEAD = 0.1  # by which times may run ahead of this computer's clock, in [s]
LAG = 0.5  # by which they may fall behind it, in [s]
DRIFT = 0.02  # relative difference of two clocks' rates at most


def plain_report(got: Any, robot: Any, name: str) -> RobotState:
    """Return a report of plain numbers."""
    joints = isinstance(robot, JointRobot)
    try:
        if not isinstance(got, RobotState):
            raise TypeError("not a RobotState")
        sighting = got.sighting
        if sighting is not None:
            time, bearing, distance = (float(value) for value in sighting[:3])
            sighting = Sighting(time, bearing, distance, *sighting[3:])
        report: RobotState = got._replace(
            time=float(got.time),
            sighting=sighting,
            hindrance=str(got.hindrance),
        )
        if joints:
            return _plain_joints(report, len(robot.joints))
        x, y, theta = (float(value) for value in report.pose)
        return report._replace(pose=Pose(x, y, theta))
    except FAILURES as error:
        form = "RobotState(time, pose=Pose(x, y, theta))"
        if joints:
            form = (
                "RobotState(time, joint_positions, gyro, accelerometer, "
                "joint_velocities=..., tilt=...) with arrays of "
                f"{len(robot.joints)} joints,"
            )
        raise SessionLost(
            f"{name} must return a {form} or None, got {shown(got)}"
        ) from error


def _plain_joints(got: RobotState, joints: int) -> RobotState:
    status = got.status
    if status is not None:
        each = (_floats(values, joints) for values in status[:4])
        charge, *flags = status[4:]
        plain = (*each, float(charge), *map(bool, flags))
        status = RobotStatus._make(plain)
    assert got.tilt is not None  # else it is no report of joints
    return got._replace(
        joint_positions=_floats(got.joint_positions, joints),
        joint_velocities=_floats(got.joint_velocities, joints),
        gyro=_floats(got.gyro, 3),
        accelerometer=_floats(got.accelerometer, 3),
        tilt=(float(got.tilt[0]), float(got.tilt[1])),
        foot_forces=_floats(got.foot_forces, FOOT_SENSORS),
        status=status,
    )


def _floats(values: Any, count: int) -> Array:
    found = np.array(values, dtype=np.float64)
    if found.shape != (count,):
        raise ValueError(f"{count} values, got shape {found.shape}")
    return found


def in_order(report: RobotState, order: NDArray[np.intp]) -> RobotState:
    """Return a report in the order of the motors, by their joints."""
    assert report.joint_velocities is not None
    status = report.status
    if status is not None:
        each = (values[order] for values in status[:4])
        status = RobotStatus._make((*each, *status[4:]))
    return report._replace(
        joint_positions=report.joint_positions[order],
        joint_velocities=report.joint_velocities[order],
        status=status,
    )


def joint_fault(report: RobotState, motors: Motors) -> str:
    """Return why a report in the order of the motors is implausible, if so."""
    measured = {name: getattr(report, name) for name in ALWAYS}
    if report.status is not None:
        measured |= report.status._asdict()
    for name, values in measured.items():
        if not np.all(np.isfinite(values)):
            return f"{name} must be finite, got {shown(values)}"
    forces = report.foot_forces
    if np.isinf(forces).any() or 0 < np.isnan(forces).sum() < len(forces):
        return f"foot_forces must be finite, got {shown(forces)}"
    position = report.joint_positions
    off = np.maximum(motors.low - position, position - motors.high)
    if off.max() > BEYOND:
        at = int(off.argmax())
        return (
            f"{motors.names[at]} is at {position[at]:.2f} rad, outside "
            f"its range [{motors.low[at]:.2f}, {motors.high[at]:.2f}] "
            "rad: is it in degrees?"
        )
    if report.tilt is not None and max(map(abs, report.tilt)) > pi:
        return f"tilt is {report.tilt} rad: is it in degrees?"
    if np.abs(report.gyro).max() > FASTEST_TORSO:
        rates = report.gyro.tolist()
        return f"gyro reads {rates} rad/s: is it in deg/s?"
    if report.sighting is not None:
        return sighting_fault(report.sighting)
    return ""


def joint_jump(report: RobotState, last: RobotState, motors: Motors) -> str:
    """Return which joint has jumped since the last valid report, if any."""
    passed = max(report.time - last.time, MIN_PASSED)
    fastest = np.minimum(PLAUSIBLE * motors.speed, FASTEST_JOINT)
    moved = np.abs(report.joint_positions - last.joint_positions)
    at = int((moved - fastest * passed).argmax())
    if moved[at] <= fastest[at] * passed:
        return ""
    return (
        f"{motors.names[at]} jumped by {moved[at]:.2f} rad in {passed:.3f} s"
    )


def pose_fault(report: RobotState, last: RobotState | None) -> str:
    """Return why a report is implausible after a plausible one, if so."""
    x, y, theta = report.pose
    if not all(isfinite(value) for value in (report.time, x, y, theta)):
        return (
            "time and pose must be finite, got "
            f"{report.time:g}, {x:g}, {y:g}, {theta:g}"
        )
    if abs(theta) > 2.0 * pi:
        return (
            f"the heading must lie in [-pi, pi] rad, got {theta:.1f}: is it "
            "in degrees?"
        )
    if last is None:
        return ""
    passed = max(report.time - last.time, MIN_PASSED)
    turned = abs(wrap_angle(theta - last.pose.theta))
    if turned > FASTEST_TURN * passed:
        return (
            f"the heading jumped by {turned:.2f} rad in {passed:.3f} s: is "
            "it in degrees?"
        )
    moved = hypot(x - last.pose.x, y - last.pose.y)
    if moved > FASTEST * passed:
        return (
            f"the position jumped by {moved:.2f} m in {passed:.3f} s: is it "
            "in millimetres?"
        )
    return ""


def sighting_fault(sighting: Sighting) -> str:
    """Return the reason why a sighting is invalid; empty if it is valid.

    A bearing out of range is not wrapped: the sender may use degrees, or
    another zero direction.
    """
    time, bearing, distance = sighting[:3]
    if not isfinite(time):
        return f"time of the sighting must be finite, got {time}"
    if not (isfinite(bearing) and isfinite(distance)):
        return (
            "bearing and distance of the sighting must be finite, got "
            f"{bearing} rad and {distance} m"
        )
    if abs(bearing) > pi + ROUNDING:
        return (
            "the bearing of the sighting must lie in [-180, 180] deg, got "
            f"{degrees(bearing):.0f} deg ({bearing:.3f} rad)"
        )
    if not 0.0 <= distance <= MAX_DISTANCE:
        return (
            "the distance of the sighting must lie in "
            f"[0, {MAX_DISTANCE:g}] m, got {distance:g} m"
        )
    return ""


class ClockMeter:
    """Check of a robot's clock against this computer's.

    The clocks may have different zeros, so only differences are compared. A
    lag stays: reports that are old do not become newer by themselves.
    """

    def __init__(self, *, stamped: bool = True) -> None:
        """Start before the first report; counted times may fall behind."""
        self._most = LAG if stamped else inf
        self._lead = self._lag = 0.0
        self._last: tuple[float, float] | None = None  # time and arrival

    def fault(self, time: float, now: float) -> str:
        """Return the fault of a report by its times [s]; empty without one."""
        last, self._last = self._last, (time, now)
        if last is None or time < last[0]:
            self._lead = self._lag = 0.0
            return ""
        gone = now - last[1]
        ahead, drift = time - last[0] - gone, DRIFT * gone
        self._lead = max(0.0, self._lead + ahead - drift)
        self._lag = max(0.0, self._lag - ahead - drift)
        if self._lead > LEAD:
            lead, self._lead = self._lead, 0.0
            return f"{lead:.3f} s ahead of the clock"
        late = self._lag > self._most
        return f"{self._lag:.3f} s behind the clock" if late else ""
