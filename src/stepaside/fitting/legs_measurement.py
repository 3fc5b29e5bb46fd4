"""Measurement of learned legs: what velocities commands lead to."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from math import hypot, isfinite, nan
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import PolicyError
from ..core.poses import Array, Pose
from ..core.random_streams import named_generator
from ..games.robot_placing import RobotSetup, policy_physics
from ..locomotion.control_settings import LegsSettings
from ..locomotion.policy.contract import CommandRanges
from ..locomotion.policy.policy_legs import PolicyLegs, load_policy
from ..locomotion.policy.velocity_response import (
    AxisResponse,
    VelocityResponse,
)
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..sim.body_settings import BodySettings, at_tick
from ..sim.physics_settings import PhysicsSettings
from ..sim.world import World
from ..strategies.shield import TemplatePoint
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


class LegsTrial(NamedTuple):
    """One walk of a robot on a policy."""

    description: RobotDescription
    legs: LegsSettings  # walking policy
    body: BodySettings  # deviations of the body from an ideal one
    command: BodyVelocity  # command of the policy, where it is constant
    seed: int  # seed of sensor errors and of random commands
    # response by which velocities are commanded; None for commands as they are
    response: VelocityResponse | None = None


class LegsTrialResult(NamedTuple):
    """Motion of one walk at a constant command."""

    command: BodyVelocity
    # mean velocity of the steady walk; NaN after a fall
    delivered: BodyVelocity
    lag: float  # behind the final velocity [s]; NaN after a fall
    halting: float  # way from command to rest [m] or [rad]
    fell_at: float | None  # time of a fall [s]; None without one
    odometry: tuple[float, float] = (0.0, 0.0)  # by the legs [m/s]


class LegsMotion(NamedTuple):
    """Recorded walk, a row for each tick and one for the end."""

    poses: Array  # of the reference point in the world (n + 1, 3)
    estimates: Array  # of the leg odometry (n + 1, 3)
    wanted: list[BodyVelocity]
    tick: float  # [s]
    fell_at: float | None  # [s]


def _walk(
    trial: LegsTrial,
    wanted_at: Callable[[float], BodyVelocity],
    duration: float,
) -> LegsMotion:
    """Walk alone in a world from the default posture of the policy."""
    description = trial.description
    setup = RobotSetup(
        "robot",
        description,
        GaitSettings(zmp_forward=0.0),
        legs=trial.legs,
        seed=trial.seed,
    )
    physics = policy_physics(PhysicsSettings(), trial.body, [setup])
    setup = setup._replace(body=at_tick(trial.body, physics.tick))
    world = World({"robot": description}, physics, trial.body, trial.seed)
    legs = PolicyLegs(
        *load_policy(trial.legs, description),
        description,
        tick=physics.tick,
        response=trial.response,
        learns=trial.response is not None,
    )
    truth = setup.true_state_in(world)
    robot = setup._replace(truth=truth).place(world, legs)
    mujoco.mj_forward(world.model, world.data)
    poses, estimates, wanted = [], [], []
    while True:
        x, y = truth.position_reference_in_world
        poses.append((x, y, truth.heading_in_world))
        estimates.append(legs.pose)
        fell_at = world.time if truth.has_fallen else None
        if fell_at is not None or world.time >= duration:
            break
        wanted.append(wanted_at(world.time))
        robot.write(legs.update(robot.read(), wanted[-1]))
        world.step()
    rows = np.array(poses), np.array(estimates)
    return LegsMotion(*rows, wanted, physics.tick, fell_at)


def run_trial(trial: LegsTrial) -> LegsTrialResult:
    """Walk at a constant command from rest to rest."""
    command, ends = trial.command, STANDING + SETTLING + STEADY

    def wanted_at(now: float) -> BodyVelocity:
        return command if STANDING <= now + 1e-9 < ends else STILL

    motion = _walk(trial, wanted_at, ends + HALTING)
    if motion.fell_at is not None:
        nothing = BodyVelocity(nan, nan, nan)
        return LegsTrialResult(command, nothing, nan, nan, motion.fell_at)
    result = _evaluate(command, motion.poses, motion.tick)
    estimated = _evaluate(command, motion.estimates, motion.tick)
    return result._replace(odometry=estimated.delivered[:2])


def _drawn(
    generator: np.random.Generator,
    ranges: Sequence[tuple[float, float]],
    nearest: Callable[[BodyVelocity], BodyVelocity],
) -> Callable[[float], BodyVelocity]:
    """Return velocities drawn from ranges by time, held for 1 to 4 s."""
    low, high = np.array(ranges).T
    wanted, until = STILL, STANDING

    def wanted_at(now: float) -> BodyVelocity:
        nonlocal wanted, until
        if now + 1e-9 >= until:
            drawn = BodyVelocity(*generator.uniform(low, high).tolist())
            wanted, until = nearest(drawn), until + generator.uniform(*HOLDS)
        return wanted

    return wanted_at


def run_random_walk(trial: LegsTrial) -> float | None:
    """Walk for a minute at random commands of the contract.

    Time of a fall, in [s]; None without one.
    """
    ranges = load_policy(trial.legs, trial.description)[0].command_ranges
    generator = named_generator(trial.seed, "random walk")
    commands = _drawn(generator, ranges, lambda drawn: drawn)
    return _walk(trial, commands, RANDOM_WALK).fell_at


def run_tracking_walk(trial: LegsTrial) -> float:
    """Walk at random velocities; return the tube of the body.

    Greatest distance of the body from its template point, see
    :mod:`stepaside.strategies.shield`, in [m]; NaN after a fall.
    """
    assert trial.response is not None
    legs = trial.response.velocities
    generator = named_generator(trial.seed, "tracking walk")
    velocities = _drawn(generator, legs[:3], legs.nearest)
    motion = _walk(trial, velocities, TRACKING_WALK)
    if motion.fell_at is not None:
        return nan
    lag, tube = max(legs.lags[:2]), 0.0
    (x, y, theta), *after = motion.poses.tolist()
    template = TemplatePoint((x, y))
    for wanted, (x, y, heading) in zip(motion.wanted, after, strict=True):
        u, v, _ = Pose(0.0, 0.0, theta).compose(Pose(*wanted[:2], 0.0))
        template = template.advance((u, v), (x, y), lag, motion.tick)
        u, v = template.position
        tube, theta = max(tube, hypot(x - u, y - v)), heading
    return tube


def _evaluate(
    command: BodyVelocity, poses: Array, tick: float
) -> LegsTrialResult:
    """Evaluate the poses of a walk without a fall, a row for each tick."""
    x, y, heading = poses.T
    heading = np.unwrap(heading)
    middle = 0.5 * (heading[1:] + heading[:-1])
    dx, dy = np.diff(x), np.diff(y)
    ahead = np.cos(middle) * dx + np.sin(middle) * dy
    aside = np.cos(middle) * dy - np.sin(middle) * dx
    moved = np.stack([ahead, aside, np.diff(heading)], axis=1)
    times = np.cumsum([STANDING, SETTLING, STEADY])
    begins, steady, ends = (round(time / tick) for time in times)
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
    """Return the commands of a measurement: each axis, then combinations."""
    singles = [
        tuple(share if axis == i else 0.0 for i in range(3))
        for axis in range(3)
        for share in SHARES
    ]
    commands = [STILL]
    for shares in (*singles, *COMBINED):
        command = BodyVelocity(
            *(
                share * (high if share > 0 else -low)
                for share, (low, high) in zip(shares, ranges, strict=True)
            )
        )
        if any(command):
            commands.append(command)
    return commands


@dataclass(frozen=True, slots=True)
class LegsMeasurement:
    """Measured response of a robot's learned legs."""

    trials: tuple[LegsTrialResult, ...]  # results of all walks
    response: VelocityResponse
    combined_error: tuple[float, float]  # [m/s] [rad/s]
    # time of the fall in each walk at random commands [s]; None without one
    random_walks: tuple[float | None, ...] = ()

    @property
    def falls(self) -> int:
        """Number of walks that ended in a fall."""
        return sum(trial.fell_at is not None for trial in self.trials)

    def gains(self) -> Array:
        """Return the slopes of delivered velocities by commands. (3, 3)."""
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
    """Walk a grid of commands, and tabulate the velocities that result."""
    contract, _ = load_policy(legs, description)
    base = LegsTrial(description, legs, body, STILL, seed)
    commands = trial_commands(contract.command_ranges)
    walks = len(commands) + random_walks
    results = []
    for result in executor.map(
        run_trial, [base._replace(command=command) for command in commands]
    ):
        results.append(result)
        report(len(results), walks)
    if results[0].fell_at is not None:
        raise PolicyError(
            f"legs: the robot fell at {results[0].fell_at:.2f} s while it "
            "was to stand: the contract does not fit the network"
        )
    singles, combined = results[: -len(COMBINED)], results[-len(COMBINED) :]
    response = VelocityResponse(
        _axis(0, singles),
        _axis(1, singles),
        _axis(2, singles),
        odometry_ratio=_odometry_ratio(results),
    )
    tracking = base._replace(response=response)
    tubes = executor.map(
        run_tracking_walk,
        [tracking._replace(seed=seed + i) for i in range(TRACKING_WALKS)],
    )
    tube = max((each for each in tubes if isfinite(each)), default=0.0)
    response = replace(response, tube=tube)
    falls = []
    for fall in executor.map(
        run_random_walk,
        [base._replace(seed=seed + i) for i in range(random_walks)],
    ):
        falls.append(fall)
        report(len(results) + len(falls), walks)
    error = _combined_error(response, combined)
    return LegsMeasurement(tuple(results), response, error, tuple(falls))


def _axis(axis: int, results: list[LegsTrialResult]) -> AxisResponse:
    """Return the response along one axis, as far as it ascends."""
    own = [r for r in results if not any(np.delete(r.command, axis))]
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
