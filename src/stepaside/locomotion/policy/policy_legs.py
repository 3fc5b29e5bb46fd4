"""Learned legs of one robot: a body velocity in, joint targets out."""

from copy import copy
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.compilation import bound, compiled
from ...core.errors import PolicyError
from ...core.onnx_sessions import marks_of
from ...core.poses import Array, Pose
from ...perception.attitude import CALIBRATION, AttitudeFilter
from ...perception.measurement import RobotState
from ...planning import Foot, GaitSettings
from ...robots.description import RobotDescription
from ...robots.forward_kinematics import ForwardKinematics
from ...strategies.knowledge import Intent
from ...strategies.velocity_set import STILL, BodyVelocity, VelocitySet
from ..control_settings import LegsSettings
from ..guard import VelocityGuard
from ..locomotion import (
    CurrentStep,
    IntentSource,
    Phase,
    StepStarted,
    resting_step,
    template_velocity,
)
from .contract import PolicyContract
from .contract_reader import RobotJoints, read_contract
from .leg_odometry import LegOdometry
from .runner import BodyMotion, PolicyNetwork, PolicyRunner
from .velocity_response import VelocityResponse, load_response

LEARNING = 0.2  # integral gain of each velocity, in [1/s]: some gait cycles
BOUND = 0.15  # greatest learned correction, in [m/s] and [rad/s]
# Gain of the accelerometer until then, in [1/s]. It also reads the knocks of a
# robot that comes to stand: at 6 a K1 falls in its first steps, at 3 not.
FIRST = 3.0
# Gain afterwards, in [1/s]: some gait cycles. In walks at random commands on
# six networks the error is 0.5 to 0.6 deg rms, at 0.5 it is 0.8 to 1.1 deg.
# With sensors of the hardware body it is less at 0.25 than at 0.15 and 0.5.
CORRECTION = 0.25
BIAS_CORRECTION = 0.0125  # of the gyro, in [1/s^2]: damped beyond critical


@compiled
def learn(
    intended: Array,
    moved: Array,
    learning: Array,
    correction: Array,
    wanted: Array,
) -> None:
    """Correct the intended velocity by what is missing of it."""
    for i in range(3):
        missing = intended[i] * learning[1] - moved[i]
        learned = correction[i] + learning[0] * missing
        correction[i] = min(max(learned, -BOUND), BOUND)
        wanted[i] = intended[i] + correction[i]


class InitialPosture(NamedTuple):
    """Posture in which a robot with a walking policy begins."""

    joint_names: tuple[str, ...]
    joint_targets: Array  # their angles [rad]. Shape (joints,)
    posture: Array  # (7 + joints,)


def initial_posture(
    forward: ForwardKinematics, angles: dict[str, float]
) -> InitialPosture:
    """Stand upright with given angles, the soles beside the odometry's origin.

    Joints without an angle take that of the description, or 0 rad.
    """
    tree = forward.tree
    known = {**forward.description.standing, **angles}
    targets = np.array([known.get(name, 0.0) for name in tree.motors])
    feet = forward.posture(targets).positions_feet_in_torso
    x, y, _ = feet.mean(axis=0)
    names = [tree.followers.get(name, name) for name in tree.joints]
    joints = (known.get(name, 0.0) for name in names)
    place = -x, -y, -feet[:, 2].min(), 1.0, 0.0, 0.0, 0.0
    return InitialPosture(tree.motors, targets, np.array([*place, *joints]))


