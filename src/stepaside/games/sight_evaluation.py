"""Evaluation of a robot's perception against the true state."""

from dataclasses import dataclass
from math import atan2, radians

import numpy as np

from ..core.poses import Array, wrap_angle, wrap_angles
from ..perception.images import (
    AnyPercept,
    ColourImage,
    DepthImage,
    LidarScan,
    Percept,
)
from ..perception.measurement import Sighting
from ..perception.pipeline import FrameReport, Perception
from ..robots.head import HeadDescription, Mount
from ..sim.ground_truth import GroundTruth, torsos_apart
from ..sim.simulated_robot import SimulatedRobot
from .summary import ErrorSpread, SightSummary

MATCH_ANGLE = radians(10.0)  # within which a detection matches the truth
MISLED_ANGLE = radians(20.0)  # bearing error from which a robot is misled
NEAR_MARGIN = 0.15  # beyond the near limit at which a body is in range, [m]


@dataclass(slots=True)
class FrameCounts:
    """Counts of the frames of one kind of camera."""

    in_view: int = 0  # frames with the opponent in the field of view
    detected: int = 0  # among them, with a detection of it
    false: int = 0  # detections that match no object

    @property
    def rate(self) -> float | None:
        """Detection rate; None if the opponent was never in view."""
        return self.detected / self.in_view if self.in_view else None


class SightEvaluator:
    """Comparison of a robot's detections and sightings with the truth."""

    def __init__(
        self,
        robot: SimulatedRobot,
        other: GroundTruth,
        perception: Perception,
        head: HeadDescription,
        things: list[tuple[float, float]],
        *,
        wears_trim: bool = True,
    ) -> None:
        """Evaluate one robot, with positions (x, y) of other things, in [m].

        Colour frames cannot detect an opponent without the trim of a robot.
        """
        self._wears_trim = wears_trim
        self._robot, self._other = robot, other
        self._perception, self._head = perception, head
        self._things = things
        self._true: dict[Percept, tuple[float, bool, list[float]]] = {}
        self.colour, self.depth = FrameCounts(), FrameCounts()
        self._sighting: Sighting | None = None
        self._true_sighting = (np.nan, np.nan)
        self._rows: list[tuple[float, ...]] = []

    def evaluate_tick(self) -> None:
        """Evaluate a tick, after perception and before physics."""
        eyes = self._robot.eyes
        for percept in () if eyes is None else eyes.exposed:
            self.record_truth(percept)
        for report in self._perception.reports:
            self.evaluate(report)
        sighting = self._perception.sighting
        if sighting is not self._sighting:
            self._sighting, self._true_sighting = sighting, self._truth()

    def record_truth(self, percept: AnyPercept) -> None:
        """Store the truth at the instant at which an image is taken."""
        if isinstance(percept, LidarScan):
            return
        head, is_colour = self._head, isinstance(percept, ColourImage)
        if isinstance(percept, DepthImage):
            mount = head.depth[percept.number]
        else:
            mount = head.top
        position, axes = self._camera(mount)
        height = float(self._other.position_com_in_world[2])
        target = np.array([*self._other.position_torso_in_world, height])
        point = axes.T @ (target - position)
        in_view = percept.camera.sees(point)
        in_view &= self._wears_trim or not is_colour
        if isinstance(percept, DepthImage):
            distance = float(np.hypot(*point[:2]))
            in_view &= percept.near + NEAR_MARGIN < distance < percept.far
        others = [
            _azimuth(axes.T @ (np.array([x, y, 0.2]) - position))
            for x, y in self._things
        ]
        self._true[percept] = (_azimuth(point), in_view, others)

    def evaluate(self, report: FrameReport) -> None:
        """Compare the detections of an image with the truth."""
        truth = self._true.pop(report.image, None)
        if truth is None:
            return
        azimuth, in_view, others = truth
        kind = "colour" if isinstance(report.image, ColourImage) else "depth"
        counts = self.colour if kind == "colour" else self.depth
        matches = [
            abs(wrap_angle(a - azimuth)) < MATCH_ANGLE for a in report.azimuths
        ]
        if in_view:
            counts.in_view += 1
            counts.detected += any(matches)
        # The depth camera also detects objects, which are not false.
        allowed = others if kind == "depth" else []
        for angle, fits in zip(report.azimuths, matches, strict=True):
            if not fits and not any(
                abs(wrap_angle(angle - thing)) < 2.0 * MATCH_ANGLE
                for thing in allowed
            ):
                counts.false += 1

    def sample(self, now: float) -> None:
        """Record the latest sighting and the truth at its time."""
        sighting, estimated = self._sighting, (np.nan, np.nan)
        true = self._truth() if sighting is None else self._true_sighting
        if sighting is not None:
            estimated = (sighting.bearing, sighting.distance)
        lost = float(sighting is None or self._perception.searching)
        self._rows.append((now, *estimated, *true, lost))

    def _truth(self) -> tuple[float, float]:
        """Return the present bearing, in [rad], and distance, in [m]."""
        own, other = self._robot.truth, self._other
        x, y = own.position_torso_in_world
        u, v = other.position_torso_in_world
        bearing = wrap_angle(atan2(v - y, u - x) - own.heading_in_world)
        return bearing, torsos_apart(own, other)

    def array(self) -> Array:
        """Return ``sight`` of a trajectory; truth at the time of sighting."""
        return np.array(self._rows, dtype=np.float64).reshape(-1, 6)

    def summary(self) -> SightSummary:
        """Return errors and detection rates."""
        rows = self.array()
        bearing_error = np.abs(wrap_angles(rows[:, 1] - rows[:, 3]))
        distance_error = np.abs(rows[:, 2] - rows[:, 4])
        period = float(np.diff(rows[:2, 0])[0]) if len(rows) > 1 else 0.0
        known = np.isfinite(bearing_error)
        misled = bearing_error[known] > MISLED_ANGLE
        return SightSummary(
            bearing_error_deg=_spread(np.degrees(bearing_error[known])),
            distance_error_m=_spread(distance_error[known]),
            detection_rate=self.colour.rate,
            false_detections=self.colour.false + self.depth.false,
            misled_s=float(misled.sum() * period),
            lost_s=float(rows[:, 5].sum() * period),
            depth_detection_rate=self.depth.rate,
        )

    def _camera(self, mount: Mount) -> tuple[Array, Array]:
        name = f"{self._robot.name}/{self._head.body_of(mount)}"
        body = self._robot.world.data.body(name)
        axes = body.xmat.reshape(3, 3)
        place = body.xpos + axes @ mount.position_in_body
        return place, axes @ mount.axes_in_body


def _azimuth(point: Array) -> float:
    return atan2(float(point[1]), float(point[0]))


def _spread(errors: Array) -> ErrorSpread:
    if not errors.size:
        return ErrorSpread(None, None)
    return ErrorSpread(
        float(np.median(errors)), float(np.quantile(errors, 0.95))
    )
