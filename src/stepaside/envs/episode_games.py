"""Games of episodes, in which some players are controlled from outside."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from math import inf

from ..arena import Room
from ..core.poses import Pose
from ..games.floor_world import FloorWalk, FloorWorld
from ..games.game import GameInPlay
from ..games.outcome import Outcome
from ..games.recorded_game import RecordedGame
from ..planning import Direction
from ..strategies.knowledge import STAND, Intent, Knowledge


class EpisodeGame(ABC):
    """Game of one episode.

    Attributes:
        room: The room.
        identities: Identity of each player, by name.
        duration: Time limit, in [s].
        closest: Closest approach of each evader so far, in [m], by name; 0
            after a fall, or contact with an obstacle.
        ended: Outcome in one word; empty while the game goes on. The time
            limit does not end it.
    """

    def __init__(self, game: GameInPlay, room: Room, duration: float) -> None:
        """Note who approaches whom.

        Args:
            game: The game.
            room: Its room.
            duration: Time limit, in [s].
        """
        self._game, self.room = game, room
        self.identities = identities = game.rules.identities
        self.duration, self.ended = duration, ""
        self._others = {
            name: [n for n, who in identities.items() if own.opposes(who)]
            or [n for n in identities if n != name]
            for name, own in identities.items()
            if own.role == "evader"
        }
        self.closest = dict.fromkeys(self._others, inf)
        self._note()

    @property
    def time(self) -> float:
        """Time, in [s]."""
        return self._game.world.time

    @property
    def poses(self) -> Mapping[str, Pose]:
        """Pose of each player in the room, by name."""
        return self._game.world.states()

    @abstractmethod
    def knowledge(self, name: str) -> Knowledge | None:
        """Return what a controlled player knows; None before it sees."""

    @abstractmethod
    def step(self, intents: Mapping[str, Intent]) -> None:
        """Play one step of the environment.

        Args:
            intents: Intent of each controlled player, by name.

        Raises:
            StrategyError: If a strategy returns no intent.
        """

    @property
    def truncated(self) -> bool:
        """Whether the time is up."""
        return self.time >= self.duration - 1e-9 and not self.ended

    @property
    def over(self) -> bool:
        """Whether the episode is over."""
        return bool(self.ended) or self.truncated

    @property
    def distances(self) -> dict[str, float]:
        """Distance of each evader from the nearest pursuer, in [m], by name.

        Without pursuers, from the nearest of all other players.
        """
        apart = self._game.world.apart
        return {
            name: min((apart(name, n) for n in others), default=inf)
            for name, others in self._others.items()
        }

    def close(self) -> None:
        """Release its resources."""
        self._game.world.close()

    def _note(self) -> None:
        """Update the closest approaches."""
        for name, apart in self.distances.items():
            self.closest[name] = min(self.closest[name], apart)


class FloorGame(EpisodeGame):
    """Game without bodies; a step is one decision, or lasts a period."""

    def __init__(
        self, game: GameInPlay, room: Room, period: float | None = None
    ) -> None:
        """Begin a game.

        Args:
            game: The game, on a floor.
            room: Its room.
            period: Duration of a step, in [s]; that of one decision by
                default.
        """
        super().__init__(game, room, game.rules.duration)
        assert isinstance(game.world, FloorWorld)
        self._world = game.world
        self._period, self._until = period, 0.0

    def knowledge(self, name: str) -> Knowledge | None:
        """Return what a controlled player knows."""
        return self._world.knowledge(name)

    def step(self, intents: Mapping[str, Intent]) -> None:
        """Play one step of the environment."""
        for name, intent in intents.items():
            motion = self._world.motions[name]
            assert isinstance(motion, FloorWalk)
            motion.given = intent
        if self._period is None:
            self._advance(inf)
            return
        self._until += self._period
        while not self.over and self.time < self._until - 1e-9:
            self._advance(self._until)

    def _advance(self, until: float) -> None:
        """Play to the next decision, at most to a time, in [s]."""
        self._game.tick(until)
        self._note()
        ended = self._game.ended
        if ended is None:
            return
        if ended.outcome is Outcome.COMPLETED and self.truncated:
            return
        self.ended = str(ended.outcome)
        if ended.outcome is Outcome.TOUCHED:
            self.closest |= dict.fromkeys(
                self.closest.keys() & set(ended.players), 0.0
            )


class HeldIntent:
    """Strategy that returns the intent that it holds.

    It is not pure: the intent is replaced from outside, between decisions.

    Attributes:
        direction: Whether the body drives forward or backward.
        saturated: False: it turns by (8).
        intent: The intent.
        known: Knowledge at the last decision; None before.
        steps: Number of decisions while walking.
    """

    saturated = False

    def __init__(self, direction: Direction) -> None:
        """Hold the intent to stand."""
        self.direction = direction
        self.reset()

    def reset(self) -> None:
        """Forget all decisions."""
        self.intent = STAND
        self.known: Knowledge | None = None
        self.steps = 0

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Store the knowledge and return the intent."""
        self.known = knowledge
        self.steps += knowledge.moving
        return self.intent, None


