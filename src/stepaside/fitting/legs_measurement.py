"""Measurement of learned legs: what velocities commands lead to."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from math import nan
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import PolicyError
from ..core.poses import Array, Pose
from ..core.random_streams import named_generator
from ..games.physics_world import RobotSetup
from ..games.player_settings import PlayerSettings
from ..games.policy_physics import policy_physics
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
from ..sim.outline_measurement import reach_of, solid_geoms
from ..sim.physics_settings import PhysicsSettings
from ..sim.world import World
from ..strategies.body_departure import BodyDeparture
from ..strategies.shield import LEGS_INTERVAL, TemplatePoint
from ..strategies.velocity_set import STILL, BodyVelocity
from .departure_measurement import EVERY, DepartureRecord, combined

SETTLED = 1.0  # until a body rests on its feet after its begin, in [s]
STANDING = 1.5  # before the command, in [s]: the gyro is calibrated in 1 s
SETTLING = 3.0  # from the command to a steady walk, in [s]
STEADY = 6.0  # over which the velocity is averaged, in [s]
HALTING = 2.0  # from the end of the command to the end of a trial, in [s]
TRACKING_WALK = 40.0  # of random velocities, in [s]
TRACKING_WALKS = 3
HOLDS = 1.0, 4.0  # shortest and longest time of a random velocity, in [s]
SHARES = (-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0)


class LegsTrial(NamedTuple):
    """One walk of a robot on a policy."""

    description: RobotDescription
    legs: LegsSettings  # walking policy
    body: BodySettings  # deviations of the body from an ideal one
    seed: int  # of sensor errors and of random velocities
    command: BodyVelocity = STILL  # of the policy, where it is constant
    # by which velocities are commanded; None for commands as they are
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
    torsos: list[tuple[float, float]]  # midway between the hips, likewise
    wanted: list[BodyVelocity]
    tick: float  # [s]
    fell_at: float | None  # [s]
    reach: float  # around the torso of all of the body; 0 if not asked for


class LegsMeasurement(NamedTuple):
    """Measured response of a robot's learned legs."""

    trials: list[LegsTrialResult]  # walks at constant commands
    response: VelocityResponse
    falls: int  # of these walks, and of those at random velocities

    def gains(self) -> Array:
        """Return the slopes of delivered velocities by commands. (3, 3)."""
        columns = []
        for axis in self.response.axes:
            commands = np.array(axis.commands)
            rows = np.array(axis.delivered)
            rows = rows - rows[axis.commands.index(0.0)]
            columns.append(commands @ rows / (commands @ commands))
        return np.stack(columns, axis=1)


def _walk(
    trial: LegsTrial,
    wanted_at: Callable[[float], BodyVelocity],
    duration: float,
    *,
    reaches: bool = False,
) -> LegsMotion:
    """Walk alone in a world from the default posture of the policy."""
    description = trial.description
    gait = GaitSettings(zmp_forward=0.0)
    own = PlayerSettings("robot", gait=gait, legs=trial.legs)
    setup = RobotSetup(own, description, seed=trial.seed)
    walked = [(trial.legs, description)]
    physics = policy_physics(PhysicsSettings(), trial.body, walked)
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
    poses, estimates, torsos, wanted, reach = [], [], [], [], 0.0
    root = world.model.body(f"robot/{description.torso}").rootid[0]
    geoms = solid_geoms(world.model, int(root))
    while True:
        x, y = truth.position_reference_in_world
        poses.append((x, y, truth.heading_in_world))
        torsos.append(truth.position_torso_in_world)
        if reaches and world.ticks % EVERY == 0:
            found = reach_of(world.model, world.data, geoms, torsos[-1])
            reach = max(reach, found)
        fell_at = world.time if truth.has_fallen else None
        if fell_at is not None or world.time >= duration:
            estimates.append(legs.pose)
            break
        wanted.append(wanted_at(world.time))
        robot.write(legs.update(robot.read(), wanted[-1]))
        estimates.append(legs.pose)
        world.step()
    rows = np.array(poses), np.array(estimates), torsos
    return LegsMotion(*rows, wanted, physics.tick, fell_at, reach)


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


def run_tracking_walk(trial: LegsTrial) -> BodyDeparture | None:
    """Walk at random velocities; return the departure of the body.

    That from its template point, see :mod:`stepaside.strategies.shield`; None
    after a fall.
    """
    assert trial.response is not None
    legs = trial.response.velocities
    low, high = np.array(legs[:3]).T
    generator = named_generator(trial.seed, "tracking walk")
    present, until = STILL, STANDING

    def wanted_at(now: float) -> BodyVelocity:
        nonlocal present, until
        if now + 1e-9 >= until:
            drawn = BodyVelocity(*generator.uniform(low, high).tolist())
            present, until = (
                legs.nearest(drawn),
                until + generator.uniform(*HOLDS),
            )
        return present

    motion = _walk(trial, wanted_at, TRACKING_WALK, reaches=True)
    if motion.fell_at is not None:
        return None
    record, every = DepartureRecord(), round(LEGS_INTERVAL / motion.tick)
    record.reach = motion.reach
    first = round(SETTLED / motion.tick)
    before = motion.estimates[first].tolist()
    template, command = TemplatePoint((before[0], before[1])), (0.0, 0.0)
    for i in range(first, len(motion.wanted)):
        now, wanted = i * motion.tick, motion.wanted[i]
        body, late = (Pose(*motion.estimates[j].tolist()) for j in (i, i - 1))
        if (i - first) % every == 0:
            if i > first:  # its pose is known a tick late
                template = template.advance(
                    command, late[:2], legs, LEGS_INTERVAL
                )
            turned = Pose(0.0, 0.0, body.theta)
            command = turned.compose(Pose(*wanted[:2], 0.0))[:2]
            record.decide(now, Pose(*template.position, 0.0), moving=True)
        true = Pose(*motion.poses[i].tolist())
        record.note(now, true, body, motion.torsos[i])
    return record.departure()


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
    """Return the commands of a measurement: none, then along each axis."""
    commands = [STILL]
    for axis, (low, high) in enumerate(ranges):
        for share in SHARES:
            value = share * (high if share > 0.0 else -low)
            if value:
                row = [value if i == axis else 0.0 for i in range(3)]
                commands.append(BodyVelocity(*row))
    return commands


def measure_legs(
    description: RobotDescription,
    legs: LegsSettings,
    body: BodySettings,
    executor: Executor,
    report: Callable[[int, int], None],
    *,
    seed: int = 1,
) -> LegsMeasurement:
    """Walk a grid of commands, and tabulate the velocities that result."""
    contract, _ = load_policy(legs, description)
    base = LegsTrial(description, legs, body, seed)
    commands = trial_commands(contract.command_ranges)
    walks = len(commands) + TRACKING_WALKS
    results: list[LegsTrialResult] = []
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
    forward, lateral, turn = (_axis(axis, results) for axis in range(3))
    ratio = _odometry_ratio(results)
    response = VelocityResponse(forward, lateral, turn, odometry_ratio=ratio)
    tracking = base._replace(response=response)
    departures: list[BodyDeparture | None] = []
    for departure in executor.map(
        run_tracking_walk,
        [tracking._replace(seed=seed + i) for i in range(TRACKING_WALKS)],
    ):
        departures.append(departure)
        report(len(results) + len(departures), walks)
    upright = [each for each in departures if each is not None]
    falls = sum(result.fell_at is not None for result in results)
    worst = combined(upright)
    return LegsMeasurement(
        results,
        replace(response, **worst._asdict()) if worst else response,
        falls + len(departures) - len(upright),
    )


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
