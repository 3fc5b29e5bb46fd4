"""Settings that all learning environments share."""

from dataclasses import dataclass, field, replace

from ..arena import Room, RoomRecipe
from ..core.errors import (
    ConfigurationError,
    check_choice,
    check_not_negative,
    check_within,
)
from ..games.duel_settings import PLAYERS, DuelSettings
from ..games.floor_world import PARTS
from ..planning import Direction
from ..strategies.learned.observation_terms import (
    FULL_STATE_TERMS,
    SENSED_TERMS,
    ObservedTerm,
)
from ..strategies.learned.strategy_contract import (
    HEADINGS,
    StrategyContract,
    discrete_headings,
)
from ..strategies.strategy_game import StepGame
from .arena_pool import ArenaPool

LEVELS = ("unicycle", "steps", "physics")
ALL_TERMS: dict[str, ObservedTerm] = SENSED_TERMS | FULL_STATE_TERMS
ACTIONS = ("continuous", "discrete")


@dataclass(frozen=True)
class EnvironmentSettings:
    """Game, observation, action and reward of an environment.

    Attributes:
        level: "unicycle", with eight decisions per step, "steps", or
            "physics", two simulated humanoids.
        room: A room, a recipe for random rooms, or None for an open floor.
            In physics set ``duel.room`` instead.
        arenas: Number of different rooms and starts; every episode takes one
            of them. Not used in physics, where each episode has a seed of
            its own.
        first_arena: Seed of the first arena.
        any_heading: Whether players begin with any headings, on an open
            floor without physics; otherwise the pursuer within 90 degrees,
            the evader within 30 degrees of facing the other.
        duration: Duration of an episode, in [s]: path time, in physics
            simulated time.
        full_state: Whether observations also contain what no sense gives;
            see :data:`.observation_terms.FULL_STATE_TERMS`.
        action: "continuous" (heading and speed factor) or "discrete".
        headings: Number of headings of discrete actions; one more action
            stands.
        shaping: Weight of the potential-based shaping reward.
        discount: Discount of the learner, for the shaping.
        game: Rules at levels "unicycle" and "steps"; its duration and its
            decisions are set by the level.
        duel: Settings of the duel in physics: robots, bodies, sensing,
            people, learned legs.
    """

    level: str = "unicycle"
    room: Room | RoomRecipe | None = None
    arenas: int = 256
    first_arena: int = 0
    any_heading: bool = False
    duration: float = 60.0
    full_state: bool = False
    action: str = "continuous"
    headings: int = HEADINGS
    shaping: float = 0.0
    discount: float = 1.0
    game: StepGame = field(default_factory=StepGame)
    duel: DuelSettings = field(default_factory=DuelSettings)

    def __post_init__(self) -> None:
        """Validate names, ranges and combinations."""
        check_choice(self.level, LEVELS, "level")
        check_choice(self.action, ACTIONS, "action")
        error = ConfigurationError
        check_within(self.duration, 0.01, 3600.0, "duration", "s", error)
        check_within(self.headings, 2, 1000, "headings", "1", error)
        check_not_negative(self.shaping, "shaping", "1", error)
        check_within(self.discount, 0.0, 1.0, "discount", "1", error)
        if self.level == "physics" and self.room is not None:
            raise error("room must be given as duel.room at level physics")
        for name in ("full_state", "any_heading"):
            if self.level == "physics" and getattr(self, name):
                raise error(f"{name} must be false at level physics")
        if self.level != "physics" and self.game.solid_pursuer:
            raise error(
                "game.solid_pursuer must be false: pursuers of "
                "environments pass through obstacles"
            )

    def draw_arenas(self) -> ArenaPool:
        """Draw the arenas, at levels "unicycle" and "steps"."""
        return ArenaPool.draw(
            self.room,
            self.arenas,
            self.first_arena,
            any_heading=self.any_heading,
        )

    @property
    def step_game(self) -> StepGame:
        """Rules of the game at levels "unicycle" and "steps"."""
        return replace(
            self.game, duration=self.duration, decisions=PARTS[self.level]
        )

    @property
    def in_rooms(self) -> bool:
        """Whether there may be obstacles."""
        if self.level == "physics":
            return self.duel.room.plan is not None
        return self.room is not None

    @property
    def sensed_terms(self) -> tuple[str, ...]:
        """Terms of the observation that a strategy can have, too."""
        clear = ("clearances",) if self.in_rooms else ()
        names = (n for n in SENSED_TERMS if n != "clearances")
        return (*names, *clear)

    @property
    def terms(self) -> tuple[str, ...]:
        """All terms of the observation, in order."""
        more = tuple(FULL_STATE_TERMS) if self.full_state else ()
        return self.sensed_terms + more

    @property
    def action_headings(self) -> tuple[float | None, ...]:
        """Heading of each discrete action, in [rad]; empty if continuous."""
        if self.action == "continuous":
            return ()
        return discrete_headings(self.headings)

    def contract(self, role: str) -> StrategyContract:
        """Return the contract of a strategy learned here, without full state.

        Args:
            role: "pursuer" or "evader".
        """
        return StrategyContract(
            direction_of(role), self.sensed_terms, self.action_headings
        )


def direction_of(role: str) -> Direction:
    """Return the direction in which a role drives, (1) or (3)."""
    check_choice(role, PLAYERS, "role")
    return Direction.FORWARD if role == "pursuer" else Direction.BACKWARD
