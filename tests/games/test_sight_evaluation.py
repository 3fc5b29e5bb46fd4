"""Test the evaluation of perception on detections of known truth."""

from math import atan2, cos, pi, radians, sin
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.rotations import rotation
from stepaside.games.sight_evaluation import FrameCounts, SightEvaluator
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import ColourImage, DepthImage
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

    def __init__(self, yaw: float = 0.0, *, wears_trim: bool = True) -> None:
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
        other: Any = self.other
        head: Any = HEAD
        self.evaluator = SightEvaluator(
            *(own, other, self.mind, head, []),
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
