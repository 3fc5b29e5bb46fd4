"""Motors of a robot; their targets and stiffness in each of its states."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..perception.measurement import RobotState, RobotStatus
from ..robots.description import RobotDescription
from ..robots.tree_cache import load_tree
from .robot import JointRobot
from .safety import SafetyState

MARGIN = 0.01  # distance from the ends of each range, in [rad]
WARM, HOT = 70.0, 85.0  # range of the reduction, in [degC]; an assumption
MIN_STIFFNESS = 0.5  # fraction of the stiffness that a hot joint keeps
POSTURE_SPEED = 0.5  # of each joint in motions to a posture, in [rad/s]
RISE, FADE = 1.0, 0.5  # of stiffness, from none to full and back, in [s]
AWAY = 0.2  # of a leg's joint from a posture that is reached, in [rad]


class Motors(NamedTuple):
    """Motors of a described robot, in the order of the joint targets."""

    names: tuple[str, ...]  # of their joints
    low: Array  # minimum angles, in [rad]
    high: Array  # maximum angles, in [rad]
    speed: Array  # maximum, in [rad/s]
    legs: NDArray[np.intp]  # indices of the motors that carry the robot
    order: NDArray[np.intp]  # index of each among the joints of the class
    stiffness: Array  # gains that hold a posture, in [N m/rad]
    damping: Array  # likewise, in [N m s/rad]


def motors_of(robot: JointRobot, description: RobotDescription) -> Motors:
    """Return the motors of a robot with ranges, speeds and gains."""
    tree, kind = load_tree(description), type(robot).__name__
    names, joints = tree.motors, list(robot.joints)
    missing = [name for name in names if name not in joints]
    if missing:
        raise ConfigurationError(
            f"{kind}: joints lack {', '.join(missing)} of the description; "
            f"they are {', '.join(joints)}"
        )
    servos = description.overlay.servos.items()
    gains = {name: (own.stiffness, own.damping) for name, own in servos}
    gains |= dict(robot.gains or {})
    missing = [name for name in names if name not in gains]
    if missing:
        raise ConfigurationError(f"{kind}: gains lack {', '.join(missing)}")
    links = [tree.links[tree.link_of(name)] for name in names]
    pairs = np.array([gains[name] for name in names], dtype=np.float64)
    speeds = [description.speed_limits.get(name, np.inf) for name in names]
    # Legs may share a motor.
    legs = [names.index(leg) for leg in description.legs if leg in names]
    return Motors(
        names,
        low=np.array([link.low for link in links]),
        high=np.array([link.high for link in links]),
        speed=np.array(speeds),
        legs=np.array(legs),
        order=np.array([joints.index(name) for name in names]),
        stiffness=pairs[:, 0],
        damping=pairs[:, 1],
    )


def derate_stiffness(stiffness: Array, status: RobotStatus) -> Array:
    """Reduce the stiffness of hot joints, from 0 to 1. Shape (motors,)."""
    hot = (status.temperature - WARM) / (HOT - WARM)
    factor = np.clip(1.0 - (1.0 - MIN_STIFFNESS) * hot, MIN_STIFFNESS, 1.0)
    factor[status.heat >= 3] = 0.0
    return stiffness * factor


class JointMotion:
    """Generator of joint targets and stiffness for the robot's state.

    Attributes:
        targets: Newest joint targets, in [rad].
        share: Stiffness now, from 0 to 1.
    """

    def __init__(
        self,
        stance: Array,
        motors: Motors,
        tick: float,
        *,
        crouch: Mapping[str, float],
        soft: bool = False,
        at_once: bool = False,
    ) -> None:
        """Start limp; control begins in the stance.

        If control chooses soft gains, its targets may be far from the angles,
        and are not limited. Stiffness may rise and fall within one tick.
        """
        self._motors, self._tick, self._soft = motors, tick, soft
        rest = [
            crouch.get(name, angle)
            for name, angle in zip(motors.names, stance, strict=True)
        ]
        self._goals = {
            SafetyState.REACHING: stance,
            SafetyState.READY: stance,
            SafetyState.RESTING: np.array(rest),
        }
        self._up, self._down = (
            (1.0, 1.0) if at_once else (tick / RISE, tick / FADE)
        )
        self.share = 0.0
        self.targets: Array = np.zeros(len(motors.names))

    def reached(self, state: SafetyState, measured: Array) -> bool:
        """Return whether the slow motion of a state is complete."""
        if state not in (SafetyState.REACHING, SafetyState.RESTING):
            return False
        if state is SafetyState.REACHING and self.share < 1.0:
            return False
        goal, legs = self._goals[state], self._motors.legs
        arrived = np.abs(self.targets - goal).max() < 2.0 * MARGIN
        off = np.abs(measured[legs] - goal[legs])
        return bool(arrived and np.all(off < AWAY))

    def weaken(self, share: float) -> None:
        """Limit the stiffness now, from 0 to 1; it may rise again."""
        self.share = min(self.share, share)

    def move(
        self, state: SafetyState, report: RobotState, wanted: Array
    ) -> tuple[Array, Array]:
        """Return targets [rad] and stiffness of one tick.

        NaN and inf in the targets that control wants are ignored.
        """
        limp = state is SafetyState.LIMP
        if limp and self.share == 0.0:
            # Stiffness rises at the measured angles, so that nothing jumps.
            self.targets = report.joint_positions
        if state.moves_by_control:
            wanted = np.where(np.isfinite(wanted), wanted, self.targets)
            self.targets = wanted if self._soft else self._toward(wanted)
        elif not limp:
            self.targets = self._toward(self._goals[state], POSTURE_SPEED)
        stiffness = np.full(len(self.targets), self._ramp(not limp))
        if report.status is not None:
            stiffness = derate_stiffness(stiffness, report.status)
        return self.targets, stiffness

    def fade(self) -> tuple[Array, Array]:
        """Return held targets, and stiffness lower by one tick."""
        return self.targets, np.full(len(self.targets), self._ramp(False))

    def _toward(self, goal: Array, most: float = np.inf) -> Array:
        """Return targets nearer to a goal, in range and speed of the motors.

        A joint that was measured outside its range returns into it.
        """
        motors = self._motors
        goal = np.clip(goal, motors.low + MARGIN, motors.high - MARGIN)
        reach = np.minimum(motors.speed, most) * self._tick
        return self.targets + np.clip(goal - self.targets, -reach, reach)

    def _ramp(self, stiff: bool) -> float:
        """Move the stiffness by one tick, and return it."""
        wanted = 1.0 if stiff else 0.0
        change = min(max(wanted - self.share, -self._down), self._up)
        self.share = min(max(self.share + change, 0.0), 1.0)
        return self.share
