"""Test the floor before the feet, by the lower camera of the head."""

from dataclasses import replace
from math import atan2, cos, pi, radians, sin

import numpy as np
import pytest
from numpy.typing import NDArray

from stepaside.core.poses import Array
from stepaside.perception.bottom_camera import NearFloorMapping
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.camera_pose import CameraPose, camera_pose
from stepaside.perception.floor_map import CELL, FloorMap
from stepaside.perception.images import ColourImage
from stepaside.perception.near_floor import NearFloorMapper
from stepaside.perception.percept_stages import BottomCameraStage
from stepaside.perception.perception_builder import FloorMapping
from stepaside.perception.room_scan import RoomScan
from stepaside.perception.target_selection import RobotSelection
from stepaside.perception.tracker import Tracker
from stepaside.robots.body_pose import BodyPose
from stepaside.robots.head import rotation
from synthetic_cameras import HEAD, Eyes
from synthetic_depth import Post, draw, paint

CAMERA = CameraModel.of_field_of_view(160, 120, radians(60.9), radians(47.6))
DEPTH = CameraModel.of_field_of_view(80, 60, radians(58.0), radians(45.0))
EYE, HIGH = np.array([0.05, 0.0, 0.46]), np.array([0.03, 0.0, 0.54])
HERE = 0.0, 0.0
POST: Post = (0.6, 0.0, 0.15, 0.8)
GRID = np.mgrid[0.0:0.9:0.02, -0.5:0.5:0.02].reshape(2, -1).T
BEFORE, INSIDE, BESIDE = (0.38, 0.0), (0.6, 0.0), (0.45, 0.2)


def axes_of(pitch: float, yaw: float = 0.0) -> Array:
    return rotation(0.0, radians(pitch), yaw)


def eye(axes: Array) -> CameraPose:
    return CameraPose(EYE, axes, HERE)


def around(posts: list[Post]) -> FloorMap:
    """A map of what the depth camera saw all around, twice."""
    made = FloorMap()
    for yaw in np.arange(-pi, pi, 0.5).tolist() * 2:
        axes = axes_of(8.0, yaw)
        image = draw(DEPTH, HIGH, axes, posts)
        made.take(image, CameraPose(HIGH, axes, HERE), None)
    return made


def image(posts: list[Post], axes: Array, *, low: bool) -> ColourImage:
    return ColourImage(0.0, CAMERA, paint(CAMERA, EYE, axes, posts), low)


def learnt(floor: FloorMap, posts: list[Post]) -> NearFloorMapper:
    """Map with known free floor behind."""
    near = NearFloorMapper(floor)
    for yaw in (2.0, pi, -2.0):
        axes = axes_of(1.2, yaw)
        near.learn(image(posts, axes, low=False), eye(axes), None)
    return near


def lower_of(floor: FloorMap) -> BottomCameraStage:
    """The lower camera of who knows what the floor looks like."""
    tracker = Tracker()
    use = NearFloorMapping(learnt(floor, []), RobotSelection(tracker))
    assert HEAD.bottom is not None
    return BottomCameraStage(HEAD.bottom, [use], tracker)


def unseen(floor: FloorMap, places: Array) -> NDArray[np.bool_]:
    """Whether places count as unseen."""
    parts = [part.clearance(places) for part in floor.unknown(HERE)]
    clear: Array = np.min(parts, axis=0, initial=1.0)
    return clear <= 0.0


def hidden(floor: FloorMap, place: tuple[float, float]) -> bool:
    return bool(unseen(floor, np.array([place]))[0])


def test_the_floor_before_a_thing_that_is_too_near_is_seen() -> None:
    floor = around([POST])
    assert all(hidden(floor, place) for place in (BEFORE, INSIDE))
    near, axes = learnt(floor, [POST]), axes_of(39.7)
    near.show(image([POST], axes, low=True), eye(axes))
    assert not hidden(floor, BEFORE) and not hidden(floor, BESIDE)
    assert hidden(floor, INSIDE) and not floor.occupied()


def test_floor_that_is_lighter_close_by_is_seen() -> None:
    """As by a lamp at the eyes: the steeper one looks, the lighter it is."""
    floor = around([POST])
    near, axes = learnt(floor, [POST]), axes_of(39.7)
    picture = image([POST], axes, low=True)
    steep = -(CAMERA.rays() @ axes.T)[..., 2].clip(-1.0, 0.0)
    lamp = 0.5 + 0.7 * steep[..., None]
    lighter = (picture.pixels * lamp).clip(0, 255).astype(np.uint8)
    unknown = near.colours.is_not_floor(lighter)
    assert unknown[60, 80] or unknown[110, 20]
    near.show(replace(picture, pixels=lighter), eye(axes))
    assert not hidden(floor, BEFORE) and not hidden(floor, BESIDE)
    assert hidden(floor, INSIDE) and not floor.occupied()


