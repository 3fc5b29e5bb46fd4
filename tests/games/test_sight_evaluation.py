"""Test the evaluation of perception on detections of known truth."""

from dataclasses import astuple
from math import atan2, cos, hypot, nan, pi, radians, sin
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.rotations import rotation
from stepaside.games.sight_evaluation import FrameCounts, SightEvaluator
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import ColourImage, DepthImage, SonarEcho
from stepaside.perception.measurement import Sighting
from stepaside.perception.pipeline import FrameReport
from stepaside.robots.head import Mount

CAMERA = CameraModel.of_field_of_view(80, 60, radians(60.0), radians(45.0))
PERIOD = 0.1
TOP = Mount(np.array([0.05, 0.01, 0.06]), rotation(0.0, radians(3.0), 0.0))
DEPTH = Mount(np.array([0.03, -0.02, 0.14]), rotation(0.0, radians(9.0), 0.0))
HEAD = SimpleNamespace(top=TOP, depth=(DEPTH,), body_of=lambda mount: "head")


class Truth:
    """True state set by a test."""

    def __init__(self, x: float, y: float, heading: float, z: float) -> None:
        self.position_torso_in_world = x, y
        self.heading_in_world = heading
        self.position_com_in_world = np.array([x, y, z])


def thoughtless() -> Any:
    """Return a fake perception with settable sightings."""
    return SimpleNamespace(sighting=None, searching=False, reports=[])


class Scene:
    """Evaluator of a robot whose head a test moves."""

    def __init__(
        self,
        yaw: float = 0.0,
        things: list[tuple[float, float]] | None = None,
        still_times: tuple[float, ...] = (),
        *,
        wears_trim: bool = True,
    ) -> None:
        quaternion = f"{cos(0.5 * yaw)} 0 0 {sin(0.5 * yaw)}"
        model = mujoco.MjModel.from_xml_string(
            "<mujoco><worldbody>"
            f'<body name="me/head" pos="0.3 -0.2 0.4" quat="{quaternion}">'
            '<geom size="0.01"/></body></worldbody></mujoco>'
        )
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self.frame = data.body("me/head").xmat.reshape(3, 3)
        self.place = data.body("me/head").xpos
        self.own = Truth(0.3, -0.2, 0.0, 0.3)
        self.other = Truth(1.5, 0.0, 0.0, 0.3)
        self.mind = thoughtless()
        world = SimpleNamespace(model=model, data=data)
        self.eyes = SimpleNamespace(exposed=[])
        own: Any = SimpleNamespace(
            world=world, name="me", truth=self.own, eyes=self.eyes
        )
        self.robot = own
        other: Any = self.other
        head: Any = HEAD
        self.evaluator = SightEvaluator(
            *(own, other, self.mind, head, things or [], still_times),
            wears_trim=wears_trim,
        )

    def stand(self, mount: Mount, azimuth: float, away: float) -> None:
        """Put the opponent at a position in a camera frame, at its height."""
        axes = self.frame @ mount.axes_in_body
        eye = self.place + self.frame @ mount.position_in_body
        point = eye + axes @ (away * np.array([cos(azimuth), sin(azimuth), 0]))
        self.other.position_torso_in_world = float(point[0]), float(point[1])
        self.other.position_com_in_world = point

    def sample(self, now: float) -> None:
        """Evaluate a tick, and record a sample."""
        self.evaluator.evaluate_tick()
        self.evaluator.sample(now)

    def believe(self, bearing: float, away: float = 1.0) -> None:
        """Set the sighting of the robot."""
        self.mind.sighting = Sighting(0.0, bearing, away)


def colour(time: float = 0.0) -> ColourImage:
    return ColourImage(time, CAMERA, np.zeros((60, 80, 3), dtype=np.uint8))


def depth(time: float = 0.0) -> DepthImage:
    pixels = np.zeros((60, 80), dtype=np.float32)
    return DepthImage(time, CAMERA, pixels, 0.8, 3.5)


def show(
    scene: Scene, image: ColourImage | DepthImage, *azimuths: float
) -> None:
    """Take an image with detections at angles, in [deg]."""
    scene.evaluator.record_truth(image)
    angles = tuple(radians(a) for a in azimuths)
    scene.evaluator.evaluate(FrameReport(image, angles))


def rows(scene: Scene, errors: list[float | None]) -> None:
    """Sample sightings with bearing errors, in [deg]; None if lost."""
    true = atan2(0.2, 1.2)
    for i, error in enumerate(errors):
        scene.mind.sighting = None
        if error is not None:
            scene.believe(true + radians(error))
        scene.sample(i * PERIOD)


