"""Odometry of a body that walks by planned steps, its sway included."""

from math import cos, sin
from typing import TYPE_CHECKING

from ..core.history import History
from ..core.poses import Pose
from ..locomotion.locomotion import Surroundings
from ..locomotion.maneuver_walk import ManeuverWalk
from ..perception.attitude import AttitudeFilter
from ..perception.measurement import RobotState, Sighting

if TYPE_CHECKING:
    from ..locomotion.policy.policy_legs import PolicyWalk

MEMORY = 2.0  # how long past poses are stored, in [s]
CORRECTION = 0.5  # of the vertical by the accelerometer, in [1/s]


class BodyTracker:
    """Learned legs, which know their pose a tick late: so be sightings."""

    odometry: "BodyOdometry | None" = None
    _before: Sighting | None = None
    _time = 0.0

    def note(
        self, measured: RobotState, seen: Sighting | None
    ) -> Sighting | None:
        """Return what was seen a tick ago, as the pose that is known is."""
        late, self._before = self._before, seen
        tick, self._time = measured.time - self._time, measured.time
        return late and late._replace(time=late.time + tick)


class Untracked(BodyTracker):
    """Body in a known room, which is told where it is."""

    def note(
        self, measured: RobotState, seen: Sighting | None
    ) -> Sighting | None:
        """Return what is seen."""
        return seen


class BodyOdometry(BodyTracker):
    """Pose of a body by its planned CoM and its gyro.

    The plan knows how the reference point sways about the template, and the
    gyro how the body turns, with feet that slip. What both leave out of the
    position is measured (:mod:`..fitting.departure_measurement`).

    Attributes:
        pose: Reference point and heading of the body at the last tick.
    """

    def __init__(self, walk: ManeuverWalk) -> None:
        """Begin at the pose of a standing walk."""
        self._walk, self._time, self.odometry = walk, 0.0, self
        self._attitude = AttitudeFilter(CORRECTION, 0.0, calibration=0.0)
        self._plans: History[tuple[Pose, Pose]] = History(MEMORY)
        self._bodies: History[Pose] = History(MEMORY)
        self._note_plan(0.0)
        self._planned, _ = self._plans.at(0.0)
        self.pose, self._error = self._planned, 0.0
        self._bodies.note(0.0, self.pose)

    def _note_plan(self, time: float) -> None:
        """Store where the reference point and the template are planned."""
        walk = self._walk
        x, y, *_ = walk.planned_centers
        heading, ahead = walk.balance.planned_heading, walk.gait.zmp_forward
        planned = Pose(
            x - ahead * cos(heading), y - ahead * sin(heading), heading
        )
        self._plans.note(time, (planned, walk.pose))

    def note(
        self, measured: RobotState, seen: Sighting | None
    ) -> Sighting | None:
        """Move on by the plan of the last tick, and by the gyro.

        Returns what is seen, as it is.
        """
        now, attitude = measured.time, self._attitude
        tick, self._time = now - self._time, now
        if tick <= 0.0:
            return seen
        self._note_plan(now - tick + self._walk.pose_delay)
        attitude.update(
            measured.gyro, measured.accelerometer, (0.0, 0.0), tick
        )
        before, (self._planned, _) = self._planned, self._plans.at(now)
        heading = self.pose.theta + attitude.turning.item(0) * tick
        error, self._error = self._error, heading - self._planned.theta
        x, y = self._planned.x - before.x, self._planned.y - before.y
        turned = 0.5 * (error + self._error)
        c, s = cos(turned), sin(turned)
        self.pose = Pose(
            self.pose.x + c * x - s * y, self.pose.y + s * x + c * y, heading
        )
        self._bodies.note(now, self.pose)
        return seen

    def place(self, planned: Pose) -> Pose:
        """Return where a pose of the plan is in this odometry, now."""
        return self.pose.compose(self._planned.inverse().compose(planned))

    def at(self, time: float) -> Pose:
        """Return the pose of the template at a time, in [s]."""
        body, (planned, template) = self._bodies.at(time), self._plans.at(time)
        return body.compose(planned.inverse().compose(template))

    def position_of(self, sighting: Sighting) -> tuple[float, float]:
        """Return where somebody was sighted, in [m]."""
        body = self._bodies.at(sighting.time)
        sight = body.theta + sighting.bearing
        return (
            body.x + sighting.distance * cos(sight),
            body.y + sighting.distance * sin(sight),
        )


def track_body(
    walk: "ManeuverWalk | PolicyWalk", surroundings: Surroundings | None
) -> BodyTracker:
    """Return what tells where a body is; not its sway in a known room."""
    if walk.maneuvers is None:
        return BodyTracker()
    if surroundings is None:
        return BodyOdometry(walk.maneuvers)
    return Untracked()
