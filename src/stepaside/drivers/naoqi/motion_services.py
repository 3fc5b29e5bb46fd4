"""ALMotion and ALRobotPosture of a simulated robot that walks by itself.

Methods are called from threads of the messaging, by the names and with the
arguments that NAOqi's own services have.
"""

from collections import deque
from collections.abc import Sequence
from math import isfinite
from typing import Any

from ...planning import GaitSettings
from ..velocity.velocity_body import REST, VelocityCommand
from .footstep_requests import read_steps, told, velocity_of
from .joint_chains import joints_of, shares_of, values_of
from .service_state import WalkServiceState

HEAD = ("HeadYaw", "HeadPitch")
POSTURES = ("Stand", "StandInit", "StandZero", "Crouch")


class ALMotion:
    """Motion: stiffness, walking, where the robot is."""

    def __init__(
        self,
        robot: WalkServiceState,
        fastest: VelocityCommand,
        gait: GaitSettings,
    ) -> None:
        """Move a robot, at most so fast, by the steps of its gait."""
        self._robot, self._fastest, self._gait = robot, fastest, gait

    def wakeUp(self) -> None:
        """Make the motors stiff."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.stiffen(dict.fromkeys(self._robot.names, 1.0))

    def rest(self) -> None:
        """Stop, crouch, and let the motors go."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.rest()
            self._robot.awake, self._robot.posture = False, "Crouch"

    def robotIsWakeUp(self) -> bool:
        """Whether the motors are stiff."""
        with self._robot.lock:
            self._robot.calls += 1
            return self._robot.awake

    def setStiffnesses(self, names: Any, stiffness: Any) -> None:
        """Set the stiffness of joints or chains, from 0 to 1."""
        with self._robot.lock:
            self._robot.calls += 1
            joints = joints_of(names, self._robot.names)
            shares = shares_of(joints, stiffness).tolist()
            self._robot.stiffen(dict(zip(joints, shares, strict=True)))

    def setAngles(self, names: Any, angles: Any, fraction: float) -> None:
        """Turn the head: the other joints walk by themselves."""
        with self._robot.lock:
            self._robot.calls += 1
            joints = joints_of(names, self._robot.names)
            values = values_of(joints, angles, "angles").tolist()
            others = set(joints) - {*HEAD}
            if others:
                raise ValueError(
                    f"only {' and '.join(HEAD)} may be set while it walks "
                    f"by itself, got {sorted(others)}"
                )
            if not 0.0 < fraction <= 1.0:
                raise ValueError(f"fraction must lie in (0, 1]: {fraction}")
            if not self._robot.awake:
                raise RuntimeError("the robot is asleep: wakeUp first")
            self._robot.head |= {
                joint: value
                for joint, value in zip(joints, values, strict=True)
                if joint not in self._robot.limp
            }

    def moveInit(self) -> None:
        """Make ready to walk: it always is."""
        with self._robot.lock:
            self._robot.calls += 1

    def move(self, *values: Any) -> None:
        """Walk at x, y [m/s] and theta [rad/s]."""
        self._walk(values, VelocityCommand(1.0, 1.0))

    def moveToward(self, *values: Any) -> None:
        """Walk at shares of the top speeds."""
        self._walk(values, self._fastest)

    def setFootSteps(
        self, legs: Any, places: Any, times: Any, clear: bool
    ) -> None:
        """Make steps, after those that were told, or instead of them.

        The step that is being made is finished. Each takes the time of the
        gait: times only have to rise. After the last one it brings its
        feet together and rests.
        """
        robot = self._robot
        with robot.lock:
            robot.calls += 1
            if not robot.awake:
                raise RuntimeError("the robot is asleep: wakeUp first")
            kept = [] if clear else list(robot.steps)
            making = robot.state.step
            before = kept[-1][0] if kept else making
            steps = read_steps(
                legs, places, times, None if before is None else before.foot
            )
            walked = [(step, velocity_of(step, self._gait)) for step in steps]
            robot.asked = REST
            robot.steps = deque([*kept, *walked])

    def getFootSteps(self) -> list[Any]:
        """Both feet, the step that is being made, and those to come."""
        robot = self._robot
        with robot.lock:
            robot.calls += 1
            making = robot.state.step
            return [
                [list(foot) for foot in robot.state.feet],
                [] if making is None else [told(making)],
                [told(step) for step, _ in robot.steps],
            ]

    def stopMove(self) -> None:
        """Come to rest."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.rest()

    def moveIsActive(self) -> bool:
        """Whether it is asked to walk."""
        with self._robot.lock:
            self._robot.calls += 1
            robot = self._robot
            walks = robot.asked != REST or bool(robot.steps)
            return walks or robot.state.step is not None

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
        """Names of the joints of a chain."""
        return joints_of(name, self._robot.names)

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        """Angles of joints, in [rad]."""
        with self._robot.lock:
            self._robot.calls += 1
            wanted = joints_of(names, self._robot.names)
            where = dict(
                zip(self._robot.names, self._robot.state.joints, strict=True)
            )
            return [where[name] for name in wanted]

    def _walk(self, values: Sequence[Any], scale: VelocityCommand) -> None:
        if len(values) not in (3, 4):
            raise ValueError(f"x, y and theta are needed, got {values!r}")
        x, y, theta = (float(value) for value in values[:3])
        velocity = VelocityCommand(scale.forward * x, scale.turn * theta)
        with self._robot.lock:
            self._robot.calls += 1
            if not self._robot.awake:
                raise RuntimeError("the robot is asleep: wakeUp first")
            if not (isfinite(x) and isfinite(y) and isfinite(theta)):
                self._robot.rest()
                raise ValueError(f"velocity must be finite, got {values!r}")
            if y != 0.0:
                self._robot.rest()
                raise ValueError(f"it walks no way aside, got y = {y}")
            self._robot.rest()
            self._robot.asked = velocity


class ALRobotPosture:
    """Postures: it stands, or crouches."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Know the robot."""
        self._robot = robot

    def goToPosture(self, name: str, speed: float) -> bool:
        """Go there; whether it did."""
        with self._robot.lock:
            self._robot.calls += 1
            if name not in POSTURES or not self._robot.awake:
                return False
            self._robot.rest()
            self._robot.posture = name
            return True

    def getPosture(self) -> str:
        """Where it is."""
        with self._robot.lock:
            return self._robot.posture