@pytest.mark.parametrize("away", [0.45, 0.55, 0.7])
@pytest.mark.parametrize("bearing", [-0.4, 0.0, 0.3])
def test_nothing_of_a_thing_or_right_beside_it_is_shown(
    away: float, bearing: float
) -> None:
    """The camera position is known to a few centimetres."""
    post = away * cos(bearing), away * sin(bearing), 0.1, 0.8
    colours, axes = learnt(around([post]), [post]).colours, axes_of(39.7)
    floor = FloorMap()
    near = NearFloorMapper(floor, colours)
    near.show(image([post], axes, low=True), eye(axes))
    shown = GRID[~unseen(floor, GRID)]
    gaps = np.hypot(*(shown - np.array(post[:2])).T) - post[2]
    assert len(gaps) > 10 and gaps.min() > 0.5 * CELL
    # It is not shown through it, either.
    turned = np.abs(np.arctan2(shown[:, 1], shown[:, 0]) - bearing)
    behind = np.hypot(*shown.T) > away
    assert (away * np.sin(turned[behind]) > post[2]).all()


def test_other_colours_show_no_floor() -> None:
    """A dark thing that fills the view leaves all as it was."""
    post = [(0.45, 0.0, 0.3, 0.8)]
    floor = around(post)
    before = unseen(floor, GRID)
    assert 0 < before.sum() < len(GRID)
    near, axes = learnt(floor, post), axes_of(39.7)
    near.show(image(post, axes, low=True), eye(axes))
    np.testing.assert_array_equal(unseen(floor, GRID), before)


def test_the_floor_is_learnt_where_rays_passed() -> None:
    """Objects in front of it, and unseen floor, are not learnt."""
    post = [(1.2, 0.0, 0.3, 0.8)]
    floor, axes = around(post), axes_of(1.2)
    near = NearFloorMapper(floor)
    near.learn(image(post, axes, low=False), eye(axes), None)
    dark = np.full((4, 4, 3), 64, dtype=np.uint8)
    light = np.full((4, 4, 3), 212, dtype=np.uint8)
    assert near.colours.is_not_floor(dark).all()
    assert not near.colours.is_not_floor(light).any()
    blind = NearFloorMapper(FloorMap())
    blind.learn(image([], axes, low=False), eye(axes), None)
    assert not blind.colours.known


def test_who_stands_on_the_floor_is_not_learnt() -> None:
    """Nor what the image shows behind: the map may not know of it."""
    floor, axes = around([]), axes_of(1.2)
    other = 0.9, 0.1
    post = [(*other, 0.12, 0.58)]
    near = NearFloorMapper(floor)
    near.learn(image(post, axes, low=False), eye(axes), other)
    dark = np.full((4, 4, 3), 64, dtype=np.uint8)
    assert not near.colours.counts[4, 4, 4]
    assert near.colours.is_not_floor(dark).all()
    alone = NearFloorMapper(floor)
    alone.learn(image(post, axes, low=False), eye(axes), None)
    assert alone.colours.counts[4, 4, 4]


def test_the_lower_camera_looks_every_other_time_once_it_knows() -> None:
    floor = around([])
    near = NearFloorMapper(floor)
    assert not any(near.wanted() for _ in range(6))
    near = learnt(floor, [])
    asked = [near.wanted() for _ in range(6)]
    assert asked in ([True, False] * 3, [False, True] * 3)


def test_what_rays_struck_stays_taken() -> None:
    """Colours only add floor that was seen."""
    post = [(1.2, 0.0, 0.1, 0.8)]
    floor = around(post)
    before = len(floor.occupied())
    near, axes = learnt(floor, post), axes_of(39.7)
    for _ in range(20):
        near.show(image([], axes, low=True), eye(axes))
    assert before == len(floor.occupied()) > 0
    assert atan2(0.0, 1.2) == 0.0 and floor.is_occupied(1.1, 0.0)


def standing() -> BodyPose:
    eyes = Eyes()
    eyes.see(0.0)
    assert eyes.perception.body is not None
    return eyes.perception.body


def test_who_has_lost_the_other_looks_with_the_upper_camera() -> None:
    """The lower camera shows no trim."""
    lower, body = lower_of(around([])), standing()
    wanted = [lower.wanted(body, lost=False) for _ in range(4)]
    assert wanted.count(True) == 2
    assert not any(lower.wanted(body, lost=True) for _ in range(4))
    wanted = [lower.wanted(body, lost=False) for _ in range(4)]
    assert wanted.count(True) == 2


def test_a_robot_that_scans_the_room_may_look_with_the_lower_camera() -> None:
    """It seeks no opponent yet; the upper camera does so afterwards."""
    mapping = FloorMapping(scan=RoomScan(behind=False))
    eyes = Eyes(mapping)
    now, low = 0.0, []
    while not eyes.perception.head.is_ready:
        body = eyes.perception.body
        if body is not None:
            position, axes, _ = camera_pose(body, HEAD.depth[0])
            shown = draw(DEPTH, position, axes, [], time=now)
            position, axes, _ = camera_pose(body, HEAD.top)
            pixels = paint(CAMERA, position, axes, [])
            eyes.see(now + 0.1, shown, ColourImage(now, CAMERA, pixels))
        else:
            eyes.see(now)
        now += 0.1
        low.append(eyes.perception.looks_low())
    assert any(low)
    assert not any(eyes.perception.looks_low() for _ in range(4))


def test_no_opponent_is_sought_in_an_image_of_the_floor() -> None:
    lower, body = lower_of(around([])), standing()
    report = lower.process(image([], axes_of(39.7), low=True), body)
    assert not report.sought and not report.azimuths
