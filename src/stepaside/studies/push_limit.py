"""Largest push that a walk survives, by bisection, and its bound."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from math import radians

from ..core.errors import ConfigurationError, check_choice, check_within
from ..games.game_settings import GameSettings
from ..games.game_settings import walk as make_walk
from ..games.outcome import Outcome
from ..games.player_settings import WALKER
from ..games.recorded_game import run_game
from ..games.robot_settings import game_of_robot
from ..planning import Foot, ManeuverPlanner
from ..planning.maneuver import steady_plan
from ..planning.push_bound import FootReach, push_bound
from ..robots.description import load_robot
from ..robots.forward_kinematics import ForwardKinematics
from ..sim.push import Push
from ..strategies import Walk, load_strategy
from .tabulation import Record

DIRECTIONS = {"left": 90.0, "right": -90.0, "forward": 0.0, "backward": 180.0}
BEFORE = 6  # steps before a push
AFTER = 4.0  # time after a push, in [s]
LASTS = 0.1  # duration of a push, in [s]
REFERENCE = "nao"  # robot to which strengths of pushes refer
# In [N s] for NAO; see :func:`push_scale`.
RESOLUTION = 0.1  # to which a limit is found
STRIDE = 0.4  # between pushes before bisection
LARGEST = 8.0


@dataclass(frozen=True)
class PushSettings:
    """Search for the largest push that a walk survives."""

    # settings of the walk; duration and pushes are ignored
    walk: GameSettings = field(default_factory=make_walk)
    direction: str = "left"  # direction of the push, a key of ``DIRECTIONS``
    phase: float = 0.0  # at which it begins, of the gait cycle
    seed: int = 1  # seed of the walk

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_choice(self.direction, DIRECTIONS, "direction")
        check_within(self.phase, 0.0, 1.0, "phase", "1", ConfigurationError)

    def pushed(self, strength: float) -> GameSettings:
        """Return the walk with a push of a strength, in [N s] for NAO."""
        walk = self.walk.resolved()
        own = walk.player(WALKER)
        begins = own.gait.start_support + float(bool(own.control.feedback))
        time = begins + (BEFORE + 2.0 * self.phase) * walk.gait.step_duration
        push = Push(
            strength * push_scale(own.robot),
            time,
            radians(DIRECTIONS[self.direction]),
        )
        return replace(
            walk, seed=self.seed, duration=time + AFTER, pushes=(push,)
        )


def find_limit(survives: Callable[[float], bool]) -> tuple[float, int]:
    """Return the largest strength survived, in [N s], and the pushes tried.

    Pushes grow by a stride until one is not survived; then the interval
    below it is bisected.
    """
    limit, failed, tried = 0.0, None, 0
    while failed is None and round(limit + STRIDE, 6) <= LARGEST:
        strength, tried = round(limit + STRIDE, 6), tried + 1
        if survives(strength):
            limit = strength
        else:
            failed = strength
    while failed and (parts := round((failed - limit) / RESOLUTION)) > 1:
        strength = round(limit + parts // 2 * RESOLUTION, 6)
        tried += 1
        if survives(strength):
            limit = strength
        else:
            failed = strength
    return limit, tried


def play_push(settings: PushSettings) -> Record:
    """Walk until the largest push that the walk survives is known.

    The record has it beside the bound of the linear inverted pendulum, in
    [N s], and their ratio.
    """

    def survives(strength: float) -> bool:
        run = run_game(settings.pushed(strength)).uninterrupted()
        return run.outcome is Outcome.COMPLETED

    strength, tried = find_limit(survives)
    walk = settings.walk.resolved()
    robot = walk.player(WALKER).robot
    limit = strength * push_scale(robot)
    bound = push_bound_at(settings.direction, settings.phase, walk)
    return {
        "limit_n_s": limit,
        "bound_n_s": bound,
        "of_bound": limit / bound,
        "walks": tried,
    }


@cache
def mass_of(robot: str) -> float:
    """Return the mass of a robot, in [kg]."""
    return float(ForwardKinematics(load_robot(robot)).mass)


def push_scale(robot: str) -> float:
    """Return the factor on pushes of NAO for the same effect on a robot.

    It is the ratio of the push units of their descriptions, which scale with
    mass and pendulum speed; without them, the ratio of the masses.
    """
    own, nao = map(game_of_robot, (robot, REFERENCE))
    if own is None or nao is None:
        return mass_of(robot) / mass_of(REFERENCE)
    return own.push_unit / nao.push_unit


def push_bound_at(direction: str, phase: float, walk: GameSettings) -> float:
    """Return the push bound of the linear inverted pendulum, in [N s].

    The walk is in its steady gait cycle when it is pushed.
    """
    own = walk.resolved().player(WALKER)
    gait, gains = own.gait, own.control.stabiliser
    way = load_strategy(own.strategy)
    assert isinstance(way, Walk)
    cycle = 2.0 * gait.step_duration
    passed = phase * cycle % cycle
    foot = Foot.LEFT if passed < gait.step_duration else Foot.RIGHT
    plan = steady_plan(
        ManeuverPlanner(gait),
        way.bearing,
        way.direction,
        first_foot=foot,
    )
    reach = FootReach(
        gains.reach_forward,
        gains.reach_backward,
        gains.reach_outward,
        gains.gap,
    )
    return push_bound(
        plan,
        passed % gait.step_duration,
        radians(DIRECTIONS[direction]),
        mass_of(own.robot),
        reach,
        lasts=LASTS,
    )
