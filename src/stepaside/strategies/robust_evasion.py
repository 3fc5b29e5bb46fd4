"""Evasion from a pursuer that is not known."""

from dataclasses import dataclass
from functools import lru_cache
from math import atan2, cos, sin
from typing import NamedTuple

import numpy as np

from ..arena.obstacles import PackedObstacles
from ..core.constants import CAPTURE_DISTANCE
from ..core.poses import Array, Pose, wrap_angle
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from .knowledge import ON_THE_SPOT, Intent, Knowledge
from .opponent_models import ASSUMED, MODELS, ModelFit
from .search.beam_search import BeamRules, beam_search, play_moves
from .search.step_motion import PursuerModel, step_rules
from .strategy import BackwardStrategy

MARGIN = 0.005  # in addition to the required clearance, in [m]
SWAY = 0.03  # by which the torsos of walkers, which lead their reference
# points by 2 cm and sway, are nearer to each other than these, in [m]
WALL_SWAY = 0.01  # in addition to the clearance of walkers, in [m]; with
# none the guard of the walk refuses turns beside walls
CAUTION = 2.0  # of walkers (:class:`~.search.beam_search.BeamRules`)
HEADING_ERROR = 0.2  # of a walking pursuer, to either side, in [rad]
NEARER = 0.015  # that it may be than it seems, in [m]
KEPT_STEPS = 3  # by which a walker's new plan must survive longer than the
# rest of the last one
AHEAD = 0.73  # steps from the mean of a walker's last two positions to the
# beginning of its next step, measured on walks of NAO
TORSO_LAG = 0.05  # of the turn of a walker's last step, which its torso has
# yet to make when it sees the pursuer; measured likewise
TURNS = 7  # turns tried per step
WIDER = 5  # times the width where no state survives; 20 is no better
KEPT = 0.95  # of a plan is left when it is searched again; 0.8 loses 3 %
ROUNDING = 1e-6  # of a mean number of steps
SLACK = 1  # steps that a plan may survive less than when it was made


class RobustMemory(NamedTuple):
    """Memory of a robust evader."""

    fit: ModelFit = ModelFit()  # models of the pursuer, and their errors
    # turn [rad] and speed factor of the planned steps to come. (n, 2)
    moves: Array = np.empty((0, 2))
    assumed: tuple[int, ...] = ()  # models that were searched for the plan
    planned: int = 0  # number of steps of the plan when it was made
    promised: float = 0.0  # mean number of its steps to come that it survives


@dataclass(frozen=True, slots=True)
class RobustEvasion(BackwardStrategy, CheckedSettings):
    """Evader that plans against every model of the pursuer that is plausible.

    The models that explain the last seconds are kept; for some of them a beam
    search looks for the game that survives longest, and the plan that
    survives longest against all, in the mean by their weights, is walked. It
    backs away, turns on the spot and goes around obstacles.
    """

    width: int = setting(
        200,
        "States that the search follows",
        Range(1, 10_000, "1", "decisions take longer", whole=True),
    )
    horizon: int = setting(
        75,
        "Steps that it looks ahead against the greatest number of models; "
        "against fewer it looks further, by the same number of steps in all, "
        "unless the players are walkers",
        Range(1, 1000, "1", "decisions take longer", whole=True),
    )
    capture: float = setting(
        CAPTURE_DISTANCE,
        "Distance at which the evader counts as captured",
        Range(0.0, 100.0, "m", "a distance", above=True),
    )
    body_radius: float = setting(
        0.2,
        "Least distance of the own centre to obstacles",
        Range(0.0, 10.0, "m", "a body has a radius", above=True),
    )

    def begin(self) -> RobustMemory:
        """Return the memory before the first sighting."""
        return RobustMemory()

    def decide(
        self, knowledge: Knowledge, memory: RobustMemory
    ) -> tuple[Intent, RobustMemory]:
        """Take the first step of the plan that survives longest."""
        limits, own = knowledge.limits, knowledge.pose_in_map
        walks = knowledge.step_start_in_map is not None
        rules = self._rules(knowledge, walks=walks)
        sight = own.theta + knowledge.bearing
        if walks:
            most = rules.step.largest
            turned = wrap_angle(own.theta - float(memory.fit.seen[2]))
            sight -= TORSO_LAG * min(max(turned, -most), most)
        position = (
            own.x + knowledge.distance * cos(sight),
            own.y + knowledge.distance * sin(sight),
        )
        time = knowledge.time - knowledge.age
        fit = memory.fit.observe(
            time, own, position, rules.step, limits.step_duration, sways=walks
        )
        assumed = tuple(fit.plausible())
        game = planned_game(knowledge, position, fit, assumed, rules)
        rest, promised = memory.moves[1:], memory.promised - 1
        if (
            assumed != memory.assumed
            or len(rest) <= KEPT * memory.planned
            or game.outcome(rest)[0] < promised - SLACK
        ):
            rest, promised = game.plan(rest)
            memory = memory._replace(assumed=assumed, planned=len(rest))
        memory = memory._replace(fit=fit, moves=rest, promised=promised)
        largest = rules.step.largest
        turn, speed = rest[0] if len(rest) else (largest, ON_THE_SPOT)
        return Intent(float(turn) / limits.share, float(speed)), memory

    def _rules(self, knowledge: Knowledge, *, walks: bool) -> BeamRules:
        """Return the rules of the games, which differ for walkers."""
        capture, clearance = self.capture + MARGIN, self.body_radius + MARGIN
        if walks:  # an evader that is too near may leave
            capture = min(capture + SWAY, knowledge.distance - SWAY)
            clearance += WALL_SWAY
        return BeamRules(
            step_rules(knowledge.limits),
            capture,
            clearance,
            self.width,
            self.horizon,
            CAUTION if walks else 0.0,
        )


