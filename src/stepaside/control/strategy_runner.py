"""Execution of the strategy of one robot, with its memory."""

from dataclasses import replace
from math import atan2, cos, hypot, pi, sin
from typing import TYPE_CHECKING

from ..core.history import History
from ..core.poses import ALL_AROUND, Pose, Sector
from ..locomotion.locomotion import Surroundings
from ..perception.measurement import Sighting
from ..planning import Foot, GaitSettings
from ..planning.path import pose_beside_foot
from ..strategies.decision_maker import (
    DecisionMaker,
    evaluate_strategy,
    turned,
)
from ..strategies.knowledge import (
    ON_THE_SPOT,
    Intent,
    Knowledge,
    OtherPlayer,
    limits_of,
)
from ..strategies.opponent_track import OpponentTrack
from ..strategies.strategy import Strategy
from ..strategies.velocity_set import VelocitySet
from .sight_sources import PlayersInSight

if TYPE_CHECKING:
    from .body_odometry import BodyOdometry

MEMORY = 2.0  # how long past states are stored, in [s]
RECENT = 1.0  # age up to which the own pose at a sighting is known, in [s]


class StrategyRunner(DecisionMaker):
    """Strategy of a robot with its memory and its history of states."""

    def __init__(
        self,
        strategy: Strategy,
        gait: GaitSettings,
        surroundings: Surroundings | None = None,
        velocities: VelocitySet | None = None,
        views: tuple[Sector, ...] = ALL_AROUND,
    ) -> None:
        super().__init__(strategy, limits_of(gait, velocities, views))
        self._surroundings = surroundings or Surroundings()
        self.headings: History[float] = History(MEMORY)  # [rad]
        self.templates: History[Pose] = History(MEMORY)
        self.body: BodyOdometry | None = None  # of who tracks its body
        self._spacing = gait.foot_spacing
        self._target_id = 0
        self._in_sight: tuple[Sighting, ...] = ()
        self._tracks: dict[str, OpponentTrack] = {}
        self._sightings: dict[str, tuple[float, Pose, float, float]] = {}

    def note_players(self, in_sight: PlayersInSight | None) -> None:
        """Store the sightings of all players for the next decision."""
        if in_sight is not None:
            self.identity, self._in_sight = in_sight

    def starts(
        self, now: float, sighting: Sighting | None, turning: float = 0.0
    ) -> bool:
        """Return whether a standing robot starts to walk.

        The strategy then decides again at the time of the step, and the
        memory of this decision is discarded.
        """
        if sighting is None:
            return turning != 0.0
        known = self.knowledge(now, sighting, moving=False)
        intent, memory = evaluate_strategy(self.strategy, known, self.memory)
        if not intent.walks:
            self.memory = memory
        # A new track does not yet determine the opponent's path.
        return intent.walks and sighting.settled

    def decide(
        self,
        now: float,
        sighting: Sighting | None,
        turning: float = 0.0,
        stands: tuple[Pose, Foot] | None = None,
        *,
        moving: bool,
    ) -> Intent:
        """Evaluate the strategy and store its memory.

        Without a sighting the robot turns on the spot for a scan: 1 left, -1
        right.
        """
        if sighting is None:
            return Intent(turning * pi, ON_THE_SPOT)
        return self.evaluate(
            self.knowledge(now, sighting, stands, moving=moving)
        )

    def knowledge(
        self,
        now: float,
        sighting: Sighting,
        stands: tuple[Pose, Foot] | None = None,
        *,
        moving: bool,
    ) -> Knowledge:
        """Build the knowledge, in the template frame at the sighting's time.

        ``stands`` is the foot that has just landed, in odometry; None if the
        next step begins at the present pose.

        Line of sight and heading refer to the same instant. The landed foot
        would not do: it corresponds to a body half a step ahead, and the
        torso has the mean heading of both feet.
        """
        if sighting.target_id != self._target_id:
            # A different person: its motion is unknown.
            self._target_id = sighting.target_id
            self.reset_rates()
        template, sight, distance = self._sight_of(sighting)
        if now - sighting.time > RECENT and sighting.identity is not None:
            x, y = self._position_of(sighting)
            template = (self.body or self.templates).at(now)
            sight = atan2(y - template.y, x - template.x)
            distance = hypot(y - template.y, x - template.x)
        several = self._in_sight if len(self._in_sight) > 1 else ()
        known = self.observe(
            now,
            template,
            sighting._replace(
                bearing=sight - template.theta, distance=distance
            ),
            pose_odometry_in_map=self._surroundings.pose_odometry_in_map,
            moving=moving,
            obstacles=self._surroundings.solids,
            map_error=self._surroundings.map_error,
            others=tuple(self._other(now, template, each) for each in several),
        )
        if not moving or stands is None:
            return known
        begins = pose_beside_foot(*stands, self._spacing)
        if self.body is not None:
            begins = self.body.place(begins)
        begins = self._surroundings.pose_odometry_in_map.compose(begins)
        return replace(known, step_start_in_map=begins)

    def _other(
        self, now: float, template: Pose, sighting: Sighting
    ) -> OtherPlayer:
        """Return a player in the frame of the knowledge, in odometry."""
        assert sighting.identity is not None
        x, y = self._position_of(sighting)
        name, step = sighting.identity.name, self.limits.step_duration
        track = self._tracks.get(name) or OpponentTrack(step)
        self._tracks[name] = track = track.note(sighting.time, (x, y))
        u, v, _ = template.inverse().compose(Pose(x, y, 0.0))
        return OtherPlayer(
            sighting.identity,
            atan2(v, u),
            hypot(u, v),
            turned(track.velocity, -template.theta),
            max(0.0, now - sighting.time),
            sighting.spread,
        )

    def _sight_of(self, sighting: Sighting) -> tuple[Pose, float, float]:
        """Return own pose, and direction and distance of a sighting from it.

        In odometry. They are kept for a recognised player: the history of own
        poses is short, and a hidden player may not be sighted for long.
        """
        template = (self.body or self.templates).at(sighting.time)
        if self.body is None:
            sight = self.headings.at(sighting.time) + sighting.bearing
            distance = sighting.distance
        else:
            x, y = self.body.position_of(sighting)
            sight = atan2(y - template.y, x - template.x)
            distance = hypot(y - template.y, x - template.x)
        if sighting.identity is not None:
            name = sighting.identity.name
            known = self._sightings.get(name)
            if known is None or known[0] != sighting.time:
                known = sighting.time, template, sight, distance
                self._sightings[name] = known
        return template, sight, distance

    def _position_of(self, sighting: Sighting) -> tuple[float, float]:
        """Return the position of a recognised player in odometry, in [m]."""
        assert sighting.identity is not None
        self._sight_of(sighting)
        _, template, sight, distance = self._sightings[sighting.identity.name]
        return (
            template.x + distance * cos(sight),
            template.y + distance * sin(sight),
        )
