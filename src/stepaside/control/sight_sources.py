"""Sources of sightings of the opponent: measurements or camera."""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from ..core.player_identity import PlayerIdentity
from ..core.poses import ALL_AROUND, Array, Sector
from ..locomotion.locomotion import CurrentStep
from ..perception.measurement import RobotState, Sighting
from ..strategies.decision_maker import choose_opponent

if TYPE_CHECKING:
    from ..perception.pipeline import Perception
    from ..robots.forward_kinematics import ForwardKinematics

StepAt = Callable[[float], CurrentStep]


class PlayersInSight(NamedTuple):
    """Own identity and sightings of other players."""

    identity: PlayerIdentity
    # latest sighting of each other player, with its identity
    sightings: tuple[Sighting, ...]


class SightSource:
    """Source of sightings from all around, which leaves the head as it is."""

    @property
    def views(self) -> tuple[Sector, ...]:
        """Bearings at which others are seen."""
        return ALL_AROUND

    @property
    def turning(self) -> float:
        """Turn on the spot for a scan: 1 left, -1 right, or 0."""
        return 0.0

    @property
    def in_sight(self) -> PlayersInSight | None:
        """All players seen; None from a source that knows one opponent."""
        return None

    @property
    def forward(self) -> "ForwardKinematics | None":
        """Kinematics of the body that it measures, if it does."""
        return None

    @property
    def cameras(self) -> "Perception | None":
        """Perception by cameras, if it has one."""
        return None

    def see(
        self,
        measurement: RobotState,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Return the latest sighting of the opponent; None if it is lost."""
        raise NotImplementedError

    def aim(self, targets: Array) -> None:
        """Write the head angles, if any, into joint targets, in [rad]."""


class MeasuredSight(SightSource):
    """Latest of the sightings that measurements contain."""

    def __init__(self, sighting: Sighting | None = None) -> None:
        """Begin with an initial sighting, if any."""
        self._last = sighting

    def see(
        self,
        measurement: RobotState,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Return the newest sighting."""
        self._last = measurement.sighting or self._last
        return self._last


class SightOfPlayers(SightSource):
    """Latest sightings of several players, one of which is the opponent.

    See :func:`stepaside.strategies.decision_maker.choose_opponent`.
    """

    def __init__(self, identity: PlayerIdentity, target: str = "") -> None:
        self._identity, self._target = identity, target
        self._latest: dict[str, Sighting] = {}
        self._numbers: dict[str, int] = {}
        self._chosen = ""

    @property
    def in_sight(self) -> PlayersInSight:
        """Own identity, and the latest sighting of each player."""
        return PlayersInSight(self._identity, tuple(self._latest.values()))

    def see(
        self,
        measurement: RobotState,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Return the newest sighting of the opponent."""
        if measurement.players:
            self._note(measurement.players)
        return self._latest.get(self._chosen)

    def _note(self, sightings: tuple[Sighting, ...]) -> None:
        """Take the sightings of a tick, and choose the opponent again."""
        for sighting in sightings:
            assert sighting.identity is not None
            name = sighting.identity.name
            number = self._numbers.setdefault(name, len(self._numbers) + 1)
            self._latest[name] = sighting._replace(target_id=number)
        self._chosen = choose_opponent(
            self._identity,
            {
                seen.identity: seen.distance
                for seen in self._latest.values()
                if seen.identity is not None
            },
            target=self._target,
            present=self._chosen,
        )