def test_time_with_a_large_bearing_error_is_misled_time() -> None:
    scene = Scene()
    rows(scene, [0.0, 21.0, -21.0, 30.0, 19.0, -19.0, None, 180.0])
    summary = scene.evaluator.summary()
    assert summary.misled_s == pytest.approx(4 * PERIOD)
    assert summary.lost_s == pytest.approx(1 * PERIOD)


def test_bearing_errors_are_wrapped() -> None:
    scene = Scene()
    scene.own.heading_in_world = radians(-175.0) + atan2(0.2, 1.2)
    for i, belief in enumerate((172.0, 178.0, -178.0)):
        scene.believe(radians(belief))
        scene.sample(i * PERIOD)
    true = scene.evaluator.array()[:, 3]
    np.testing.assert_allclose(true, radians(175.0))
    summary = scene.evaluator.summary()
    assert summary.bearing_error_deg.median == pytest.approx(3.0)
    assert summary.misled_s == 0.0


def test_a_searching_robot_is_lost_even_with_a_sighting() -> None:
    scene = Scene()
    scene.believe(0.0)
    for i in range(5):
        scene.mind.searching = i < 2
        scene.sample(i * PERIOD)
    assert scene.evaluator.summary().lost_s == pytest.approx(2 * PERIOD)


def test_samples_hold_sightings_and_the_truth() -> None:
    scene = Scene()
    scene.own.heading_in_world = 0.5
    scene.sample(1.0)
    scene.believe(-0.1, 1.4)
    scene.sample(1.1)
    bearing, distance = atan2(0.2, 1.2) - 0.5, hypot(0.2, 1.2)
    np.testing.assert_allclose(
        scene.evaluator.array(),
        [
            [1.0, nan, nan, bearing, distance, 1.0],
            [1.1, -0.1, 1.4, bearing, distance, 0.0],
        ],
    )


def test_a_sighting_is_compared_with_the_truth_at_its_time() -> None:
    """Perception runs when an image arrives; others move meanwhile."""
    scene = Scene()
    true = atan2(0.2, 1.2)
    scene.believe(true)
    scene.sample(0.0)
    scene.other.position_torso_in_world = 0.3, 0.8
    scene.sample(0.1)
    np.testing.assert_allclose(scene.evaluator.array()[:, 3], true)
    scene.believe(0.5)
    scene.sample(0.2)
    assert scene.evaluator.array()[2, 3] == pytest.approx(0.5 * pi)


def test_errors_exclude_samples_without_a_sighting() -> None:
    scene = Scene()
    true = hypot(0.2, 1.2)
    rows(scene, [None, None])
    for i in range(101):
        scene.believe(atan2(0.2, 1.2) + radians(0.1 * i), true - 0.01 * i)
        scene.sample((i + 2) * PERIOD)
    summary = scene.evaluator.summary()
    assert astuple(summary.bearing_error_deg) == pytest.approx((5.0, 9.5))
    assert astuple(summary.distance_error_m) == pytest.approx((0.5, 0.95))


def test_rates_are_fractions_of_the_frames_with_the_opponent_in_view() -> None:
    assert FrameCounts().rate is None
    assert FrameCounts(in_view=8, detected=2).rate == 0.25


