"""How well a robot sees, judged by the truth that it does not have."""

from dataclasses import dataclass
from math import atan2, radians

import numpy as np

from ..core.poses import Array, wrap_angle, wrap_angles
from ..perception.frame_report import FrameReport
from ..perception.images import ColourImage, DepthImage, Percept, SonarEcho
from ..perception.perception import Perception
from ..robots.head import HeadDescription, Mount
from ..sim.ground_truth import GroundTruth, torsos_apart
from ..sim.simulated_robot import SimulatedRobot
from .sight_summary import ErrorSpread, SightSummary

AGREES = radians(10.0)  # within which a detection is of what it should be
ASTRAY = radians(20.0)  # error of a belief that misleads
MARGIN = 0.15  # beyond the near limit at which a body is in range, in [m]


@dataclass(slots=True)
class FrameCounts:
    """Frames of one camera.

    Attributes:
        shown: Frames with the other in the field of view.
        found: Of them, those that found it.
        false: Detections of what is not there.
    """

    shown: int = 0
    found: int = 0
    false: int = 0

    @property
    def rate(self) -> float | None:
        """Share of the frames with the other in view that found it."""
        return self.found / self.shown if self.shown else None


@dataclass(slots=True)
class EvaluatedImage:
    """One image with what was found in it.

    Attributes:
        report: The image and what was found.
        azimuth: True direction of the other from the camera's axis, in
            [rad].
    """

    report: FrameReport
    azimuth: float


class SightEvaluator:
    """Compares what a robot believes with what is.

    Attributes:
        colour: Frames of the colour camera.
        depth: Frames of the depth camera.
        stills: Images kept to be looked at, by camera.
    """

    def __init__(
        self,
        robot: SimulatedRobot,
        other: GroundTruth,
        perception: Perception,
        head: HeadDescription,
        things: list[tuple[float, float]],
        still_times: tuple[float, ...] = (),
        *,
        wears_trim: bool = True,
    ) -> None:
        """Watch one robot.

        Args:
            robot: The robot.
            other: Where what it should see really is.
            perception: What it believes.
            head: Its head.
            things: Places of what else stands in the world, in [m].
            still_times: When images are to be kept, in [s].
            wears_trim: Whether the other has the colour that is looked for;
                a person has none, so no colour frame can find one.
        """
        self._wears_trim = wears_trim
        self._robot, self._other = robot, other
        self._perception, self._head = perception, head
        self._things = things
        model = robot.world.model
        self._body = model.body(f"{robot.name}/{head.body}").id
        self._true: dict[Percept, tuple[float, bool, list[float]]] = {}
        self.colour, self.depth = FrameCounts(), FrameCounts()
        self.stills: dict[str, list[EvaluatedImage]] = {
            "colour": [],
            "depth": [],
        }
        self._rows: list[tuple[float, ...]] = []
        self._still_times = still_times

    def look(self) -> None:
        """Judge a tick, after the robot has perceived and before it moves."""
        eyes = self._robot.eyes
        for percept in () if eyes is None else eyes.exposed:
            self.note(percept)
        for report in self._perception.reports:
            self.judge(report)

    def note(self, percept: Percept) -> None:
        """Note the truth when a percept is taken."""
        if isinstance(percept, SonarEcho):
            return
        is_colour = isinstance(percept, ColourImage)
        mount = self._head.top if is_colour else self._head.depth
        if isinstance(percept, ColourImage) and percept.low:
            mount = self._head.bottom or mount
        place, axes = self._camera(mount)
        target = np.array([*self._other.position, self._height()])
        point = axes.T @ (target - place)
        shown = percept.camera.sees(point)
        shown &= self._wears_trim or not is_colour
        if isinstance(percept, DepthImage):
            away = float(np.hypot(*point[:2]))
            shown &= percept.near + MARGIN < away < percept.far
        others = [
            self._azimuth(axes.T @ (np.array([x, y, 0.2]) - place))
            for x, y in self._things
        ]
        self._true[percept] = (self._azimuth(point), shown, others)

    def judge(self, report: FrameReport) -> None:
        """Compare what an image was found to show with the truth."""
        truth = self._true.pop(report.image, None)
        if truth is None or not report.sought:
            return
        azimuth, shown, others = truth
        kind = "colour" if isinstance(report.image, ColourImage) else "depth"
        tally = self.colour if kind == "colour" else self.depth
        right = [
            abs(wrap_angle(a - azimuth)) < AGREES for a in report.azimuths
        ]
        if shown:
            tally.shown += 1
            tally.found += any(right)
        allowed = others if kind == "depth" else []
        for angle, fits in zip(report.azimuths, right, strict=True):
            if not fits and not any(
                abs(wrap_angle(angle - thing)) < 2.0 * AGREES
                for thing in allowed
            ):
                tally.false += 1
        kept = self.stills[kind]
        if len(kept) < len(self._still_times):
            if report.image.time >= self._still_times[len(kept)]:
                kept.append(EvaluatedImage(report, azimuth))

    def sample(self, now: float) -> None:
        """Compare the belief of this instant with the truth."""
        own, other = self._robot.truth, self._other
        x, y = own.position
        u, v = other.position
        bearing = wrap_angle(atan2(v - y, u - x) - own.heading)
        distance = torsos_apart(own, other)
        seen = self._perception.sighting
        believed = (np.nan, np.nan)
        if seen is not None:
            believed = (seen.bearing, seen.distance)
        lost = float(seen is None or self._perception.searching)
        self._rows.append((now, *believed, bearing, distance, lost))

    def array(self) -> Array:
        """Time, believed bearing and distance, true ones, whether lost.

        Shape (n, 6), in [s], [rad], [m], [rad], [m], [1].
        """
        return np.array(self._rows, dtype=np.float64).reshape(-1, 6)

    def figures(self) -> SightSummary:
        """Errors and rates."""
        rows = self.array()
        off = np.abs(wrap_angles(rows[:, 1] - rows[:, 3]))
        away = np.abs(rows[:, 2] - rows[:, 4])
        period = float(np.diff(rows[:2, 0])[0]) if len(rows) > 1 else 0.0
        known = np.isfinite(off)
        return SightSummary(
            bearing_error_deg=_spread(np.degrees(off[known])),
            distance_error_m=_spread(away[known]),
            detection_rate=self.colour.rate,
            false_detections=self.colour.false + self.depth.false,
            misled_s=float((off[known] > ASTRAY).sum() * period),
            lost_s=float(rows[:, 5].sum() * period),
            depth_detection_rate=self.depth.rate,
        )

    def _camera(self, mount: Mount) -> tuple[Array, Array]:
        data = self._robot.world.data
        axes = data.xmat[self._body].reshape(3, 3)
        place = data.xpos[self._body] + axes @ mount.place
        return place, axes @ mount.axes

    def _height(self) -> float:
        return float(self._other.com[2])

    @staticmethod
    def _azimuth(point: Array) -> float:
        return atan2(float(point[1]), float(point[0]))


def _spread(errors: Array) -> ErrorSpread:
    if not errors.size:
        return ErrorSpread(None, None)
    return ErrorSpread(
        float(np.median(errors)), float(np.quantile(errors, 0.95))
    )
