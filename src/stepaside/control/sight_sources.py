"""Sources of sightings of the opponent: measurements or camera."""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from ..core.player_identity import PlayerIdentity
from ..core.poses import ALL_AROUND, Array, Sector
from ..locomotion.locomotion import CurrentStep
from ..perception.attitude import AttitudeFilter
from ..perception.measurement import RobotState, Sighting
from ..planning import Foot
from ..strategies.decision_maker import choose_opponent

if TYPE_CHECKING:
    from ..perception.lidar_perception import LidarPerception
    from ..perception.pipeline import Perception
    from ..robots.forward_kinematics import ForwardKinematics

StepAt = Callable[[float], CurrentStep]
CORRECTION = 0.5  # of the attitude filter by the accelerometer, in [1/s]


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


class LidarSight(SightSource):
    """Sightings from scans of a lidar, relative to the support foot.

    The pose of a sensor uses the torso tilt that balance estimates; without
    an estimate, an attitude filter of its own.
    """

    perception: "Perception | LidarPerception"

    def __init__(
        self, perception: "Perception | LidarPerception", *, tick: float
    ) -> None:
        """Wrap a perception, at a control period in [s]."""
        self.perception = perception
        self._attitude = AttitudeFilter(CORRECTION, 0.0, calibration=0.0)
        self._tick = tick

    def see(
        self,
        measurement: RobotState,
        step: StepAt,
        tilt: tuple[float, float] | None,
    ) -> Sighting | None:
        """Return the sighting by the images or scans so far."""
        if tilt is None:
            own = self._attitude
            gyro, force = measurement.gyro, measurement.accelerometer
            own.update(gyro, force, (0.0, 0.0), self._tick)
            tilt = own.roll, own.pitch
        made = step(measurement.time)
        left_supports = made.swing is Foot.RIGHT
        return self.perception.see(
            measurement, made.support, left_supports, tilt
        )


class CameraSight(LidarSight):
    """Sightings from images, with a head that looks at the opponent."""

    perception: "Perception"

    @property
    def turning(self) -> float:
        """Turn on the spot for a scan: 1 left, -1 right, or 0."""
        return self.perception.head.turning

    @property
    def views(self) -> tuple[Sector, ...]:
        """Range of the head, and views of the cameras on the torso."""
        return self.perception.views

    @property
    def forward(self) -> "ForwardKinematics | None":
        """Kinematics of the body that the camera looks from."""
        body = self.perception.kinematics
        return None if body is None else body.forward

    def aim(self, targets: Array) -> None:
        """Turn the head to the last known position of the opponent."""
        self.perception.aim(targets)
