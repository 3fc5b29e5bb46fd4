"""Evasion from a pursuer that is not known, by models of it."""

from dataclasses import dataclass
from functools import lru_cache
from math import atan2, cos, hypot, inf, sin
from typing import NamedTuple

import numpy as np

from ..core.constants import CAPTURE_DISTANCE
from ..core.poses import Array, Pose, wrap_angle
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from .knowledge import BODY, ON_THE_SPOT, Intent, Knowledge
from .opponent_track import LEAST, OpponentTrack
from .search.beam_search import BeamRules, beam_search
from .search.step_motion import (
    ENOUGH,
    Objective,
    PlayerPair,
    PursuerModel,
    StepRules,
    fit_heading,
    pair_of,
    pursuer_turn,
    roll_out,
    step_rules,
)
from .strategy import BackwardStrategy

# The paper's pursuer with other gains, the last of them turning by the whole
# bearing, and pursuers with another target.
MODELS = (
    *map(PursuerModel, (1.0, 1.5, 2.0, 3.0, 4.0, 12.5)),
    PursuerModel(pull=1.0),
    PursuerModel(lead=0.5),
)
DANGEROUS = (6, 3, 0, 5, 4)  # models to search until they are ruled out
SHARPNESS = 5.0  # with which the weight of a model falls with the square of
# its error
MEMORY = 0.93  # weight of the earlier errors after a step
EXACT = 1e-5  # error of a model that counts as none, in [m] rms; with
# 2e-4 pursuers of gain x3 are not told from x4
GAP = 1.5  # steps between observations, beyond which the path begins anew
LEAST_MOTION = 0.3  # stride over that of the gait that shows a direction
ASSUMED = 3  # models that are assumed at once
FORGETTING = 0.995  # of the greatest observed speed, per step


class FitRules(NamedTuple):
    """Rules of the fit, by the errors of the observed positions."""

    window: int  # positions that a model is fitted to
    settling: int  # positions that show an error
    ruled_out: float  # error over the least of a model that is not so


# Without errors the last steps say most: in longer windows the random turns of
# ``noisy`` add up, and it captures 4 of 12 evaders, not 1.
EXACT_SIGHT = FitRules(3, 3, 3.0)
# With 10 positions herding walkers that change their side too early or late
# rule out their own model. In walks the true model is within 1.2 times the
# least error in 97 % of the steps; with 1.4 herding walkers are told from pure
# ones so late that they capture 3 of 10 evaders, not 0.
SWAYING_SIGHT = FitRules(6, 4, 1.2)


