"""NAOqi's services for a simulated robot that walks by itself.

Methods are called from threads of the messaging, by the names and with the
arguments that NAOqi's own services have.
"""

from collections.abc import Mapping, Sequence
from math import isfinite
from threading import Lock
from typing import Any

from ..velocity.body import REST, Velocity
from ..velocity.served import WalkerState
from .address import IDEAL_SIGHT

SUBDEVICES = "Device/SubDeviceList"
SENSED = "Position/Sensor/Value"
HEAD = ("HeadYaw", "HeadPitch")
POSTURES = ("Stand", "StandInit", "StandZero", "Crouch")


class Robot:
    """What the services share, guarded by one lock.

    Attributes:
        lock: Held by whoever reads or writes.
        state: What the robot said of itself last.
        asked: Velocity that was asked for last.
        awake: Whether its motors are stiff.
        posture: Where it stands, or crouches.
        head: Angles that its head is asked for, in [rad], by joint.
        calls: How often anything was asked.
    """

    def __init__(self, state: WalkerState, names: Sequence[str]) -> None:
        """Begin at rest, asleep."""
        self.lock = Lock()
        self.state, self.names = state, list(names)
        self.asked = REST
        self.awake, self.fallen, self.pressed = False, False, False
        self.posture = "Crouch"
        self.head: dict[str, float] = {}
        self.calls = 0


class ALMotion:
    """Motion: stiffness, walking, where the robot is."""

    def __init__(self, robot: Robot, fastest: Velocity) -> None:
        """Move a robot, at most so fast."""
        self._robot, self._fastest = robot, fastest

    def wakeUp(self) -> None:
        """Make the motors stiff."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.awake = True

    def rest(self) -> None:
        """Stop, crouch, and let the motors go."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.asked = REST
            self._robot.awake, self._robot.posture = False, "Crouch"

    def robotIsWakeUp(self) -> bool:
        """Whether the motors are stiff."""
        with self._robot.lock:
            self._robot.calls += 1
            return self._robot.awake

    def setStiffnesses(self, names: Any, stiffness: Any) -> None:
        """Make all motors stiff, or none."""
        values = stiffness if isinstance(stiffness, list) else [stiffness]
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.awake = min(float(v) for v in values) > 0.0
            if not self._robot.awake:
                self._robot.asked = REST

    def setAngles(self, names: Any, angles: Any, fraction: float) -> None:
        """Turn the head: the other joints walk by themselves."""
        wanted = [names] if isinstance(names, str) else list(names)
        values = angles if isinstance(angles, list | tuple) else [angles]
        asked = dict(zip(wanted, map(float, values), strict=True))
        with self._robot.lock:
            self._robot.calls += 1
            others = set(asked) - ({*HEAD} & {*self._robot.names})
            if others:
                raise ValueError(
                    f"only {' and '.join(HEAD)} may be set while it walks "
                    f"by itself, got {sorted(others)}"
                )
            if not all(isfinite(value) for value in asked.values()):
                raise ValueError(f"angles must be finite, got {values!r}")
            if not 0.0 < fraction <= 1.0:
                raise ValueError(f"fraction must lie in (0, 1]: {fraction}")
            if not self._robot.awake:
                raise RuntimeError("the robot is asleep: wakeUp first")
            self._robot.head |= asked

    def moveInit(self) -> None:
        """Make ready to walk: it always is."""
        with self._robot.lock:
            self._robot.calls += 1

    def move(self, *values: Any) -> None:
        """Walk at x, y [m/s] and theta [rad/s]."""
        self._walk(values, Velocity(1.0, 1.0))

    def moveToward(self, *values: Any) -> None:
        """Walk at shares of the top speeds."""
        self._walk(values, self._fastest)

    def stopMove(self) -> None:
        """Come to rest."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.asked = REST

    def moveIsActive(self) -> bool:
        """Whether it is asked to walk."""
        with self._robot.lock:
            self._robot.calls += 1
            return self._robot.asked != REST

    def getRobotPosition(self, use_sensors: bool) -> list[float]:
        """Pose in its odometry: x, y [m], theta [rad]."""
        with self._robot.lock:
            self._robot.calls += 1
            return list(self._robot.state.pose)

    def getRobotVelocity(self) -> list[float]:
        """Velocity: x, y [m/s], theta [rad/s]."""
        with self._robot.lock:
            self._robot.calls += 1
            forward, turn = self._robot.state.velocity
            return [forward, 0.0, turn]

    def getBodyNames(self, name: str) -> list[str]:
        """Names of its joints."""
        return self._robot.names

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        """Angles of joints, in [rad]."""
        wanted = [names] if isinstance(names, str) else list(names)
        if wanted in (["Body"], ["Joints"]):
            wanted = self._robot.names
        with self._robot.lock:
            self._robot.calls += 1
            where = dict(
                zip(self._robot.names, self._robot.state.joints, strict=True)
            )
            return [where[name] for name in wanted]

    def _walk(self, values: Sequence[Any], scale: Velocity) -> None:
        if len(values) not in (3, 4):
            raise ValueError(f"x, y and theta are needed, got {values!r}")
        x, y, theta = (float(value) for value in values[:3])
        velocity = Velocity(scale.forward * x, scale.turn * theta)
        with self._robot.lock:
            self._robot.calls += 1
            if not self._robot.awake:
                raise RuntimeError("the robot is asleep: wakeUp first")
            if not (isfinite(x) and isfinite(y) and isfinite(theta)):
                self._robot.asked = REST
                raise ValueError(f"velocity must be finite, got {values!r}")
            if y != 0.0:
                self._robot.asked = REST
                raise ValueError(f"it walks no way aside, got y = {y}")
            self._robot.asked = velocity


class ALRobotPosture:
    """Postures: it stands, or crouches."""

    def __init__(self, robot: Robot) -> None:
        """Know the robot."""
        self._robot = robot

    def goToPosture(self, name: str, speed: float) -> bool:
        """Go there; whether it did."""
        with self._robot.lock:
            self._robot.calls += 1
            if name not in POSTURES or not self._robot.awake:
                return False
            self._robot.asked, self._robot.posture = REST, name
            return True

    def getPosture(self) -> str:
        """Where it is."""
        with self._robot.lock:
            return self._robot.posture


class ALSonar:
    """Sonars: whoever subscribes finds echoes in ALMemory."""

    def subscribe(self, name: str) -> None:
        """Begin to listen: nothing is heard here."""

    def unsubscribe(self, name: str) -> None:
        """Stop listening."""


class ALMemory:
    """Values by key."""

    def __init__(self, robot: Robot) -> None:
        """Know the robot."""
        self._robot = robot

    def getData(self, key: str) -> Any:
        """One value."""
        with self._robot.lock:
            self._robot.calls += 1
            return self._values()[key]

    def getListData(self, keys: Any) -> list[Any]:
        """Values; None for what there is not."""
        with self._robot.lock:
            self._robot.calls += 1
            values = self._values()
            return [values.get(key) for key in keys]

    def _values(self) -> Mapping[str, Any]:
        robot = self._robot
        values: dict[str, Any] = {
            "robotHasFallen": float(robot.fallen),
            "ChestButtonPressed": float(robot.pressed),
            IDEAL_SIGHT: _sight(robot.state),
        }
        for name, angle in zip(robot.names, robot.state.joints, strict=True):
            values[f"{SUBDEVICES}/{name}/{SENSED}"] = angle
        return values


def _sight(state: WalkerState) -> list[float] | None:
    seen = state.sighting
    if seen is None:
        return None
    return [state.time - seen.time, seen.bearing, seen.distance]
