"""Evasion from a pursuer that is not known."""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np

from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import ConfigurationError, check_positive, check_within
from ..core.poses import Array
from .knowledge import ON_THE_SPOT, Intent, Knowledge
from .opponent_models import ASSUMED, MODELS, ModelFit
from .search.pursuer_model import BeamRules
from .strategy import BackwardStrategy

ERROR = ConfigurationError
MARGIN = 0.005  # in addition to the required clearance, in [m]
TURNS = 7  # turns tried per step
WIDER = 20  # times the width where no state survives the horizon
KEPT = 0.8  # of a plan is left when it is searched again: 0.5 loses 2 %


class RobustMemory(NamedTuple):
    """Memory of a robust evader.

    Attributes:
        fit: Models of the pursuer, and their errors.
        moves: Turn [rad] and speed factor of the planned steps to come.
        assumed: Models that the plan was made for.
        planned: Number of steps of the plan when it was made.
        doomed: Whether no state of the search survived its horizon.
    """

    fit: ModelFit = ModelFit()
    moves: tuple[tuple[float, float], ...] = ()
    assumed: tuple[int, ...] = ()
    planned: int = 0
    doomed: bool = True


@dataclass(frozen=True, slots=True)
class RobustEvasion(BackwardStrategy):
    """Evader that plans against every model of the pursuer that is plausible.

    The models that explain the last seconds are kept; for each a beam search
    looks for the game that survives longest, and the plan that survives
    longest against the worst of them is walked. It backs away, turns on the
    spot and goes around obstacles.

    Attributes:
        width: Number of states that the search follows.
        horizon: Number of steps that it looks ahead against the greatest
            number of models; against fewer it looks further, by the same
            number of steps in all.
        capture: Distance at which the evader counts as captured, in [m].
        body_radius: Least distance of the own centre to obstacles, in [m].
    """

    width: int = 200
    horizon: int = 75
    capture: float = CAPTURE_DISTANCE
    body_radius: float = 0.2

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_within(self.width, 1, 10_000, "width", "1", ERROR)
        check_within(self.horizon, 1, 1000, "horizon", "1", ERROR)
        check_positive(self.capture, "capture", "m", ERROR)
        check_positive(self.body_radius, "body_radius", "m", ERROR)

    def begin(self) -> RobustMemory:
        """Return the memory before the first sighting."""
        return RobustMemory()

    def decide(
        self, knowledge: Knowledge, memory: RobustMemory
    ) -> tuple[Intent, RobustMemory]:
        """Take the first step of the plan with the best worst outcome."""
        limits, own = knowledge.limits, knowledge.pose_in_map
        share = limits.gain * limits.stride / limits.speed
        rules = BeamRules(
            limits.stride, share, pi * share, self.capture + MARGIN,
            self.body_radius + MARGIN, self.width, self.horizon,
        )  # fmt: skip
        sight = own.theta + knowledge.bearing
        position = (
            own.x + knowledge.distance * cos(sight),
            own.y + knowledge.distance * sin(sight),
        )
        fit = memory.fit.observe(
            knowledge.time - knowledge.age,
            own,
            position,
            rules,
            limits.step_duration,
        )
        assumed = tuple(fit.plausible())
        memory = memory._replace(fit=fit, moves=memory.moves[1:])
        spent = len(memory.moves) < KEPT * memory.planned
        if assumed != memory.assumed or spent or memory.doomed:
            horizon = self.horizon * ASSUMED // len(assumed)
            rules = rules._replace(horizon=horizon)
            moves = self._plan(knowledge, fit, assumed, memory.moves, rules)
            memory = RobustMemory(
                fit, moves, assumed, len(moves), len(moves) < horizon
            )
        turn, speed = (memory.moves or ((rules.largest, ON_THE_SPOT),))[0]
        return Intent(turn / share, speed), memory

    def _plan(
        self,
        knowledge: Knowledge,
        fit: ModelFit,
        assumed: tuple[int, ...],
        rest: tuple[tuple[float, float], ...],
        rules: BeamRules,
    ) -> tuple[tuple[float, float], ...]:
        """Return the moves with the best outcome against the worst model."""
        from .search.beam_search import beam_search, survived_steps

        packed = knowledge.obstacles_in_map.packed
        actions = actions_of(rules.largest)
        begins = knowledge.step_start_in_map or knowledge.pose_in_map
        models, starts, candidates = [], [], []
        for number in assumed:
            model = MODELS[number]._replace(speed=fit.speed)
            start = np.array([*begins, *fit.position, fit.headings[number]])
            path = beam_search(start, actions, model, packed, rules)
            if len(path) < rules.horizon:
                wide = rules._replace(width=WIDER * rules.width)
                path = beam_search(start, actions, model, packed, wide)
            models.append(model)
            starts.append(start)
            candidates.append(actions[path])
        if rest:
            candidates.append(np.array(rest))
        if len(models) == 1 and not len(rest):
            best = candidates[0]
        else:
            best = max(
                candidates,
                key=lambda moves: min(
                    survived_steps(start, moves, model, packed, rules)
                    for start, model in zip(starts, models, strict=True)
                ),
            )
        return tuple((float(u), float(v)) for u, v in best)


@lru_cache(maxsize=8)
def actions_of(largest: float) -> Array:
    """Return the actions of a step: turns while walking, or on the spot.

    Args:
        largest: Largest turn of a step, in [rad].

    Returns:
        Turn [rad] and speed factor of each. Shape (n, 2).
    """
    walks = [(u, 1.0) for u in np.linspace(-largest, largest, TURNS)]
    spots = [(-largest, ON_THE_SPOT), (largest, ON_THE_SPOT)]
    return np.array(walks + spots)
