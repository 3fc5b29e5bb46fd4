"""Duels without bodies that tests play with strategies as objects."""

from dataclasses import replace
from typing import Any

from stepaside.arena import Room
from stepaside.core.poses import Pose
from stepaside.games import StrategyTrack, duel
from stepaside.games.floor_games import floor_of, play_floor, rules_of
from stepaside.games.strategy_games import track_of
from stepaside.strategies import Strategy

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
    """Play a number of steps of two NAO.

    Pursuers pass through obstacles unless it is changed, like other settings
    of a duel.
    """
    game = duel(
        **{
            "level": "steps",
            "duration": steps * STEP,
            "pursuers_pass": True,
            **changes,
        }
    )
    game = replace(game, room=room).started_at(starts)
    world = floor_of(game, {"pursuer": pursuer, "evader": evader})
    return track_of(*play_floor(world, rules_of(game)), room)