class PhysicsGame(EpisodeGame):
    """Game between simulated robots.

    A robot decides when a foot has landed. A step of the environment lasts a
    period, or until the next decision of the leader, and one step duration
    while it stands. That decision already takes the given intent: the
    knowledge after the step is that of the decision, and the next action
    serves the next one.
    """

    def __init__(
        self,
        match: RecordedGame,
        held: Mapping[str, HeldIntent],
        room: Room,
        duration: float,
        *,
        period: float | None = None,
        patience: float,
        captures: bool = False,
    ) -> None:
        """Play until all controlled players see the others, standing.

        Args:
            match: The game in physics.
            held: Strategy of each controlled player, by name; the last one
                leads.
            room: The room.
            duration: Time limit, in [s].
            period: Duration of a step, in [s]; to the next decision of the
                leader by default.
            patience: Longest time until they see them, in [s].
            captures: Whether the first capture ends the game.
        """
        super().__init__(match, room, duration)
        self._match, self._held, self._captures = match, held, captures
        self._period = period
        self._leader = [*held.values()][-1]
        for own in held.values():
            own.reset()  # decisions of its validation
        while not (self.sees or self.ended or self.time > patience):
            self._tick()
        self._until = self.time  # end of the present step

    @property
    def sees(self) -> bool:
        """Whether all controlled players have seen the others."""
        return all(own.known is not None for own in self._held.values())

    def knowledge(self, name: str) -> Knowledge | None:
        """Return what a controlled player knew at its last decision."""
        return self._held[name].known

    def step(self, intents: Mapping[str, Intent]) -> None:
        """Play one step of the environment."""
        for name, intent in intents.items():
            self._held[name].intent = intent
        if self._period is not None:
            self._until += self._period
            tick = self._match.in_physics.physics.tick
            while not self.over and self.time + tick <= self._until + 1e-9:
                self._tick()
            return
        leader = self._leader
        assert leader.known is not None
        steps, until = leader.steps, self.time
        until += leader.known.limits.step_duration
        while not self.over and leader.steps == steps:
            self._tick()
            if self.time >= until - 1e-9 and not leader.known.moving:
                if not leader.intent.walks:
                    return
            if self.time >= until + leader.known.limits.step_duration:
                return  # it is held up: it starts, halts or has lost sight

    def _tick(self) -> None:
        """Advance by one control tick."""
        outcome = self._match.tick()
        self._note()
        if outcome is not None:
            self.ended = str(outcome)
            lost = self.closest.keys() & self._failures()
            self.closest |= dict.fromkeys(lost, 0.0)
        elif self._captures and self._match.captured_at:
            self.ended = str(Outcome.CAPTURED)

    def _failures(self) -> set[str]:
        """Return the players that fell or touched no opponent."""
        match, ids = self._match, self.identities
        touched = ids.keys() & set(match.touched)
        alone = {
            name
            for name in touched
            if not any(ids[name].opposes(ids[other]) for other in touched)
        }
        return alone | set(match.fallen)
