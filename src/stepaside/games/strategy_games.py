"""Games of two unicycles by any strategies, and tracks of such games."""

from typing import NamedTuple

import numpy as np

from ..arena import OPEN_FLOOR, Room
from ..core.errors import check_positive
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Array
from ..strategies.evasion import Evasion
from ..strategies.knowledge import Limits
from ..strategies.registry import load_strategy
from ..strategies.strategy import Strategy
from ..theory.unicycle.simulation import RelativeStart
from ..theory.unicycle.unicycle_game import Unicycles
from .floor_games import play_floor
from .floor_world import FloorAgent, FloorRecorder, FloorWalk, FloorWorld
from .game import GameInPlay, GameRules, Outcome
from .player_settings import PLAYERS

UNBOUNDED = 1e9  # safety radius of a game without safety area, in [m]
PAIR = {name: PlayerIdentity(name, Role(name), name) for name in PLAYERS}
"""Identities of pursuer and evader."""


class StrategyTrack(NamedTuple):
    """Recorded game of pursuer and evader, one pose at each decision."""

    outcome: Outcome  # of the game
    times: Array  # of the poses, from the start on [s]. (n,)
    pursuer: Array  # poses x [m], y [m], theta [rad]. (n, 3)
    evader: Array  # likewise. (n, 3)
    clearances: Array  # of the evader's centre [m]. (n,)
    # mean processor time of a decision of the evader, without the first one,
    # which loads code [s]
    decision: float
    longest_decision: float  # likewise

    @property
    def distances(self) -> Array:
        """Distance between the two, in [m]. Shape (n,)."""
        apart = self.evader - self.pursuer
        found: Array = np.hypot(apart[:, 0], apart[:, 1])
        return found

    @property
    def closest_distance(self) -> float:
        """Least recorded distance, in [m]."""
        return float(self.distances.min())


def play_unicycles(
    game: Unicycles,
    start: RelativeStart,
    strategies: tuple[str | Strategy, str | Strategy],
    times: tuple[float, float],
    capture: float,
) -> StrategyTrack:
    """Play a game of unicycles with strategies of pursuer and evader.

    The paper's evader evades from the begin. ``times`` are duration and
    decision period, in [s]; the capture distance, in [m], ends the game.
    """
    evasion = Evasion(
        game.angle,
        game.saturated,
        safety_radius=UNBOUNDED,
        side_hysteresis=game.hysteresis,
    )
    duration, period = times
    check_positive(period, "period", "s")
    rates = (
        (game.pursuer_speed, game.pursuer_gain),
        (game.evader_speed, game.evader_gain),
    )
    motions = {
        name: FloorWalk(
            FloorAgent(
                load_strategy(strategy, evasion),
                Limits(speed, gain, speed * period, period),
                PAIR[name],
                list(PAIR.values()),
            ),
            pose,
        )
        for name, strategy, (speed, gain), pose in zip(
            PLAYERS, strategies, rates, start.poses(), strict=True
        )
    }
    count = max(1, round(duration / period))
    rules = GameRules(count * period, capture, PAIR)
    return track_of(*play_floor(FloorWorld(motions), rules))


def track_of(
    game: GameInPlay, recorder: FloorRecorder, room: Room | None = None
) -> StrategyTrack:
    """Return the record of a finished game of pursuer and evader."""
    assert game.outcome is not None
    poses, evades = recorder.poses(), recorder.world.motions["evader"]
    times = evades.decision_times if isinstance(evades, FloorWalk) else []
    return StrategyTrack(
        game.outcome,
        recorder.times,
        poses["pursuer"],
        poses["evader"],
        (room or OPEN_FLOOR).clearance(poses["evader"][:, :2]),
        float(np.mean(times[1:] or times or [0.0])),
        max(times[1:], default=0.0),
    )
