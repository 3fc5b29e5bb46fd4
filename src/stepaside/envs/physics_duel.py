"""One game of an environment between simulated humanoids."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ..arena import OPEN_FLOOR
from ..core.errors import StrategyError
from ..core.poses import Pose
from ..games.duel import Duel
from ..games.duel_settings import EVADER, PLAYERS, PURSUER, DuelSettings
from ..games.outcome import Outcome
from ..locomotion.policy.network_pool import NetworkPool
from ..planning import Direction
from ..strategies.knowledge import Intent, Knowledge
from ..strategies.strategy import Strategy
from .held_intent import HeldIntent

LONGEST_WAIT = 30.0  # for the first sighting, in [s]


class PhysicsDuel:
    """Game at level "physics"; see :class:`.template_duel.EnvironmentGame`.

    A humanoid decides when a foot has landed. A step of the environment
    lasts until the next such decision of the evader, or of the pursuer if
    only that one is controlled, and one step duration while it stands. That
    decision already takes the given intent: the knowledge after the step is
    that of the decision, and the next action serves the next one.

    Attributes:
        duel: The duel.
        room: The room.
    """

    def __init__(
        self,
        settings: DuelSettings,
        strategies: tuple[Strategy | str | None, Strategy | str | None],
        *,
        rendered: bool = False,
        networks: NetworkPool | None = None,
    ) -> None:
        """Place the robots.

        Args:
            settings: Settings of the duel.
            strategies: Strategies of pursuer and evader; None for a player
                whose intents are given.
            rendered: Whether images will be rendered.
            networks: Networks of learned legs, shared with other games.

        Raises:
            StepAsideError: If the settings contradict each other, or a
                player does not see the other.
        """
        directions = Direction.FORWARD, Direction.BACKWARD
        self._held = {
            name: HeldIntent(direction)
            for name, direction, own in zip(
                PLAYERS, directions, strategies, strict=True
            )
            if own is None
        }
        pursuer, evader = (
            self._held.get(name, own)
            for name, own in zip(PLAYERS, strategies, strict=True)
        )
        changes = {"evader_strategy": evader}
        if settings.pursuer == "robot":
            changes["pursuer_strategy"] = pursuer
        settings = replace(settings, **changes)  # type: ignore[arg-type]
        self.duel = Duel(
            settings, recorded=False, rendered=rendered, networks=networks
        )
        self.room = settings.room.plan or OPEN_FLOOR
        self._duration = settings.duration
        self._leader = self._held[EVADER if EVADER in self._held else PURSUER]
        self._outcome: Outcome | None = None
        for held in self._held.values():
            held.reset()  # decisions of its validation
        while any(held.known is None for held in self._held.values()):
            self._outcome = self.duel.tick()
            if self.ended or self.time > LONGEST_WAIT:
                self.close()
                raise StrategyError(
                    "a player must see its opponent within "
                    f"{LONGEST_WAIT:g} s, got {self.ended or 'no sighting'}"
                )

    @property
    def time(self) -> float:
        """Simulated time, in [s]."""
        return self.duel.world.time

    @property
    def truncated(self) -> bool:
        """Whether the time is up."""
        return self.time >= self._duration - 1e-9

    @property
    def ended(self) -> str:
        """Outcome in one word; empty while the game goes on."""
        return "" if self._outcome is None else str(self._outcome)

    @property
    def distance(self) -> float:
        """Distance between the torsos, in [m]."""
        return self.duel.torsos_apart or 0.0

    @property
    def closest(self) -> float:
        """Closest approach so far, in [m].

        It is 0 after contact with an obstacle, or a fall of the evader.
        """
        outcome, duel = self._outcome, self.duel
        if outcome is Outcome.CONTACT and PURSUER not in duel.touched:
            return 0.0
        if outcome is Outcome.FALL and duel.player(EVADER).has_fallen:
            return 0.0
        return self.duel.min_distance or 0.0

    @property
    def knowledge(self) -> tuple[Knowledge | None, Knowledge | None]:
        """Knowledge of the controlled players at their last decisions."""
        pursuer, evader = (
            self._held[name].known if name in self._held else None
            for name in PLAYERS
        )
        return pursuer, evader

    @property
    def poses(self) -> tuple[Pose, Pose]:
        """Poses of pursuer and evader in the world."""
        pursuer, evader = (p.snapshot().place for p in self.duel.players)
        return pursuer, evader

    def step(self, intents: Sequence[Intent | None]) -> Iterator[None]:
        """Play until the next decision.

        Yields whenever robots wait for their networks: ``duel.networks``
        must be flushed then.

        Args:
            intents: Intent of pursuer and evader; None for a player with a
                strategy.
        """
        for name, intent in zip(PLAYERS, intents, strict=True):
            if name in self._held:
                if intent is None:
                    raise StrategyError(f"{name} needs an intent, got none")
                self._held[name].intent = intent
        leader = self._leader
        assert leader.known is not None
        steps, until = leader.steps, self.time
        until += leader.known.limits.step_duration
        while not (self.ended or self.truncated):
            yield from self._tick()
            if leader.steps > steps:
                return
            if self.time >= until - 1e-9 and not leader.known.moving:
                if not leader.intent.walks:
                    return
            if self.time >= until + leader.known.limits.step_duration:
                return  # it is held up: it starts, halts or has lost sight

    def close(self) -> None:
        """Release the robots."""
        self.duel.close()

    def _tick(self) -> Iterator[None]:
        """Advance by one control tick."""
        self._outcome = self.duel.decide()
        if self._outcome is None:
            yield
            self._outcome = self.duel.advance()