@pytest.mark.parametrize("yaw", [0.0, 2.0, -1.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_frames_count_as_shown_found_and_false(
    yaw: float, side: float
) -> None:
    """A detection within ten degrees is of the opponent."""
    scene = Scene(yaw)
    scene.stand(TOP, side * radians(20.0), 1.2)
    show(scene, colour(), side * 20.0)
    show(scene, colour(), side * 11.0)
    show(scene, colour(), side * 29.0)
    show(scene, colour())
    show(scene, colour(), side * 9.0)
    show(scene, colour(), side * 31.0, side * 21.0, side * -20.0)
    scene.stand(TOP, side * radians(50.0), 1.2)
    show(scene, colour())
    show(scene, colour(), 0.0)
    assert scene.evaluator.colour == FrameCounts(
        in_view=6, detected=4, false=4
    )
    assert scene.evaluator.depth == FrameCounts()
    summary = scene.evaluator.summary()
    assert summary.detection_rate == pytest.approx(4 / 6)
    assert summary.false_detections == 4
    assert summary.depth_detection_rate is None


def test_both_cameras_count_separately_and_false_ones_together() -> None:
    scene = Scene()
    scene.stand(DEPTH, 0.0, 1.2)
    show(scene, colour(), 0.0, 25.0)
    show(scene, depth(), 0.0, -25.0, 25.0)
    show(scene, depth())
    assert scene.evaluator.colour == FrameCounts(1, 1, 1)
    assert scene.evaluator.depth == FrameCounts(2, 1, 2)
    summary = scene.evaluator.summary()
    assert summary.false_detections == 3
    assert summary.detection_rate == 1.0
    assert summary.depth_detection_rate == 0.5


@pytest.mark.parametrize(
    ("away", "shown"), [(0.94, 0), (0.96, 1), (3.48, 1), (3.52, 0)]
)
def test_depth_shows_only_what_is_well_in_range(
    away: float, shown: int
) -> None:
    """From 0.15 m beyond the near limit; a colour image has no range."""
    scene = Scene(0.7)
    scene.stand(DEPTH, 0.2, away)
    show(scene, depth())
    assert scene.evaluator.depth.in_view == shown
    scene.stand(TOP, 0.2, away)
    show(scene, colour())
    assert scene.evaluator.colour.in_view == 1


def test_the_center_of_the_opponent_must_be_in_view() -> None:
    scene = Scene()
    scene.stand(TOP, 0.0, 1.0)
    for lift, shown in ((0.38, 1), (0.46, 0), (-0.37, 1), (-0.46, 0)):
        level = scene.other.position_com_in_world.copy()
        scene.other.position_com_in_world[2] += lift
        before = scene.evaluator.colour.in_view
        show(scene, colour())
        assert scene.evaluator.colour.in_view - before == shown
        scene.other.position_com_in_world = level


def test_objects_are_no_false_detections_of_the_depth_camera() -> None:
    """For a colour camera they are."""
    eye = np.array([0.3, -0.2]) + DEPTH.position_in_body[:2]
    scene = Scene(0.0, [(9.0, 9.0), (eye[0] + 2.0, eye[1] - 1.0)])
    scene.stand(DEPTH, 0.3, 1.5)
    # How far the thing is aside, seen from the tilted camera.
    down = scene.place[2] + DEPTH.position_in_body[2] - 0.2
    ahead = 2.0 * cos(radians(9.0)) + down * sin(radians(9.0))
    there = np.degrees(atan2(-1.0, ahead))
    show(scene, depth(), there, there - 19.5, there + 19.5)
    assert scene.evaluator.depth.false == 0
    show(scene, depth(), there - 20.5)
    assert scene.evaluator.depth.false == 1
    show(scene, colour(), there)
    assert scene.evaluator.colour.false == 1


def test_each_noted_image_is_evaluated_once() -> None:
    scene = Scene()
    image = colour()
    scene.evaluator.evaluate(FrameReport(image, (1.0,)))
    assert scene.evaluator.colour == FrameCounts()
    scene.stand(TOP, 0.0, 1.0)
    show(scene, image, 0.0)
    scene.evaluator.evaluate(FrameReport(image, (0.0,)))
    assert scene.evaluator.colour == FrameCounts(1, 1, 0)
    scene.evaluator.record_truth(SonarEcho(0.0, "left", 0.5))


def test_each_tick_notes_exposed_images_and_evaluates_reports() -> None:
    """Also if both happen in one tick."""
    scene = Scene()
    scene.stand(TOP, 0.0, 1.0)
    one, late = colour(), colour(0.1)
    scene.eyes.exposed = [one, late, SonarEcho(0.0, "left", 0.5)]
    scene.mind.reports = [FrameReport(one, (0.0,))]
    scene.evaluator.evaluate_tick()
    assert scene.evaluator.colour == FrameCounts(1, 1, 0)
    scene.stand(TOP, radians(50.0), 1.0)  # the truth counts of then
    scene.eyes.exposed = []
    scene.mind.reports = [FrameReport(late, (0.0,))]
    scene.evaluator.evaluate_tick()
    assert scene.evaluator.colour == FrameCounts(2, 2, 0)
    scene.eyes.exposed, scene.mind.reports = [], []
    scene.evaluator.evaluate_tick()
    assert scene.evaluator.colour == FrameCounts(2, 2, 0)


def test_a_person_counts_only_in_depth_images() -> None:
    scene = Scene(wears_trim=False)
    scene.stand(TOP, 0.0, 1.5)
    show(scene, colour())
    show(scene, colour(0.1), 40.0)
    assert scene.evaluator.colour == FrameCounts(
        in_view=0, detected=0, false=1
    )
    assert scene.evaluator.colour.rate is None
    scene.stand(DEPTH, 0.0, 1.5)
    show(scene, depth(), 0.0)
    assert scene.evaluator.depth == FrameCounts(in_view=1, detected=1, false=0)
