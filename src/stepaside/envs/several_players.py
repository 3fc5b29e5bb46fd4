"""One game of several players in which some are controlled from outside."""

from collections.abc import Mapping
from dataclasses import replace
from math import hypot, inf

import numpy as np
from numpy.typing import NDArray

from ..arena import OPEN_FLOOR, Room
from ..core.constants import CAPTURE_DISTANCE
from ..core.poses import Pose
from ..games.floor_games import floor_of
from ..games.floor_world import PERIOD, FloorWorld
from ..games.game_match import GameMatch
from ..games.game_settings import GameSettings, PlayerSettings
from ..games.game_starts import with_starts
from ..games.outcome import Outcome
from ..strategies.knowledge import Intent, Knowledge, OtherPlayer
from ..strategies.learned.observation_terms import (
    FARTHEST,
    FASTEST,
    SENSED_TERMS,
    length_unit,
    observe,
)
from ..strategies.strategy_game import StepGame
from .environment_settings import direction_of
from .held_intent import HeldIntent

OTHER_WIDTH = 8
"""Values that describe one other player: 1 if there is one, cosine and sine
of its bearing, distance [v/k], its velocity ahead and to the left [v], 1 if
it is an opponent, 1 if it is a teammate."""
LONGEST_WAIT = 1.0  # for the first decisions in physics, in [s]
BODY_RADIUS = StepGame().body_radius