class PlannedGame(NamedTuple):
    """Game against every model that is plausible, from what has been seen."""

    # models of the pursuer, first those that are searched
    models: tuple[PursuerModel, ...]
    # poses of evader and pursuer by each model. Shape (6,) each
    starts: list[Array]
    weights: Array  # weight of each, one in all. (n,)
    searched: int  # number of models that are searched
    # steps by which a new plan must survive longer than the rest of the last
    # one
    kept: float
    packed: PackedObstacles  # obstacles
    rules: BeamRules  # rules of the games, and size of the search

    def outcome(self, moves: Array) -> tuple[float, float]:
        """Return the steps that moves survive, and their least distance.

        The number of steps is the mean by the weights of the models; the
        distance is that against any of them, in [m].
        """
        played = [
            play_moves(start, moves, model, self.packed, self.rules)
            for start, model in zip(self.starts, self.models, strict=True)
        ]
        steps, least = np.array(played).T
        return float(self.weights @ steps), float(least.min())

    def plan(self, rest: Array) -> tuple[Array, float]:
        """Search the moves that survive longest against most models.

        The rest of the last plan is compared with those found. Returns turn
        [rad] and speed factor of each step, (n, 2), and the mean number of
        steps that they survive.
        """
        rules, candidates = self.rules, []
        actions = actions_of(rules.step.largest)
        for n in range(self.searched):
            start, model = self.starts[n], self.models[n]
            path = beam_search(start, actions, model, self.packed, rules)
            if len(path) < rules.horizon:
                wide = rules._replace(width=WIDER * rules.width)
                path = beam_search(start, actions, model, self.packed, wide)
            candidates.append(actions[path])
        outcomes = [self.outcome(moves) for moves in candidates]
        found = max(outcomes)
        steps, least = self.outcome(rest)
        ends = self.kept and found[0] > rules.horizon - ROUNDING
        if (steps + self.kept, least) > found and not ends:
            return rest, steps
        return candidates[outcomes.index(found)], found[0]


def planned_game(
    knowledge: Knowledge,
    position: tuple[float, float],
    fit: ModelFit,
    assumed: tuple[int, ...],
    rules: BeamRules,
) -> PlannedGame:
    """Return the game against the models that are plausible.

    The pursuer was seen at a position [m]; some models are searched.
    """
    weights = fit.weights()
    others = [n for n in range(len(MODELS)) if weights[n] and n not in assumed]
    numbers = [*assumed, *others]
    models = tuple(MODELS[n]._replace(speed=fit.speed) for n in numbers)
    weights = weights[numbers] / weights[numbers].sum()
    begins, kept = knowledge.step_start_in_map, 0
    if begins is None:
        begins = knowledge.pose_in_map
        poses = [Pose(*position, fit.poses[n][2]) for n in numbers]
        horizon = rules.horizon * ASSUMED // len(assumed)
        rules = rules._replace(horizon=horizon)
    else:  # humanoids walk less predictably
        ahead = AHEAD + knowledge.age / knowledge.limits.step_duration
        poses = [fit.pose(n, rules.step, ahead) for n in numbers]
        poses += [
            approached(begins, pose, side)
            for side in (-HEADING_ERROR, HEADING_ERROR)
            for pose in poses
        ]
        kept, models = KEPT_STEPS, models * 3
        weights = np.tile(weights / 3.0, 3)
    starts = [np.array([*begins, *pose]) for pose in poses]
    packed = knowledge.obstacles_in_map.packed
    return PlannedGame(
        models, starts, weights, len(assumed), kept, packed, rules
    )


def approached(own: Pose, pursuer: Pose, turn: float) -> Pose:
    """Return a pose of a pursuer that is nearer to a pose and turned."""
    sight = atan2(own.y - pursuer.y, own.x - pursuer.x)
    return Pose(
        pursuer.x + NEARER * cos(sight),
        pursuer.y + NEARER * sin(sight),
        pursuer.theta + turn,
    )


@lru_cache(maxsize=8)
def actions_of(largest: float) -> Array:
    """Return turn [rad] and speed factor of each action. Shape (n, 2)."""
    walks = [(u, 1.0) for u in np.linspace(-largest, largest, TURNS)]
    spots = [(-largest, ON_THE_SPOT), (largest, ON_THE_SPOT)]
    return np.array(walks + spots)
