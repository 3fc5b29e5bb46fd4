"""ALMotion and ALRobotPosture of a simulated robot with walking control.

The methods have the names and arguments of NAOqi's own services, and are
called from threads of the ``qi`` library.
"""

from collections import deque
from collections.abc import Sequence
from math import isfinite
from typing import Any

from ...planning import GaitSettings
from ..velocity.velocity_body import REST, VelocityCommand
from .footstep_validation import footstep_entry, read_steps, velocity_of
from .joint_chains import joints_of, shares_of, values_of
from .service_state import WalkServiceState

HEAD = ("HeadYaw", "HeadPitch")
POSTURES = ("Stand", "StandInit", "StandZero", "Crouch")


class ALMotion:
    """Stiffness, walking, head and odometry."""

    def __init__(
        self,
        robot: WalkServiceState,
        fastest: VelocityCommand,
        gait: GaitSettings,
    ) -> None:
        """Create the service of a robot.

        Args:
            robot: State shared by the services.
            fastest: Velocity of which ``moveToward`` takes fractions.
            gait: Gait by which footsteps are walked.
        """
        self._robot, self._fastest, self._gait = robot, fastest, gait

    def wakeUp(self) -> None:
        """Make all joints stiff."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.stiffen(dict.fromkeys(self._robot.names, 1.0))

    def rest(self) -> None:
        """Stop, crouch and go limp."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.rest()
            self._robot.awake, self._robot.posture = False, "Crouch"

    def robotIsWakeUp(self) -> bool:
        """Return whether the legs are stiff."""
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
        """Command the head; the walking control moves all other joints."""
        with self._robot.lock:
            self._robot.calls += 1
            joints = joints_of(names, self._robot.names)
            values = values_of(joints, angles, "angles").tolist()
            others = set(joints) - {*HEAD}
            if others:
                raise ValueError(
                    f"only {' and '.join(HEAD)} can be set, as the walking "
                    f"control moves all other joints, got {sorted(others)}"
                )
            if not 0.0 < fraction <= 1.0:
                raise ValueError(
                    f"fraction must lie in (0, 1], got {fraction}"
                )
            if not self._robot.awake:
                raise RuntimeError("the robot is asleep: wakeUp first")
            self._robot.head |= {
                joint: value
                for joint, value in zip(joints, values, strict=True)
                if joint not in self._robot.limp
            }

    def moveInit(self) -> None:
        """Do nothing: the robot is always ready to walk."""
        with self._robot.lock:
            self._robot.calls += 1

    def move(self, *values: Any) -> None:
        """Walk at x, y [m/s] and theta [rad/s]."""
        self._walk(values, VelocityCommand(1.0, 1.0))

    def moveToward(self, *values: Any) -> None:
        """Walk at fractions of the maximum velocity."""
        self._walk(values, self._fastest)

    def setFootSteps(
        self, legs: Any, poses: Any, times: Any, clear: bool
    ) -> None:
        """Append footsteps to the pending ones, or replace those.

        The current step is finished first. Each step takes the gait's step
        duration: times only have to increase. After the last one the robot
        brings its feet together and stands.
        """
        robot = self._robot
        with robot.lock:
            robot.calls += 1
            if not robot.awake:
                raise RuntimeError("the robot is asleep: wakeUp first")
            pending = [] if clear else list(robot.steps)
            before = pending[-1][0] if pending else robot.state.step
            steps = read_steps(
                legs, poses, times, None if before is None else before.foot
            )
            added = [(step, velocity_of(step, self._gait)) for step in steps]
            robot.asked = REST
            robot.steps = deque([*pending, *added])

    def getFootSteps(self) -> list[Any]:
        """Return the poses of both feet, the current and pending steps."""
        robot = self._robot
        with robot.lock:
            robot.calls += 1
            current = robot.state.step
            return [
                [list(foot) for foot in robot.state.feet],
                [] if current is None else [footstep_entry(current)],
                [footstep_entry(step) for step, _ in robot.steps],
            ]

    def stopMove(self) -> None:
        """Stop walking."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.rest()

    def moveIsActive(self) -> bool:
        """Return whether the robot walks or has been commanded to."""
        with self._robot.lock:
            self._robot.calls += 1
            robot = self._robot
            walks = robot.asked != REST or bool(robot.steps)
            return walks or robot.state.step is not None

    def getRobotPosition(self, use_sensors: bool) -> list[float]:
        """Return the pose in odometry: x, y [m], theta [rad]."""
        with self._robot.lock:
            self._robot.calls += 1
            return list(self._robot.state.pose)

    def getRobotVelocity(self) -> list[float]:
        """Return the velocity: x, y [m/s], theta [rad/s]."""
        with self._robot.lock:
            self._robot.calls += 1
            forward, turn, _ = self._robot.state.velocity
            return [forward, 0.0, turn]

    def getBodyNames(self, name: str) -> list[str]:
        """Return the names of the joints of a chain."""
        return joints_of(name, self._robot.names)

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        """Return joint angles, in [rad]."""
        with self._robot.lock:
            self._robot.calls += 1
            joints = joints_of(names, self._robot.names)
            angles = dict(
                zip(self._robot.names, self._robot.state.joints, strict=True)
            )
            return [angles[name] for name in joints]

    def _walk(self, values: Sequence[Any], scale: VelocityCommand) -> None:
        if len(values) not in (3, 4):
            raise ValueError(
                f"a velocity must be x, y and theta, got {values!r}"
            )
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
                raise ValueError(f"lateral velocity must be 0 m/s, got {y}")
            self._robot.rest()
            self._robot.asked = velocity


class ALRobotPosture:
    """Posture of the robot: standing or crouching."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Create the service of a robot."""
        self._robot = robot

    def goToPosture(self, name: str, speed: float) -> bool:
        """Take a posture; return whether it exists and the robot is awake."""
        with self._robot.lock:
            self._robot.calls += 1
            if name not in POSTURES or not self._robot.awake:
                return False
            self._robot.rest()
            self._robot.posture = name
            return True

    def getPosture(self) -> str:
        """Return the present posture."""
        with self._robot.lock:
            return self._robot.posture