class SeveralPlayers:
    """Game of any number of players at any level.

    Attributes:
        room: The room.
        unit: Unit of length of each controlled player, v/k of its gait, in
            [m], by name.
        closest: Smallest of :meth:`distances` of each evader so far, in [m],
            by name; 0 after contact with an obstacle or a fall.
        ended: Outcome in one word; empty while the game goes on.
    """

    def __init__(self, settings: GameSettings, names: tuple[str, ...]) -> None:
        """Place the players.

        Args:
            settings: Settings of the game.
            names: Names of the controlled players.

        Raises:
            StepAsideError: If the settings contradict each other.
        """
        self._held = {
            name: HeldIntent(direction_of(settings.player(name).role))
            for name in names
        }
        players = tuple(
            replace(own, strategy=self._held.get(own.name, own.strategy))
            for own in settings.players
        )
        settings = with_starts(replace(settings, players=players))
        self.room: Room = settings.room or OPEN_FLOOR
        self.unit = {
            name: length_unit_of(settings.player(name)) for name in names
        }
        self._settings = settings
        self._ids = settings.identities
        self._match: GameMatch | FloorWorld
        if settings.level == "physics":
            self._match = GameMatch(settings, recorded=False)
            self._tick = self._match.world.physics.tick
            self._outcome: Outcome | None = None
        else:
            self._match = floor_of(settings)
            self._tick = PERIOD
        for held in self._held.values():
            held.reset()  # decisions of its validation
        self.ended = ""
        self.closest = dict.fromkeys(self._evaders, inf)
        self._judge()
        self._wait()
        self._until = self.time  # where the next period begins, in [s]

    @property
    def _evaders(self) -> list[str]:
        return [p.name for p in self._settings.players if p.role == "evader"]

    @property
    def time(self) -> float:
        """Time, in [s]."""
        if isinstance(self._match, FloorWorld):
            return self._match.time
        return self._match.world.time

    @property
    def poses(self) -> dict[str, Pose]:
        """Pose of each player in the world, by name."""
        if isinstance(self._match, FloorWorld):
            return dict(self._match.states())
        return {p.name: p.snapshot().place for p in self._match.players}

    def play(self, intents: Mapping[str, Intent], period: float) -> None:
        """Play for a time, or to the end.

        Args:
            intents: Intent of each controlled player, by name.
            period: Time, in [s].
        """
        for name, intent in intents.items():
            self._held[name].intent = intent
        self._until += period
        while not self.ended and self.time + self._tick <= self._until + 1e-9:
            self._advance()
        self._look()

    def distances(self, evader: str) -> list[float]:
        """Return the distances of an evader from its pursuers, in [m].

        Without pursuers, those from all other players.
        """
        poses = self.poses
        x, y, _ = poses.pop(evader)
        names = self._settings.opponents_of(evader) or poses
        return [hypot(poses[name].x - x, poses[name].y - y) for name in names]

    def observation(self, name: str) -> NDArray[np.float32]:
        """Return the observation of a controlled player.

        Its own terms, then :data:`OTHER_WIDTH` values of each other player,
        the nearest first; zeros for those that it has not seen.
        """
        own = own_terms(self._settings)
        count = len(self._settings.players) - 1
        others = np.zeros((count, OTHER_WIDTH), np.float32)
        known = self._held[name].known
        if known is None:
            width = sum(SENSED_TERMS[term].width for term in own)
            return np.concatenate(
                [np.zeros(width, np.float32), others.ravel()]
            )
        seen = sorted(known.others, key=lambda other: other.distance)
        for row, other in zip(others, seen, strict=False):
            row[:] = _describe(known, other)
        return np.concatenate([observe(known, own), others.ravel()])

    def close(self) -> None:
        """Release the robots."""
        if isinstance(self._match, GameMatch):
            self._match.close()

    def _wait(self) -> None:
        """Let every controlled player see the others once, standing."""
        if isinstance(self._match, GameMatch):
            while self.time < LONGEST_WAIT and not self.ended:
                if all(held.known for held in self._held.values()):
                    return
                self._advance()
        self._look()

    def _advance(self) -> None:
        """Advance by one tick, or one sample."""
        if isinstance(self._match, FloorWorld):
            self._match.decide()
            self._match.step(self._until)
        else:
            self._outcome = self._match.tick()
        self._judge()

    def _look(self) -> None:
        """Update what the controlled templates know; robots decide late."""
        if isinstance(self._match, FloorWorld):
            for name, held in self._held.items():
                held.known = self._match.knowledge(name)

    def _judge(self) -> None:
        """Update the closest approaches, and end the game if it is over."""
        failed: set[str] = set()
        if isinstance(self._match, GameMatch):
            failed = self._failures(self._match)
        for name in self._evaders:
            pose = self.poses[name]
            if isinstance(self._match, FloorWorld) and self.room.solids:
                gap = float(self.room.clearance([pose[:2]])[0])
                if gap < BODY_RADIUS:
                    failed.add(name)
                    self.ended = "touched"
            apart = min(self.distances(name), default=inf)
            self.closest[name] = min(self.closest[name], apart)
            if apart <= CAPTURE_DISTANCE:
                self.ended = "captured"
        for name in failed & self.closest.keys():
            self.closest[name] = 0.0

    def _failures(self, match: GameMatch) -> set[str]:
        """Return the players that fell or touched no opponent."""
        if self._outcome is None:
            return set()
        self.ended = str(self._outcome)
        touched = set(match.touched)
        ids = self._ids
        alone = {
            name
            for name in touched & ids.keys()
            if not any(
                ids[name].opposes(ids[other]) for other in touched & ids.keys()
            )
        }
        return set(match.fallen) | alone


def own_terms(settings: GameSettings) -> tuple[str, ...]:
    """Return the terms of an observation that describe the player itself."""
    return ("moving",) if settings.room is None else ("moving", "clearances")


def length_unit_of(player: PlayerSettings) -> float:
    """Return the unit of length of a player, in [m]."""
    return player.gait.speed / player.gait.gain


def _describe(known: Knowledge, other: OtherPlayer) -> list[float]:
    """Return the values of one other player; see :data:`OTHER_WIDTH`."""
    limits, own = known.limits, known.identity
    assert own is not None
    # Velocities are sensed in gait time; the speed is that of path time.
    pace = limits.step_duration * limits.speed / limits.stride
    velocity = [
        min(max(v * pace / limits.speed, -FASTEST), FASTEST)
        for v in other.velocity or (0.0, 0.0)
    ]
    return [
        1.0,
        np.cos(other.bearing),
        np.sin(other.bearing),
        min(other.distance / length_unit(limits), FARTHEST),
        *velocity,
        float(own.opposes(other.identity)),
        float(own.is_with(other.identity)),
    ]
