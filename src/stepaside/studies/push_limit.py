"""Largest push that a walk survives, by bisection, and its bound."""

from dataclasses import dataclass, replace
from functools import cache
from math import radians

from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from ..games.game import Outcome
from ..games.game_settings import GameSettings
from ..games.player_settings import WALKER
from ..games.recorded_game import run_game
from ..planning import Foot, ManeuverPlanner
from ..planning.push_bound import FootReach, push_bound, steady_plan
from ..robots.description import load_robot
from ..robots.forward_kinematics import ForwardKinematics
from ..sim.push import Push
from ..strategies import Walk, load_strategy
from .tabulation import Record

DIRECTIONS = {"left": 90.0, "right": -90.0, "forward": 0.0, "backward": 180.0}
BEFORE = 6  # steps before a push
AFTER = 4.0  # time after a push, in [s]
LASTS = 0.1  # duration of a push, in [s]
FINENESS = 10  # of a limit, per push unit of the robot
STRIDE, LARGEST = 4, 80  # of pushes, in steps of this fineness


@dataclass(frozen=True)
class PushTrial(CheckedSettings):
    """Search for the largest push that a walk survives."""

    game: GameSettings  # the walk; its duration and pushes are ignored
    direction: str = setting(
        "left", "Direction of the push", names=tuple(DIRECTIONS)
    )
    phase: float = setting(
        0.0,
        "Phase of the gait cycle at which it begins",
        Range(0.0, 1.0, "1", "a cycle"),
    )

    def pushed(self, strength: float) -> GameSettings:
        """Return the walk with a push of a strength, in [N s] for NAO."""
        walk = self.game.resolved()
        own = walk.player(WALKER)
        begins = own.gait.start_support + float(bool(own.control.feedback))
        time = begins + (BEFORE + 2.0 * self.phase) * walk.gait.step_duration
        push = Push(
            strength * load_robot(own.robot).game.push_unit,
            time,
            radians(DIRECTIONS[self.direction]),
        )
        return replace(walk, duration=time + AFTER, pushes=(push,))


def play_push(trial: PushTrial) -> Record:
    """Walk until the largest push that the walk survives is known.

    Pushes grow by a stride until one is not survived; then the interval
    below it is bisected. The record has the limit beside the bound of the
    linear inverted pendulum, in [N s], and their ratio.
    """
    low, high, tried = 0, LARGEST + 1, 0
    while high - low > 1:
        middle = low + (STRIDE if high > LARGEST else (high - low) // 2)
        settings, tried = trial.pushed(middle / FINENESS), tried + 1
        if run_game(settings).uninterrupted().outcome is Outcome.COMPLETED:
            low = middle
        else:
            high = middle
    robot = load_robot(trial.game.player(WALKER).robot)
    limit = low / FINENESS * robot.game.push_unit
    bound = bound_of_push(trial)
    return {
        "limit_n_s": limit,
        "bound_n_s": bound,
        "of_bound": limit / bound,
        "above_bound": limit > bound,
        "walks": tried,
    }


@cache
def mass_of(robot: str) -> float:
    """Return the mass of a robot, in [kg]."""
    return float(ForwardKinematics(load_robot(robot)).mass)


def bound_of_push(trial: PushTrial) -> float:
    """Return the push bound of the linear inverted pendulum, in [N s].

    The walk is in its steady gait cycle when it is pushed.
    """
    own = trial.game.resolved().player(WALKER)
    gait, gains = own.gait, own.control.stabiliser
    way = load_strategy(own.strategy)
    assert isinstance(way, Walk)
    step, into = divmod(2.0 * trial.phase % 2.0, 1.0)
    return push_bound(
        steady_plan(
            ManeuverPlanner(gait),
            way.bearing,
            way.direction,
            first_foot=Foot.RIGHT if step else Foot.LEFT,
        ),
        into * gait.step_duration,
        radians(DIRECTIONS[trial.direction]),
        mass_of(own.robot),
        FootReach(
            gains.reach_forward,
            gains.reach_backward,
            gains.reach_outward,
            gains.gap,
        ),
        lasts=LASTS,
    )