class GravityFilter(AttitudeFilter):
    """Attitude filter of a robot that sways while it stands.

    Standing does not calibrate its gyro: at first the accelerometer counts
    more. The known acceleration is that of a turning velocity.
    """

    def __init__(self, velocity: Array, duration: float) -> None:
        """Begin upright; the velocity of the torso is read at each update."""
        super().__init__(FIRST, 0.0, calibration=0.0)
        self._velocity, self._duration, self._time = velocity, duration, 0.0

    @property
    def knows(self) -> bool:
        """Whether the robot has stood long enough for the direction."""
        return self._time >= CALIBRATION - 1e-9

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch of the torso, in [rad]."""
        return self.roll, self.pitch

    def take(self, gyro: Array, specific_force: Array) -> None:
        """Update the direction with one reading; see :meth:`update`."""
        if not self.knows:
            self._time += self._duration
        elif self.gains.item(0) == FIRST:
            self.gains[:] = CORRECTION, BIAS_CORRECTION
        turn = self.turning.item(0)
        ahead, left = self._velocity[:2].tolist()
        known = -left * turn, ahead * turn
        self.update(gyro, specific_force, known, self._duration)

    def adopt(self, tilt: tuple[float, float]) -> None:
        """Replace the direction by the estimate of the robot itself.

        It is known at once then.
        """
        self.lean(*tilt)
        self._time = CALIBRATION


class PolicyLegs:
    """Walking policy on the sensors of one robot.

    The policy runs at a multiple of the control tick. Its command is the
    inverse of the measured response; what is missing is learned from the gyro
    and the leg odometry.
    """

    def __init__(
        self,
        contract: PolicyContract,
        network: PolicyNetwork,
        description: RobotDescription,
        *,
        tick: float,
        response: VelocityResponse | None = None,
        learns: bool = True,
    ) -> None:
        """Begin in the default posture.

        ``learns``: Whether velocities are corrected by gyro and odometry.
        """
        ratio = contract.period / tick
        if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-6:
            raise PolicyError(
                f"legs: tick must divide the period of the policy, "
                f"{contract.period:g} [s], got {tick:g}"
            )
        self._every, self._tick = round(ratio), tick
        self.contract = contract
        self.response = response or VelocityResponse.ideal(
            contract.command_ranges
        )
        forward = ForwardKinematics(description)
        joints = [forward.tree.motor_of(name) for name in contract.joints]
        self._joints = np.array(joints)
        self.coupled = tuple(
            [i for i, shared in enumerate(joints) if shared == motor]
            for motor in sorted({m for m in joints if joints.count(m) > 1})
        )
        angles = zip(contract.joints, contract.default_posture, strict=True)
        self.standing = initial_posture(forward, dict(angles))
        self._targets = self.standing.joint_targets.copy()
        self._network = network
        self.odometry = odometry = LegOdometry(
            forward, self._targets, self.response.odometry_ratio
        )
        self._gravity = GravityFilter(odometry.velocity, tick)
        self.pose, self.tilt = odometry.pose, self._gravity.tilt
        self.intended = self._wanted = STILL
        self._intended, wanted = np.zeros(3), np.zeros(3)
        self._motion = motion = BodyMotion(
            *(forward.angles, np.zeros_like(forward.angles), np.zeros(3)),
            *(self._gravity.up, odometry.velocity, np.zeros(3)),
        )
        self._runner = PolicyRunner(contract, network, motion, joints)
        gain = LEARNING if learns else 0.0
        learned = bound(
            *(learn, self._intended, odometry.moved),
            *(np.array([gain, contract.period]), np.zeros(3), wanted),
        )
        invert = self.response.inverse(wanted, motion.command)
        observe, noted = self._runner.loop, odometry.loops
        self._stand = (*noted, observe)
        self._walk = (*noted, learned, invert, observe)
        self._turned, self._ticks = 0.0, 0

    @property
    def ready(self) -> bool:
        """Whether it has stood long enough to know where up is."""
        return self._gravity.knows

    @property
    def velocities(self) -> VelocitySet:
        """Velocities that the legs deliver, and how fast."""
        return self.response.velocities

    @property
    def joint_targets(self) -> Array:
        """Joint targets, in [rad], in the order of the motors."""
        targets = self._runner.targets
        for joints in self.coupled:
            targets[joints] = targets[joints].mean()
        self._targets[self._joints] = targets
        return self._targets

    def update(self, measurement: RobotState, velocity: BodyVelocity) -> Array:
        """Return the joint targets, in [rad], for the nearest velocity."""
        if velocity is not self._wanted:
            self._wanted = velocity
            self.intended = self.velocities.nearest(velocity)
            self._intended[:] = self.intended
        gravity = self._gravity
        gravity.take(measurement.gyro, measurement.accelerometer)
        if measurement.tilt is not None:
            gravity.adopt(measurement.tilt)
        self.tilt = gravity.tilt
        self._turned += gravity.turning.item(0) * self._tick
        if self._ticks % self._every == 0:
            self._decide(measurement)
        self._ticks += 1
        x, y, theta = self.odometry.pose
        self.pose = Pose(x, y, theta + self._turned)
        return self.joint_targets

    def _decide(self, measurement: RobotState) -> None:
        """Run the policy at its own period."""
        period, motion = self.contract.period, self._motion
        turned, self._turned = self._turned, 0.0
        self.odometry.take(measurement, self.tilt, turned, period)
        velocities, spin = measurement.joint_velocities, measurement.gyro
        assert velocities is not None
        if measurement.latest_gyro is not None:
            spin = measurement.latest_gyro
        motion.joint_velocities[:] = velocities
        motion.angular_velocity[:] = spin
        stands = self.intended == STILL
        if stands:
            motion.command.fill(0.0)
        for loop in self._stand if stands else self._walk:
            loop()
        runner = self._runner
        seen = runner.observation()
        runner.act(*self._network.evaluate(seen, runner.memory))


CACHE_SIZE = 16  # contracts that are cached
_read: dict[tuple[object, ...], tuple[PolicyContract, PolicyNetwork]] = {}


def load_policy(
    legs: LegsSettings,
    description: RobotDescription,
) -> tuple[PolicyContract, PolicyNetwork]:
    """Load a network with its contract for one robot.

    Both are read again when the files of the network change.
    """
    path, robot = Path(legs.network), RobotJoints.of(description)
    key = path, *marks_of(path), legs.contract, str(robot)
    if key not in _read:
        network = PolicyNetwork(path)
        read = read_contract(network, robot, legs.contract).check(), network
        if len(_read) >= CACHE_SIZE:
            _read.clear()
        _read[key] = read
    contract, network = _read[key]
    return contract, copy(network)  # which binds arrays of its own


def load_legs(
    legs: LegsSettings,
    description: RobotDescription,
    *,
    tick: float,
) -> PolicyLegs:
    """Build learned legs, with their measured response if there is one."""
    contract, network = load_policy(legs, description)
    return PolicyLegs(
        contract,
        network,
        description,
        tick=tick,
        response=load_response(description.folder, network.path),
        learns=legs.learn,
    )


VELOCITY_INTERVAL = 0.08  # between decisions on a body velocity, in [s]


def decision_interval(intent: Intent, gait: GaitSettings) -> float:
    """Return the time until the next decision of a walking robot, in [s]."""
    walks_by_heading = intent.velocity is None
    return gait.step_duration if walks_by_heading else VELOCITY_INTERVAL


class PolicyWalk:
    """Walk of one robot by a policy, with decisions at fixed intervals."""

    begun: StepStarted | None = None  # none: a policy plans no steps
    maneuvers: None = None  # likewise
    heading_delay = pose_delay = 0.0
    feels = True

    def __init__(
        self,
        legs: PolicyLegs,
        gait: GaitSettings,
        guard: VelocityGuard | None = None,
    ) -> None:
        """Begin standing, with a guard against obstacles, if any."""
        self.legs, self.gait, self._guard = legs, gait, guard
        self.phase = Phase.STANDING
        self._velocity = STILL
        self._next_decision = 0.0

    @property
    def joint_targets(self) -> Array:
        """Joint targets of the last tick, in [rad]. Shape (joints,)."""
        return self.legs.joint_targets

    @property
    def velocities(self) -> VelocitySet:
        """Velocities that it delivers, and how fast."""
        return self.legs.velocities

    @property
    def torso_heading(self) -> float:
        """Heading of the torso in odometry, in [rad]."""
        return self.legs.pose.theta

    @property
    def pose(self) -> Pose:
        """Pose of the template: place of the CoM and heading of the torso."""
        return self.legs.pose

    @property
    def tilt(self) -> tuple[float, float] | None:
        """Roll and pitch of the torso, in [rad]."""
        return self.legs.tilt

    def step(self, now: float) -> CurrentStep:
        """Return a step that rests on the loaded foot: none is planned."""
        support, side = self.legs.odometry.stance
        return resting_step(support, side.other)

    @property
    def support(self) -> Pose:
        """Left foot of a robot that stands at the present pose."""
        half = 0.5 * self.gait.foot_spacing
        return self.legs.pose.compose(Pose(0.0, half, 0.0))

    def decides(self, now: float) -> bool:
        """Return whether a decision is due at a tick, at a time in [s]."""
        if self.phase is Phase.STANDING:
            return self.legs.ready
        return now >= self._next_decision - 1e-9

    def next_step(self, now: float) -> tuple[float, Pose, Foot] | None:
        """Return time [s] and support of a step to decide on, if any is."""
        return (now, self.support, Foot.LEFT) if self.decides(now) else None

    def coast(self, now: float) -> None:
        """Return None: every tick needs a measurement."""

    def note(self, measurement: RobotState) -> None:
        """Update the known obstacles, before a decision."""
        if self._guard is not None:
            self._guard.note(measurement, self.pose)

    def update(
        self, measurement: RobotState, decisions: IntentSource
    ) -> Array:
        """Return the joint targets of a tick, in [rad]; decide if due."""
        now = measurement.time
        stands = self.phase is Phase.STANDING
        if self.decides(now) and (not stands or decisions.starts(now)):
            self._decide(now, decisions)
        return self.legs.update(measurement, self._velocity)

    def _decide(self, now: float, decisions: IntentSource) -> None:
        """Request a decision, and follow it until the next one."""
        moving = self.phase is not Phase.STANDING
        request = decisions.decide(now, self.support, Foot.LEFT, moving=moving)
        self._velocity, interval = STILL, self.gait.step_duration
        if request is not None:
            self._velocity = template_velocity(request, self.gait)
            interval = decision_interval(request.intent, self.gait)
        if self._guard is not None:
            self._velocity = self._guard.admit(
                self._velocity, self.legs.pose, interval
            )
        walks = self._velocity != STILL
        self.phase = Phase.WALKING if walks else Phase.STANDING
        self._next_decision = now + interval
