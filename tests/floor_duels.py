"""Duels without bodies that tests play with strategies as objects."""

from dataclasses import replace
from typing import Any

from stepaside.arena import Room
from stepaside.core.poses import Pose
from stepaside.games import duel
from stepaside.strategies import Strategy
from stepaside.studies.tournament import StrategyTrack, record_steps

STEP = 0.547  # duration of a step of NAO, in [s]


def play_steps(
    pursuer: Strategy,
    evader: Strategy,
    starts: tuple[Pose, Pose],
    steps: int,
    /,
    *,
    room: Room | None = None,
    **changes: Any,
) -> StrategyTrack:
    """Play a number of steps of two NAO, with changed settings of a duel."""
    game = duel(**{"level": "steps", "duration": steps * STEP, **changes})
    game = replace(game, room=room).started_at(starts)
    return record_steps(game, {"pursuer": pursuer, "evader": evader})