class ModelFit(NamedTuple):
    """Fit of every model to the observed motion."""

    # last positions, at times in steps
    track: OpponentTrack = OpponentTrack(1.0, GAP, LEAST)
    # these a step apart, without sway
    # (:func:`~.search.step_motion.fit_heading`). (n, 6)
    path: Array = np.empty((0, 6))
    poses: tuple[tuple[float, float, float], ...] = ()  # at the end of it
    # forgetting mean of the mean squared distance of each model from the path
    # [m^2]
    errors: tuple[float, ...] = (0.0,) * len(MODELS)
    speed: float = 1.0  # greatest stride that was seen lately, over the own
    fitting: FitRules = EXACT_SIGHT

    def observe(
        self,
        time: float,
        own: Pose,
        position: tuple[float, float],
        rules: StepRules,
        *,
        sways: bool = False,
    ) -> "ModelFit":
        """Fit every model to the path with one more observation.

        Poses are relative to the centre of the room, times in steps. Positions
        of walking bodies alternate with their sway from step to step: then the
        path is that of the mean of two, half a step earlier.
        """
        if self.poses and time - self.track.rows[-1].time < LEAST:
            return self
        track = self.track.note(time, position, own)
        fitting = SWAYING_SIGHT if sways else EXACT_SIGHT
        now = self._replace(track=track, fitting=fitting)
        point, follows = np.array([*own, *position, time]), len(track.rows) > 1
        if follows and sways:
            at, x, y, pose = track.rows[-2]
            point = 0.5 * (np.array([*pose, x, y, at]) + point)
            point[2] = own.theta - 0.5 * wrap_angle(own.theta - pose.theta)
        path = self.path if follows else self.path[:0]
        if not len(path):
            x, y = point[3:5].tolist()
            faces = x, y, atan2(own.y - y, own.x - x)
            path = point[None] if follows or not sways else path
            return now._replace(path=path, poses=(faces,) * len(MODELS))
        if hypot(*(point - path[-1])[3:5]) < LEAST_MOTION * rules.stride:
            return now._replace(path=np.array([*path[:-1], point]))
        path = np.array([*path[1 - fitting.window :], point])
        fits = [fit_heading(path, model, rules) for model in MODELS]
        now = now._replace(path=path, poses=tuple(pose for pose, _ in fits))
        if len(path) < fitting.settling:
            return now
        errors = (
            MEMORY * error + (1.0 - MEMORY) * found
            for error, (_, found) in zip(self.errors, fits, strict=True)
        )
        dx, dy, steps = np.diff(path[:, 3:], axis=0).T
        speed = float(np.hypot(dx, dy).sum() / steps.sum()) / rules.stride
        return now._replace(
            errors=tuple(errors),
            speed=max(1.0, FORGETTING * self.speed, min(speed, 2.0)),
        )

    def pose(self, number: int, rules: StepRules, ahead: float) -> Pose:
        """Return the pose of the pursuer by a model, steps after the path."""
        pose = Pose(*self.poses[number])
        if not len(self.path):
            return pose
        both = pair_of(self.path[-1], pose)
        turn = ahead * pursuer_turn(both, MODELS[number], rules)
        return pose.along_arc(ahead * self.speed * rules.stride, turn)

    def weights(self) -> Array:
        """Return the weight of each model, 1 for the best; 0 if ruled out."""
        squares = np.maximum(self.errors, EXACT**2)
        ratios = squares / squares.min()
        weights: Array = np.exp(-SHARPNESS * (ratios - 1.0))
        weights[ratios > self.fitting.ruled_out**2] = 0.0
        return weights

    def plausible(self) -> tuple[int, ...]:
        """Return the numbers of the models to search, the best first."""
        weights = self.weights()
        seen = max(self.errors) > 0.0
        best = int(weights.argmax()) if seen else DANGEROUS[0]
        others = [n for n in DANGEROUS if n != best and weights[n] > 0.0]
        return (best, *others)[:ASSUMED]


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

    fit: ModelFit = ModelFit()
    moves: Array = np.empty((0, 2))  # turn [rad], speed factor to come
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
        0.2, "Least distance of the own centre to obstacles", BODY
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
        steps, sight = step_rules(limits), own.theta + knowledge.bearing
        rows = memory.fit.track.rows
        if walks and rows:
            most = steps.largest
            turned = wrap_angle(own.theta - rows[-1].own.theta)
            sight -= TORSO_LAG * min(max(turned, -most), most)
        position = (
            own.x + knowledge.distance * cos(sight),
            own.y + knowledge.distance * sin(sight),
        )
        time = (knowledge.time - knowledge.age) / limits.step_duration
        fit = memory.fit.observe(time, own, position, steps, sways=walks)
        assumed = fit.plausible()
        game = self._game(knowledge, position, fit, assumed)
        rest, promised = memory.moves[1:], memory.promised - 1
        if (
            assumed != memory.assumed
            or len(rest) <= KEPT * memory.planned
            or game.outcome(rest)[0] < promised - SLACK
        ):
            rest, promised = game.plan(rest)
            memory = memory._replace(assumed=assumed, planned=len(rest))
        memory = memory._replace(fit=fit, moves=rest, promised=promised)
        turn, speed = rest[0] if len(rest) else (steps.largest, ON_THE_SPOT)
        return Intent(float(turn) / limits.share, float(speed)), memory

    def _game(
        self,
        knowledge: Knowledge,
        position: tuple[float, float],
        fit: ModelFit,
        assumed: tuple[int, ...],
    ) -> "PlannedGame":
        """Return the game against the plausible models of a pursuer.

        It was seen at a position [m]; the assumed models are searched.
        """
        steps, weights = step_rules(knowledge.limits), fit.weights()
        others = set(np.flatnonzero(weights).tolist()) - set(assumed)
        numbers = [*assumed, *sorted(others)]
        models = tuple(MODELS[n]._replace(speed=fit.speed) for n in numbers)
        weights = weights[numbers] / weights[numbers].sum()
        begins, kept, caution = knowledge.step_start_in_map, 0, 0.0
        capture, clearance = self.capture + MARGIN, self.body_radius + MARGIN
        horizon = self.horizon
        if begins is None:
            begins = knowledge.pose_in_map
            poses = [Pose(*position, fit.poses[n][2]) for n in numbers]
            horizon = horizon * ASSUMED // len(assumed)
        else:  # humanoids walk less predictably
            ahead = AHEAD + knowledge.age / knowledge.limits.step_duration
            poses = [fit.pose(n, steps, ahead) for n in numbers]
            poses += [
                approached(begins, pose, side)
                for side in (-HEADING_ERROR, HEADING_ERROR)
                for pose in poses
            ]
            kept, caution, models = KEPT_STEPS, CAUTION, models * 3
            weights = np.tile(weights / 3.0, 3)
            # An evader that is too near may leave.
            capture = min(capture + SWAY, knowledge.distance - SWAY)
            clearance += WALL_SWAY
        return PlannedGame(
            models,
            [pair_of(begins, pose) for pose in poses],
            weights,
            len(assumed),
            kept,
            Objective(
                steps,
                knowledge.obstacles_in_map.packed,
                clearance,
                capture=capture,
            ),
            BeamRules(self.width, horizon, caution),
        )


