"""Readings of games for the claims of Sec. III-E, IV and V."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import acos, degrees, inf, nan
from typing import NamedTuple

import numpy as np

from ..arena import RoomRecipe, generate_room
from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..games.floor_games import MARGIN
from ..games.forecast import circle_of_theory, convergence_time
from ..games.game import GameInPlay, GameObserver, Outcome, play
from ..games.game_settings import GameSettings, StartSettings, duel, read_game
from ..games.physics_world import PhysicsWorld
from ..games.player_settings import PLAYERS, PURSUIT
from ..games.players import RobotPlayer
from ..games.recorded_game import RecordedGame, run_game
from ..games.run import Run
from ..games.trajectory import angle_between, distance_between, last_third
from ..planning import PRESETS, GaitSettings
from ..theory.unicycle.circles import fit_circle
from .theory_claims import most_deviating
from .tournament import (
    ASIDE,
    PairingSettings,
    StrategyTrack,
    bound_of,
    clearance,
    play_track,
)


class WalkedPlan(NamedTuple):
    """Plan that was walked until it was replaced."""

    start_time: float  # begin of its motion, not necessarily at a tick [s]
    first_sent_time: float  # tick of the first joint targets of the plan [s]
    from_standing: bool  # whether the robot stood at its begin


@dataclass(frozen=True, slots=True)
class InstrumentedDuel:
    """Duel with records of every control tick, by robot."""

    run: Run  # the duel
    ticks: Array  # times of the control ticks [s]. (n,)
    # loads of left and right foot at the end of each tick [N]. (n, 2)
    loads: dict[str, Array]
    # positions of left and right foot in the world then [m]. (n, 2, 2)
    feet: dict[str, Array]
    # CoM reference of the joint targets of each tick, in odometry [m]. (n, 2)
    references: dict[str, Array]
    plans: dict[str, tuple[WalkedPlan, ...]]  # that were walked


def play_instrumented(settings: GameSettings) -> InstrumentedDuel:
    """Play a duel to its end, as ``run_game`` does, recording every tick."""
    game = RecordedGame(settings)
    world = game.in_physics
    found = {name: _TickObserver(world, name) for name in PLAYERS}
    game.observers += tuple(found.values())
    play(game)
    return InstrumentedDuel(
        game.run().uninterrupted(),
        world.physics.tick * np.arange(world.ticks, dtype=np.float64),
        {name: np.array(own.loads) for name, own in found.items()},
        {name: np.array(own.feet) for name, own in found.items()},
        {name: np.array(own.references) for name, own in found.items()},
        {name: tuple(own.plans) for name, own in found.items()},
    )


class _TickObserver(GameObserver):
    """Observer of one robot of a duel: its state at the end of each tick."""

    def __init__(self, world: PhysicsWorld, name: str) -> None:
        self.loads: list[Array] = []
        self.feet: list[Array] = []
        self.references: list[Array] = []
        self.plans: list[WalkedPlan] = []
        player = world.player(name)
        assert isinstance(player, RobotPlayer)
        self._world, self._robot = world, player.robot
        self._walk = player.scheme.walk

    def acted(self, game: GameInPlay) -> None:
        """Record the plan that begins at this tick."""
        if (begun := self._walk.begun) is not None:
            standing = begun.plan.schedule.standing
            now = self._world.time
            self.plans.append(WalkedPlan(begun.started, now, standing))

    def before(self, game: GameInPlay) -> None:
        """Record the state after the previous tick."""
        if len(self.loads) == self._world.ticks:
            return
        stance = self._robot.stance
        forces = self._robot.foot_forces.reshape(2, -1)  # left, right
        self.loads.append(forces.sum(axis=1))
        soles = stance.left_sole, stance.right_sole
        self.feet.append(np.array([sole[:2] for sole in soles]))
        self.references.append(np.array(self._walk.reference.com[:2]))

    def ended(self, game: GameInPlay) -> None:
        """Record the state after the last tick."""
        self.before(game)


CONTACT_LOAD = 1.0  # load from which a foot is in contact, in [N]
SWING_FRACTION = 0.35  # least swing, as a fraction of the single support
# Time before lift-off at which the plan already unloads a foot, in [s].
UNLOADING = 0.03
FIT_TICKS = 6  # ticks on either side of a replan for the polynomial fit


def swing_intervals(ticks: Array, load: Array, single_support: float) -> Array:
    """Return lift-off and landing of each swing, in [s]. (m, 2).

    Times [s] and loads [N] of a foot have shape (n,). Times without load that
    are shorter than a planned swing are bounces at landing or lift-off.
    """
    on = load > CONTACT_LOAD
    changes = np.flatnonzero(on[1:] != on[:-1]) + 1
    pairs = np.stack([changes[:-1], changes[1:]], axis=-1)
    swings: Array = ticks[pairs[~on[pairs[:, 0]]]]
    long = np.ptp(swings, axis=1) > SWING_FRACTION * single_support
    found: Array = swings[long]
    return found


def _swings(duel: InstrumentedDuel, name: str) -> list[Array]:
    """Return the swings of left and right foot."""
    single = duel.run.settings.gait.single_support
    return [
        swing_intervals(duel.ticks, load, single)
        for load in duel.loads[name].T
    ]


def step_times(duel: InstrumentedDuel, name: str) -> list[float]:
    """Return the times between landings of either foot, in [s], or [inf]."""
    landings = np.sort(np.concatenate(_swings(duel, name))[:, 1])
    intervals: list[float] = np.diff(landings).tolist()
    return intervals or [inf]


def replanning_support(
    duel: InstrumentedDuel, name: str
) -> tuple[float, float]:
    """Measure the contact state at which plans are replaced.

    At the end of double support the plan completely unloads the foot that is
    about to swing: a foot unloaded just before still counts as in contact.
    Returns the fraction of the plans that follow the previous one after
    exactly one landing, while both feet are in contact; and the longest time
    from a plan to the next lift-off, in [s]. NaN without plans.
    """
    flights = np.concatenate(_swings(duel, name))
    lifts, landings = np.sort(flights, axis=0).T
    sent = np.array([plan.first_sent_time for plan in duel.plans[name]])
    if not len(lifts):
        return nan, nan
    # A plan without a later lift-off cannot be evaluated.
    sent = sent[sent <= lifts[-1] + UNLOADING]
    if len(sent) < 2:
        return nan, nan
    in_air = (flights[:, 0] + UNLOADING <= sent[1:, None]) & (
        sent[1:, None] < flights[:, 1]
    )
    landed = np.diff(np.searchsorted(landings, sent))
    good = (landed == 1) & ~in_air.any(axis=1)
    next_lifts = lifts[np.searchsorted(lifts, sent[1:] - UNLOADING)]
    return float(good.mean()), float((next_lifts - sent[1:]).max())


def walked_arc_fraction(
    plans: tuple[WalkedPlan, ...], gait: GaitSettings
) -> float:
    """Return the largest fraction of its arc that a plan was walked.

    The gait walks along the path slower than the template drives it. NaN
    for fewer than two plans.
    """
    times = [
        later.first_sent_time
        - plan.first_sent_time
        - plan.from_standing * gait.start_support
        for plan, later in zip(plans, plans[1:], strict=False)
    ]
    time_scale = gait.path_interval / gait.step_duration
    return max(times, default=nan) * time_scale * gait.gain


def reference_jumps(duel: InstrumentedDuel, name: str) -> tuple[float, float]:
    """Return the largest jumps of the CoM reference at a replan.

    In [m] and [m/s], from polynomials through the references of the last ticks
    before and of the first ticks after it; NaN without plans.
    """
    sent, ticks = duel.references[name], duel.ticks
    jumps = []
    for plan in duel.plans[name]:
        first = int(np.searchsorted(ticks, plan.start_time - 1e-9))
        if FIT_TICKS <= first <= len(ticks) - FIT_TICKS:
            before, after = (
                _extrapolate(ticks, sent, plan.start_time, number)
                for number in (first - FIT_TICKS, first)
            )
            jumps.append(np.abs(after - before).max(axis=1))
    if not jumps:
        return nan, nan
    position, velocity = np.max(jumps, axis=0).tolist()
    return position, velocity


def _extrapolate(
    ticks: Array, sent: Array, instant: float, first: int
) -> Array:
    """Return position and velocity at an instant by a polynomial. (2, 2)."""
    period = float(ticks[1] - ticks[0])
    rows = slice(first, first + FIT_TICKS)
    powers = np.vander((ticks[rows] - instant) / period, increasing=True)
    values: Array = np.array(np.linalg.solve(powers, sent[rows])[:2])
    values[1] /= period
    return values


def _samples_of_cycle(duel: InstrumentedDuel) -> int:
    """Return the number of samples in a gait cycle.

    Chords over a cycle have no sway.
    """
    times = duel.run.times
    return round(float(duel.run.settings.cycle) / float(times[1] - times[0]))


def walking_speed(duel: InstrumentedDuel, name: str) -> float:
    """Return the speed over the last third, in [m/s]; NaN if too short."""
    times, cycle = duel.run.times, _samples_of_cycle(duel)
    last = duel.run.tracks[name].unicycle[len(times) * 2 // 3 :, :2]
    if len(last) <= cycle:
        return nan
    chords = np.hypot(*(last[cycle:] - last[:-cycle]).T)
    return float(chords.mean() / (cycle * (times[1] - times[0])))


def distance_walked(duel: InstrumentedDuel, name: str) -> float:
    """Return the path length of the torso, in [m]."""
    positions = duel.run.tracks[name].torso[:, :2]
    corners = np.vstack(
        [positions[:: _samples_of_cycle(duel)], positions[-1:]]
    )
    return float(np.hypot(*np.diff(corners, axis=0).T).sum())


def largest_tilt(duel: InstrumentedDuel) -> float:
    """Return the largest angle of a torso from the vertical, in [deg]."""
    postures = [duel.run.tracks[name].qpos for name in PLAYERS]
    upward = min(
        float((1.0 - 2.0 * (qpos[:, 4:6] ** 2).sum(axis=1)).min())
        for qpos in postures
        if qpos is not None
    )
    return degrees(acos(max(-1.0, min(1.0, upward))))


def mean_foot_slip(duel: InstrumentedDuel) -> float:
    """Return the mean slip of a foot from landing to lift-off, in [m]."""
    slips = []
    for name in PLAYERS:
        for side, flights in enumerate(_swings(duel, name)):
            feet = duel.feet[name][:, side]
            landed = np.searchsorted(duel.ticks, flights[:-1, 1])
            lifted = np.searchsorted(duel.ticks, flights[1:, 0]) - 1
            slips.append(np.hypot(*(feet[lifted] - feet[landed]).T))
    distances = np.concatenate(slips)
    return float(distances.mean()) if len(distances) else nan


SLIPPERY = 0.05  # sliding friction of a floor on which feet slip
MIN_SPEED = 0.5  # fraction of the gait's speed below which a robot is stuck
CIRCLE_TIME = 120.0  # of the duel of Fig. 5, in [s]
WALK_TIME, SLIP_TIME = 30.0, 80.0  # of the others, in [s]


def walk_settings(
    seed: int,
    preset: str = "nao",
    duration: float = WALK_TIME,
    friction: float | None = None,
) -> GameSettings:
    """Return the settings of a duel in which both walk from the begin."""
    settings = duel(
        seed=seed,
        duration=duration,
        gait=PRESETS[preset],
        start=StartSettings(distance=0.7),
    )
    if friction is None:
        return settings
    physics = replace(settings.physics, friction=friction)
    return replace(settings, physics=physics)


def measure_humanoids(seed: int) -> dict[str, float]:
    """Play the duel of Fig. 5 from the random initial poses of a seed."""
    settings = duel(seed=seed, duration=CIRCLE_TIME)
    return read_circle(play_instrumented(settings))


def read_circle(played: InstrumentedDuel) -> dict[str, float]:
    """Measure the circle of Sec. IV and the replanning of Sec. III-E."""
    landings = [step for name in PLAYERS for step in step_times(played, name)]
    gait = played.run.settings.gait
    shares = [
        walked_arc_fraction(played.plans[name], gait) for name in PLAYERS
    ]
    jumps = [reference_jumps(played, name) for name in PLAYERS]
    on_feet = [replanning_support(played, name) for name in PLAYERS]
    position, velocity = np.max(jumps, axis=0).tolist()
    pursuer, evader = (walking_speed(played, name) for name in PLAYERS)
    return last_circle(played.run) | {
        "same_speed": evader / pursuer if pursuer > 0.0 else nan,
        "landings": most_deviating(landings, gait.step_duration),
        "both_feet": float(np.min([share for share, _ in on_feet])),
        "at_its_end": float(np.max([late for _, late in on_feet])),
        "straight_part": float(np.max(shares)),
        "place_jump": position,
        "velocity_jump": velocity,
    }


def last_circle(run: Run) -> dict[str, float]:
    """Measure the circle of the last third; NaN if the duel ended early."""
    keys = (
        *("settled", "pursuer_radius", "evader_radius", "one_circle"),
        *("distance", "orientation"),
    )
    if run.outcome is not Outcome.COMPLETED:
        return dict.fromkeys(keys, nan)
    times, settings = run.times, run.settings
    pursuer, evader = (run.tracks[name].unicycle for name in PLAYERS)
    theory = circle_of_theory(settings)
    since = convergence_time(times, pursuer, evader, settings, theory)
    tail = last_third(times)
    (centre, radius), (other_centre, other_radius) = (
        fit_circle(poses[tail, :2]) for poses in (pursuer, evader)
    )
    values = (
        nan if since is None else since,
        radius,
        other_radius,
        float(np.hypot(*(centre - other_centre))),
        float(distance_between(pursuer, evader)[tail].mean()),
        degrees(float(angle_between(pursuer, evader)[tail].mean())),
    )
    return dict(zip(keys, values, strict=True))


def measure_durations(seed: int) -> dict[str, float]:
    """Play duels with the durations as printed, and exchanged."""
    printed, exchanged = (
        play_instrumented(walk_settings(seed, preset, WALK_TIME))
        for preset in ("as-printed", "nao")
    )
    return read_durations(printed, exchanged)


def read_durations(
    printed: InstrumentedDuel, walked: InstrumentedDuel
) -> dict[str, float]:
    """Compare the support durations as printed with the exchanged ones."""
    gait = walked.run.settings.gait
    speeds = [walking_speed(walked, name) for name in PLAYERS]
    slid, tilt = mean_foot_slip(walked), largest_tilt(walked)
    return {
        "printed_slide": mean_foot_slip(printed) / slid if slid > 0.0 else nan,
        "printed_tilt": largest_tilt(printed) / tilt,
        "upright_for": walked.run.duration,
        "tilt": tilt,
        "distance": min(distance_walked(walked, name) for name in PLAYERS),
        "speed": most_deviating(speeds, gait.stride / gait.step_duration),
    }


def measure_slip(seed: int) -> dict[str, float]:
    """Play duels on a floor with normal friction and on a slippery one."""
    grip, slip = (
        play_instrumented(walk_settings(seed, "nao", SLIP_TIME, friction))
        for friction in (None, SLIPPERY)
    )
    return read_slip(grip, slip)


def read_slip(
    grip: InstrumentedDuel, slip: InstrumentedDuel
) -> dict[str, float]:
    """Compare a slippery floor with one of normal friction.

    The ratios are NaN unless the robots walk in both duels.
    """
    (slid, speed, radius), slippery = _walk_of(grip), _walk_of(slip)
    return {
        "slide": slippery[0] / slid if slid > 0.0 else nan,
        "slower": slippery[1] / speed,
        "smaller": slippery[2] / radius,
    }


def _walk_of(played: InstrumentedDuel) -> tuple[float, float, float]:
    """Return slip, speed and radius; NaN unless both robots walk."""
    gait = played.run.settings.gait
    speeds = [walking_speed(played, name) for name in PLAYERS]
    least = MIN_SPEED * gait.stride / gait.step_duration
    circle = last_circle(played.run)
    if played.run.outcome is not Outcome.COMPLETED or not min(speeds) > least:
        return nan, nan, nan
    radius = 0.5 * (circle["pursuer_radius"] + circle["evader_radius"])
    return mean_foot_slip(played), float(np.mean(speeds)), radius


def legs_settings(robot: str, seed: int) -> GameSettings:
    """Return the settings of the duel of Fig. 5 on learned legs.

    The description in the folder of the robot names a policy.
    """
    settings = duel(seed=seed, duration=CIRCLE_TIME)
    settings = read_game({"robot": robot}, base=settings)
    if not settings.evader.legs.network:
        raise ConfigurationError(
            f"the robot {robot!r} must have learned legs: its robot.toml "
            "names no network in [locomotion]"
        )
    return settings


def measure_legs(robot: str, seed: int) -> dict[str, float]:
    """Play the duel of Fig. 5 on the learned legs of a robot."""
    return last_circle(run_game(legs_settings(robot, seed)).uninterrupted())


DURATION = 40.0  # of the duels in rooms, in [s]
AHEAD = "look-ahead"
GAMES_PER_SEED = 5  # of each evader in each setting
GAME = duel(level="steps", duration=164.1, pursuer=PURSUIT, evader=AHEAD)
PAIRINGS = {
    "open": PairingSettings(GAME, "open"),
    "room": PairingSettings(GAME, room=RoomRecipe(discs=3)),
}

Tracks = tuple[StrategyTrack, ...]
"""Games of one evader, from the initial poses of a seed each."""


def measure_evading(seed: int) -> dict[str, float]:
    """Play the games of a seed at the level of steps."""
    seeds = range(GAMES_PER_SEED * seed, GAMES_PER_SEED * (seed + 1))
    return read_evading(
        {
            (where, evader): tuple(
                play_track(
                    replace(
                        pairing,
                        game=pairing.game.changed(seed=each, evader=evader),
                    )
                )
                for each in seeds
            )
            for where, pairing in PAIRINGS.items()
            for evader in (ASIDE, AHEAD)
        }
    )


def read_evading(games: Mapping[tuple[str, str], Tracks]) -> dict[str, float]:
    """Compare evaders, by floor and name, on the open floor and in rooms."""
    ahead = games["room", AHEAD]
    bounds = [
        bound_of(g.pursuer[0], g.evader[0], GAME.evader.gait)
        for g in games["open", AHEAD]
    ]
    closest = {
        evader: np.mean([g.distances.min() for g in games["open", evader]])
        for evader in (ASIDE, AHEAD)
    }
    survived = {
        evader: np.mean(
            [g.outcome is Outcome.COMPLETED for g in games["room", evader]]
        )
        for evader in (ASIDE, AHEAD)
    }
    return {
        "farther": float(closest[AHEAD] / closest[ASIDE]),
        "best": float(closest[AHEAD] / np.mean(bounds)),
        "survives": float(survived[AHEAD]),
        "clear": float(min(g.clearances.min() for g in ahead))
        - (GAME.evader.radius + MARGIN),
        "aside": float(survived[AHEAD] - survived[ASIDE]),
        "decision": 1e3 * float(np.mean([g.decision for g in ahead])),
    }


def measure_room(seed: int) -> dict[str, float]:
    """Play a duel in the room of a seed, with a given map."""
    run = run_game(
        duel(
            seed=seed,
            duration=DURATION,
            evader={"strategy": AHEAD},
            room=generate_room(RoomRecipe(discs=3), seed),
        )
    )
    return read_room(run.uninterrupted())


def read_room(
    run: Run, clear: Callable[[Run, str], float | None] = clearance
) -> dict[str, float]:
    """Read contacts, clearance [m] and free time [s] of a duel in a room."""
    least = [clear(run, name) for name in PLAYERS]
    whole = run.outcome is Outcome.COMPLETED
    met = run.outcome is Outcome.CONTACT
    met &= set(run.summary.touched) == set(PLAYERS)
    free = whole and run.summary.captured_at_s is None
    return {
        "touched": float(not whole and not met),
        "clear": min(inf if k is None else k for k in least),
        "free": run.duration if free else 0.0,
    }
