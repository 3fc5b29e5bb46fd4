"""Games of two strategies without physics."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..arena import NO_OBSTACLES, OPEN_FLOOR, Room
from ..core.constants import CAPTURE_DISTANCE
from ..core.errors import check_positive, check_within
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Array, Pose
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
    """Recorded game of two strategies."""

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
    def captured(self) -> bool:
        """Whether the distance fell to the capture distance."""
        return self.outcome is Outcome.CAPTURED

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


@dataclass(frozen=True, slots=True)
class StepGame:
    """Rules of a game by footsteps; times are path times."""

    stride: float = 0.04  # length of a step [m]
    speed: float = 0.1  # speed of the template [m/s]
    gain: float = 0.2  # steering gain k of both [1/s]
    capture: float = CAPTURE_DISTANCE  # distance of a capture [m]
    body_radius: float = 0.2  # least clearance of the evader [m]
    solid_pursuer: bool = False  # whether obstacles stop it
    duration: float = 180.0  # duration of a game [s]
    decisions: int = 1  # per step; with more, like unicycles
    pursuer_speed_ratio: float = 1.0  # also of strides
    pursuer_gain_ratio: float = 1.0  # of the steering

    def __post_init__(self) -> None:
        """Validate the rules."""
        for name, unit in (
            *(("stride", "m"), ("speed", "m/s"), ("gain", "1/s")),
            *(("capture", "m"), ("body_radius", "m"), ("duration", "s")),
        ):
            check_positive(getattr(self, name), name, unit)
        check_within(self.decisions, 1, 100, "decisions", "1")
        for name in ("pursuer_speed_ratio", "pursuer_gain_ratio"):
            check_within(getattr(self, name), 0.1, 10.0, name, "1")

    @classmethod
    def of_unicycles(
        cls,
        game: Unicycles,
        period: float,
        duration: float,
        capture: float = 1e-6,
    ) -> "StepGame":
        """Return the rules of unicycles that decide with a period, in [s].

        The game ends at a distance of capture [m] or after a duration [s].
        """
        check_positive(period, "period", "s")
        return cls(
            game.evader_speed * period,
            game.evader_speed,
            game.evader_gain,
            capture=capture,
            duration=duration,
            pursuer_speed_ratio=game.pursuer_speed / game.evader_speed,
            pursuer_gain_ratio=game.pursuer_gain / game.evader_gain,
        )

    @property
    def period(self) -> float:
        """Duration of a step, in [s]."""
        return self.stride / self.speed

    @property
    def count(self) -> int:
        """Number of decisions of a game."""
        return max(1, round(self.duration * self.decisions / self.period))

    @property
    def limits(self) -> tuple[Limits, Limits]:
        """Limits of the gaits of pursuer and evader."""
        evader = Limits(self.speed, self.gain, self.stride, self.period)
        ratio = self.pursuer_speed_ratio
        pursuer = replace(
            evader,
            speed=ratio * self.speed,
            stride=ratio * self.stride,
            gain=self.pursuer_gain_ratio * self.gain,
        )
        return pursuer, evader

    @property
    def rules(self) -> GameRules:
        """What ends a game, after a whole number of decisions."""
        duration = self.count * self.period / self.decisions
        return GameRules(duration, self.capture, PAIR)

    def world(
        self,
        strategies: tuple[Strategy, Strategy],
        starts: tuple[Pose, Pose],
        room: Room = OPEN_FLOOR,
    ) -> FloorWorld:
        """Return the world of pursuer and evader, at their initial poses."""
        solids = room.solid_set
        # A pursuer that obstacles do not stop plans no detours.
        stops = solids if self.solid_pursuer else NO_OBSTACLES
        motions = {}
        for i, known in enumerate((stops, solids)):
            agent = FloorAgent(
                strategies[i],
                self.limits[i],
                PAIR[PLAYERS[i]],
                list(PAIR.values()),
                obstacles=known,
            )
            motions[PLAYERS[i]] = FloorWalk(
                agent,
                starts[i],
                parts=self.decisions,
                walls=NO_OBSTACLES if i else stops,
                radius=self.body_radius,
            )
        return FloorWorld(motions, solids, ["evader"])


def play_strategies(
    pursuer: Strategy,
    evader: Strategy,
    starts: tuple[Pose, Pose],
    *,
    room: Room = OPEN_FLOOR,
    game: StepGame | None = None,
) -> StrategyTrack:
    """Play a game of two strategies without physics.

    Args:
        pursuer: Strategy of the pursuer.
        evader: Strategy of the evader.
        starts: Initial poses of pursuer and evader in the room.
        room: Room; the evader knows all obstacles, and so does a pursuer
            that they stop.
        game: Rules; by default those of :class:`StepGame`.

    Raises:
        StrategyError: If a strategy fails.
    """
    game = game or StepGame()
    world = game.world((pursuer, evader), starts, room)
    return track_of(*play_floor(world, game.rules), room)


def play_unicycles(
    game: Unicycles,
    start: RelativeStart,
    names: tuple[str, str],
    times: tuple[float, float],
    capture: float,
) -> StrategyTrack:
    """Play a game of unicycles with named strategies.

    The paper's evader evades from the begin. ``times`` are duration and
    decision period, in [s]; the capture distance, in [m], ends the game.
    """
    evasion = Evasion(
        game.angle,
        game.saturated,
        safety_radius=UNBOUNDED,
        side_hysteresis=game.hysteresis,
    )
    pursuer, evader = (load_strategy(name, evasion) for name in names)
    rules = StepGame.of_unicycles(game, times[1], times[0], capture)
    return play_strategies(pursuer, evader, start.poses(), game=rules)


def track_of(
    game: GameInPlay, recorder: FloorRecorder, room: Room = OPEN_FLOOR
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
        room.clearance(poses["evader"][:, :2]),
        float(np.mean(times[1:] or times or [0.0])),
        max(times[1:], default=0.0),
    )