class PlannedGame(NamedTuple):
    """Game against every model that is plausible, from what has been seen."""

    models: tuple[PursuerModel, ...]  # those that are searched first
    starts: list[PlayerPair]  # both poses by each model
    weights: Array  # weight of each, one in all. (n,)
    searched: int  # number of models that are searched
    kept: float  # steps by which a new plan must survive longer
    objective: Objective  # that every plan must meet
    rules: BeamRules  # size of the search

    def outcome(self, moves: Array) -> tuple[float, float]:
        """Return the mean steps that moves survive, and the least distance."""
        number, objective = len(moves), self.objective
        played = [
            roll_out(start, ENOUGH, moves, number, -inf, model, objective)[1:]
            for start, model in zip(self.starts, self.models, strict=True)
        ]
        least, steps = np.array(played).T
        return float(self.weights @ steps), float(least.min())

    def plan(self, rest: Array) -> tuple[Array, float]:
        """Return the moves that survive longest in the mean, and how many.

        The rest of the last plan is compared with those found. Moves are turn
        [rad] and speed factor of each step, (n, 2).
        """
        rules, objective, candidates = self.rules, self.objective, []
        actions = actions_of(objective.rules.largest)
        for n in range(self.searched):
            start, model = self.starts[n], self.models[n]
            path = beam_search(start, actions, model, objective, rules)
            if len(path) < rules.horizon:
                wide = rules._replace(width=WIDER * rules.width)
                path = beam_search(start, actions, model, objective, wide)
            candidates.append(actions[path])
        outcomes = [self.outcome(moves) for moves in candidates]
        found = max(outcomes)
        steps, least = self.outcome(rest)
        ends = self.kept and found[0] > rules.horizon - ROUNDING
        if (steps + self.kept, least) > found and not ends:
            return rest, steps
        return candidates[outcomes.index(found)], found[0]


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
