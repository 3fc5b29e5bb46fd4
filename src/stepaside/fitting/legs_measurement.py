"""Measurement of learned legs: what velocities commands lead to."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from math import hypot, isfinite
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import PolicyError
from ..core.poses import Array, Pose
from ..core.random_streams import named_generator
from ..games.policy_player import place_on_legs, policy_physics
from ..games.walker_factory import WalkerSetup
from ..locomotion.policy.contract import CommandRanges
from ..locomotion.policy.legs_loader import load_policy
from ..locomotion.policy.legs_settings import LegsSettings
from ..locomotion.policy.policy_legs import PolicyLegs
from ..locomotion.policy.velocity_response import (
    AXES,
    AxisResponse,
    VelocityResponse,
)
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..sim.body_settings import BodySettings, at_tick
from ..sim.physics_settings import PhysicsSettings
from ..sim.world import World
from ..strategies.shield_template import TemplatePoint
from ..strategies.velocity_set import STILL, BodyVelocity

STANDING = 1.5  # before the command, in [s]: the gyro is calibrated in 1 s
SETTLING = 3.0  # from the command to a steady walk, in [s]
STEADY = 6.0  # over which the velocity is averaged, in [s]
RANDOM_WALK = 60.0  # of random commands, in [s]
HOLDS = 1.0, 4.0  # shortest and longest time of a random command, in [s]
TRACKING_WALK = 40.0  # of random velocities, in [s]
TRACKING_WALKS = 3
HALTING = 2.0  # from the end of the command to the end of a trial, in [s]
SHARES = (-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0)
# Combined commands, as shares of the range, that check the sum of the axes.
COMBINED = (
    (0.7, 0.0, 0.4),
    (0.7, 0.0, -0.4),
    (-0.7, 0.0, 0.4),
    (-0.7, 0.0, -0.4),
    (0.5, 0.5, 0.0),
)


@dataclass(frozen=True, slots=True)
class LegsTrial:
    """One walk at a constant command.

    Attributes:
        description: Description of the robot.
        legs: Walking policy.
        body: Deviations of the body from an ideal one.
        command: Command of the policy.
        seed: Seed of sensor errors.
        response: Response by which velocities are commanded; None for
            commands as they are.
    """

    description: RobotDescription
    legs: LegsSettings
    body: BodySettings
    command: BodyVelocity
    seed: int
    response: VelocityResponse | None = None


class LegsTrialResult(NamedTuple):
    """Motion of one walk at a constant command.

    Attributes:
        command: Command of the policy.
        delivered: Mean velocity of the steady walk; NaN after a fall.
        lag: Time by which the motion along the greatest component is behind
            that of the final velocity, in [s]; NaN after a fall.
        halting: Motion along it from the end of the command to rest, in [m]
            or [rad]; NaN after a fall.
        fell_at: Time of a fall, in [s]; None without one.
        odometry: Mean horizontal velocity of the steady walk by the leg
            odometry (ahead, to the left), in [m/s].
    """

    command: BodyVelocity
    delivered: BodyVelocity
    lag: float
    halting: float
    fell_at: float | None
    odometry: tuple[float, float] = (0.0, 0.0)


def run_trial(trial: LegsTrial) -> LegsTrialResult:
    """Walk at a constant command from rest to rest.

    Raises:
        PolicyError: If the network cannot run on the robot.
    """
    walk = _LegsWalk(trial)
    tick = walk.world.physics.tick
    ends = STANDING + SETTLING + STEADY
    poses, estimates = [], []
    while walk.world.time < ends + HALTING:
        walks = STANDING <= walk.world.time + 1e-9 < ends
        place = walk.truth.position_reference_in_world
        poses.append((*place, walk.truth.heading_in_world))
        estimates.append(walk.legs.pose)
        if not walk.advance(trial.command if walks else STILL):
            nothing = BodyVelocity(*[float("nan")] * 3)
            fell_at = walk.world.time
            return LegsTrialResult(
                trial.command, nothing, nothing[0], nothing[0], fell_at
            )
    result = _evaluate(trial.command, np.array(poses), tick)
    estimated = _evaluate(trial.command, np.array(estimates), tick)
    return result._replace(odometry=estimated.delivered[:2])


def run_random_walk(trial: LegsTrial) -> float | None:
    """Walk for a minute at commands that change at random.

    Each command is drawn from the ranges of the contract, and holds for 1 to
    4 s. The seed of the trial decides; its command does not matter.

    Returns:
        Time of a fall, in [s]; None without one.

    Raises:
        PolicyError: If the network cannot run on the robot.
    """
    walk = _LegsWalk(trial)
    generator = named_generator(trial.seed, "random walk")
    low, high = np.array(walk.legs.contract.command_ranges).T
    command, until = STILL, STANDING
    while walk.world.time < RANDOM_WALK:
        if walk.world.time + 1e-9 >= until:
            command = BodyVelocity(*generator.uniform(low, high).tolist())
            until += float(generator.uniform(*HOLDS))
        if not walk.advance(command):
            return walk.world.time
    return None


def run_tracking_walk(trial: LegsTrial) -> float:
    """Walk at random velocities; return the tube of the body.

    Velocities are drawn from the set that the legs deliver, and hold for 1 to
    4 s.

    Returns:
        Greatest distance of the body from its template point, see
        :mod:`stepaside.strategies.shield_template`, in [m]; NaN after a fall.

    Raises:
        PolicyError: If the network cannot run on the robot.
    """
    assert trial.response is not None
    walk, legs = _LegsWalk(trial), trial.response.velocities
    generator = named_generator(trial.seed, "tracking walk")
    low, high = np.array(legs[:3]).T
    wanted, until, tick = STILL, STANDING, walk.world.physics.tick
    lag = max(legs.lags[:2])
    template = TemplatePoint(walk.truth.position_reference_in_world)
    tube = 0.0
    while walk.world.time < TRACKING_WALK:
        if walk.world.time + 1e-9 >= until:
            drawn = BodyVelocity(*generator.uniform(low, high).tolist())
            wanted = legs.nearest(drawn)
            until += float(generator.uniform(*HOLDS))
        theta = walk.truth.heading_in_world
        u, v, _ = Pose(0.0, 0.0, theta).compose(Pose(*wanted[:2], 0.0))
        if not walk.advance(wanted):
            return float("nan")
        body = walk.truth.position_reference_in_world
        template = template.advance((u, v), body, lag, tick)
        x, y = template.position
        tube = max(tube, hypot(body[0] - x, body[1] - y))
    return tube


class _LegsWalk:
    """Robot on a policy in a world of its own.

    Attributes:
        world: World with the robot.
        legs: Learned legs.
        truth: True state of the robot.
    """

    def __init__(self, trial: LegsTrial) -> None:
        """Stand in the default posture of the policy."""
        description = trial.description
        physics = policy_physics(
            PhysicsSettings(), trial.body, [(trial.legs, description)]
        )
        contract, network = load_policy(trial.legs, description)
        self.world = World(
            {"robot": description}, physics, trial.body, trial.seed
        )
        self.legs = PolicyLegs(
            contract,
            network,
            description,
            tick=physics.tick,
            response=trial.response,
            learns=trial.response is not None,
        )
        setup = WalkerSetup(
            "robot",
            description,
            GaitSettings(zmp_forward=0.0),
            ControlSettings(),
            at_tick(trial.body, physics.tick),
            Pose(0.0, 0.0, 0.0),
            trial.seed,
        )
        self.truth = setup.true_state_in(self.world)
        self._robot = place_on_legs(
            self.world, setup, self.legs, truth=self.truth
        )
        mujoco.mj_forward(self.world.model, self.world.data)

    def advance(self, command: BodyVelocity) -> bool:
        """Run one tick; return whether the robot stands."""
        if self.truth.has_fallen:
            return False
        self._robot.write(self.legs.update(self._robot.read(), command))
        self.world.step()
        return True


def _evaluate(
    command: BodyVelocity, poses: Array, tick: float
) -> LegsTrialResult:
    """Evaluate the poses of a walk without a fall.

    Args:
        command: Command of the policy.
        poses: Pose (x, y, heading) at each tick. Shape (n, 3).
        tick: Time between poses, in [s].
    """
    x, y, heading = poses.T
    heading = np.unwrap(heading)
    middle = 0.5 * (heading[1:] + heading[:-1])
    dx, dy = np.diff(x), np.diff(y)
    moved = np.stack(
        [
            np.cos(middle) * dx + np.sin(middle) * dy,
            np.cos(middle) * dy - np.sin(middle) * dx,
            np.diff(heading),
        ],
        axis=1,
    )
    begins, steady, ends = (
        round(time / tick)
        for time in (
            STANDING,
            STANDING + SETTLING,
            STANDING + SETTLING + STEADY,
        )
    )
    velocity = moved[steady:ends].sum(axis=0) / STEADY
    axis = int(np.argmax(np.abs(command)))
    final = float(velocity[axis])
    lag = halting = 0.0
    if command != STILL and abs(final) > 1e-3:
        walked = float(moved[begins:ends, axis].sum())
        lag = SETTLING + STEADY - walked / final
        halting = float(moved[ends:, axis].sum())
    delivered = BodyVelocity(*velocity.tolist())
    return LegsTrialResult(command, delivered, lag, halting, None)


def trial_commands(ranges: CommandRanges) -> list[BodyVelocity]:
    """Return the commands of a measurement: each axis, then combinations.

    Args:
        ranges: Ranges of the commands.
    """
    commands = [STILL]
    for name, (low, high) in zip(AXES, ranges, strict=True):
        values = (share * (high if share > 0 else -low) for share in SHARES)
        commands += [
            STILL._replace(**{name: value}) for value in values if value
        ]
    for shares in COMBINED:
        values = (
            share * (high if share > 0 else -low)
            for share, (low, high) in zip(shares, ranges, strict=True)
        )
        commands.append(BodyVelocity(*values))
    return commands


@dataclass(frozen=True, slots=True)
class LegsMeasurement:
    """Measured response of a robot's learned legs.

    Attributes:
        trials: Results of all walks.
        response: Response by axis, without commands that led to a fall and
            those beyond which the velocity does not increase.
        combined_error: Greatest difference between the velocity of a combined
            command and the sum of its axes: of the horizontal velocity, in
            [m/s], and of the turning rate, in [rad/s].
        random_walks: Time of the fall in each walk at random commands, in
            [s]; None without one.
    """

    trials: tuple[LegsTrialResult, ...]
    response: VelocityResponse
    combined_error: tuple[float, float]
    random_walks: tuple[float | None, ...] = ()

    @property
    def falls(self) -> int:
        """Number of walks that ended in a fall."""
        return sum(trial.fell_at is not None for trial in self.trials)

    def gains(self) -> Array:
        """Return the linear fit of delivered velocities to commands.

        Returns:
            Row by delivered component, column by commanded axis: the slope
            through the origin. Shape (3, 3).
        """
        columns = []
        for axis in self.response.axes:
            commands = np.array(axis.commands)
            rows = np.array(axis.delivered)
            rows = rows - rows[axis.commands.index(0.0)]
            columns.append(commands @ rows / (commands @ commands))
        return np.stack(columns, axis=1)


def measure_legs(
    description: RobotDescription,
    legs: LegsSettings,
    body: BodySettings,
    executor: Executor,
    report: Callable[[int, int], None],
    *,
    seed: int = 1,
    random_walks: int = 0,
) -> LegsMeasurement:
    """Walk a grid of commands, and tabulate the velocities that result.

    Args:
        description: Description of the robot.
        legs: Walking policy.
        body: Deviations of the body from an ideal one.
        executor: Runs the walks.
        report: Called with the number of finished walks and of all walks.
        seed: Seed of sensor errors, and the first one of random commands.
        random_walks: Number of walks at random commands.

    Raises:
        PolicyError: If the network cannot run on the robot, the robot falls
            while it is to stand, or an axis does not follow its command.
    """
    contract, _ = load_policy(legs, description)
    commands = trial_commands(contract.command_ranges)
    trials = [
        LegsTrial(description, legs, body, command, seed)
        for command in commands
    ]
    results = []
    for result in executor.map(run_trial, trials):
        results.append(result)
        report(len(results), len(trials) + random_walks)
    if results[0].fell_at is not None:
        raise PolicyError(
            f"legs: the robot fell at {results[0].fell_at:.2f} s while it "
            "was to stand: the contract does not fit the network"
        )
    random = [
        LegsTrial(description, legs, body, STILL, seed + i)
        for i in range(random_walks)
    ]
    singles = results[: -len(COMBINED)]
    axes = [_axis(i, singles) for i in range(3)]
    ratio = _odometry_ratio(results)
    response = VelocityResponse(
        axes[0], axes[1], axes[2], odometry_ratio=ratio
    )
    tracking = [
        LegsTrial(description, legs, body, STILL, seed + i, response)
        for i in range(TRACKING_WALKS)
    ]
    tubes = list(executor.map(run_tracking_walk, tracking))
    kept = [tube for tube in tubes if isfinite(tube)]
    response = replace(response, tube=max(kept, default=0.0))
    falls = []
    for fall in executor.map(run_random_walk, random):
        falls.append(fall)
        report(len(trials) + len(falls), len(trials) + random_walks)
    return LegsMeasurement(
        tuple(results),
        response,
        _combined_error(response, results[-len(COMBINED) :]),
        tuple(falls),
    )


def _axis(axis: int, results: list[LegsTrialResult]) -> AxisResponse:
    """Return the response along one axis, as far as it ascends."""
    own = [
        result
        for result in results
        if all(
            value == 0.0 for k, value in enumerate(result.command) if k != axis
        )
    ]
    own.sort(key=lambda result: result.command[axis])
    rest = next(i for i, r in enumerate(own) if r.command == STILL)
    kept = [own[rest]]
    for steps in (own[rest + 1 :], own[rest - 1 :: -1] if rest else []):
        for result in steps:
            sign = 1.0 if result.command[axis] > 0.0 else -1.0
            last = kept[-1] if sign > 0.0 else kept[0]
            gained = result.delivered[axis] - last.delivered[axis]
            if result.fell_at is not None or not sign * gained > 0.0:
                break
            kept = [*kept, result] if sign > 0.0 else [result, *kept]
    lags = [r.lag for r in (kept[0], kept[-1]) if r.command != STILL]
    halts = [abs(r.halting) for r in (kept[0], kept[-1])]
    return AxisResponse(
        tuple(result.command[axis] for result in kept),
        tuple(result.delivered for result in kept),
        max(0.0, float(np.mean(lags))) if lags else 0.0,
        max(halts),
    )


def _odometry_ratio(results: list[LegsTrialResult]) -> tuple[float, float]:
    """Fit the true motion by that of the leg odometry, ahead and aside."""
    walks = [result for result in results if result.fell_at is None]
    true = np.array([walk.delivered[:2] for walk in walks])
    estimated = np.array([walk.odometry for walk in walks])
    products, squares = (true * estimated).sum(0), (estimated**2).sum(0)
    ahead, side = np.divide(
        products, squares, out=np.ones(2), where=squares > 0.0
    ).tolist()
    return ahead, side


def _combined_error(
    response: VelocityResponse, results: list[LegsTrialResult]
) -> tuple[float, float]:
    """Compare combined commands with the sum of their axes."""
    horizontal, turning = [0.0], [0.0]
    for result in results:
        if result.fell_at is None:
            expected = response.deliver(result.command)
            errors = np.subtract(result.delivered, expected)
            horizontal.append(hypot(*errors[:2].tolist()))
            turning.append(abs(float(errors[2])))
    return max(horizontal), max(turning)
