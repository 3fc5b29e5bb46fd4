"""Test that the lower camera tells of the feet of who is near."""

from math import atan2, cos, hypot, radians, sin

import numpy as np
import pytest

from stepaside.core.poses import Pose, wrap_angle
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.camera_pose import CameraPose, camera_pose
from stepaside.perception.colour_detector import RED, ColourDetector
from stepaside.perception.floor_colours import floor_points
from stepaside.perception.foot_tracking import CLOSE, FootDetector
from stepaside.perception.images import ColourImage
from stepaside.perception.measurement import Measurement
from stepaside.perception.perception_builder import build_perception
from stepaside.perception.track import Observation, TargetTrack
from stepaside.robots.head import Mount
from synthetic_cameras import HEAD, JOINTS, NAO, UP
from synthetic_depth import Post, paint

CAMERA = CameraModel.of_field_of_view(160, 120, radians(60.9), radians(47.6))
Legs = list[Post]


class Standing:
    """Perception of a robot that stands at the origin and looks ahead."""

    def __init__(self, *, people: bool = True) -> None:
        self.perception = build_perception(
            NAO, HEAD, ColourDetector(RED), tick=0.02, people=people
        )
        self.see(0.0)

    def see(self, time: float, *images: ColourImage) -> None:
        """Take in one tick."""
        self.perception.see(
            Measurement(
                *(time, np.zeros(JOINTS), np.zeros(3), UP, np.zeros(8), None),
                tuple(images),
            ),
            Pose(0.0, 0.05, 0.0),
            True,
            (0.0, 0.0),
        )

    def image(self, time: float, legs: Legs, *, low: bool) -> ColourImage:
        """Image of legs on a floor by one camera of the head."""
        body, mount = self.perception.body, self.mount(low=low)
        assert body is not None
        place, axes, _ = camera_pose(body, mount)
        pixels = paint(CAMERA, place, axes, legs)
        return ColourImage(time, CAMERA, pixels, low)

    @staticmethod
    def mount(*, low: bool) -> Mount:
        """Of one camera of the head."""
        mount = HEAD.bottom if low else HEAD.top
        assert mount is not None
        return mount

    def follow(
        self, x: float, y: float, *, walked: bool = True
    ) -> TargetTrack:
        """Track with a position error of 0.15 m."""
        track = TargetTrack(
            Observation(0.0, x, y, 0.0, 0.15, 0.15, False, True)
        )
        track.confirmed, track.has_walked = True, walked
        self.perception.tracker.tracks.append(track)
        return track


def legs_at(x: float, y: float) -> Legs:
    """Two legs side by side, who come from ahead."""
    return [(x, y + side, 0.06, 0.8) for side in (0.09, -0.09)]


@pytest.mark.parametrize("place", [(0.5, 0.0), (0.7, 0.15), (0.9, -0.2)])
def test_the_lower_camera_tells_how_far_the_feet_are(
    place: tuple[float, float],
) -> None:
    robot = Standing()
    robot.see(0.02, robot.image(0.02, [], low=False))
    track = robot.follow(place[0] + 0.15, place[1] + 0.1)
    for i in range(2, 12):
        now = 0.02 * i
        robot.see(now, robot.image(now, legs_at(*place), low=True))
    x, y = track.position_at(0.22)
    # These legs have no toes.
    assert hypot(x, y) == pytest.approx(hypot(*place), abs=0.1)
    off = wrap_angle(atan2(y, x) - atan2(place[1], place[0]))
    assert abs(off) < radians(4.0)
    (report,) = robot.perception.reports
    assert len(report.azimuths) == 1 and report.image.camera is CAMERA


def test_feet_start_no_track_and_move_no_resting_one() -> None:
    robot = Standing()
    robot.see(0.02, robot.image(0.02, [], low=False))
    low = robot.image(0.04, legs_at(0.6, 0.0), low=True)
    robot.see(0.04, low)
    assert robot.perception.tracker.tracks == []
    resting = robot.follow(0.7, 0.0, walked=False)
    robot.see(0.06, robot.image(0.06, legs_at(0.6, 0.0), low=True))
    assert resting.position_at(0.06) == pytest.approx((0.7, 0.0))


def test_the_lower_camera_is_wanted_when_a_person_is_close() -> None:
    robot = Standing()
    perception = robot.perception
    near = robot.follow(CLOSE - 0.1, 0.0)
    assert not perception.looks_low()  # the floor is not known yet
    perception.tracker.tracks.clear()
    robot.see(0.02, robot.image(0.02, [], low=False))
    perception.tracker.tracks.append(near)
    assert perception.looks_low()
    near.has_walked = False
    assert not perception.looks_low()
    perception.tracker.tracks[:] = [robot.follow(CLOSE + 0.1, 0.0)]
    assert not perception.looks_low()


def test_who_looks_for_a_robot_uses_one_camera() -> None:
    robot = Standing(people=False)
    robot.see(0.02, robot.image(0.02, [], low=False))
    robot.follow(0.8, 0.0)
    assert not robot.perception.looks_low()


@pytest.mark.parametrize("frame", [(2.0, -1.5, 0.0), (-0.7, 3.0, 2.5)])
def test_it_is_the_same_wherever_odometry_began(
    frame: tuple[float, float, float],
) -> None:
    """Learnt floor colours, and the feet found with them."""
    robot, began = Standing(), Pose(*frame)
    body = robot.perception.body
    assert body is not None
    c, s = cos(began.theta), sin(began.theta)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    shift = np.array([began.x, began.y, 0.0])
    up, down = (
        camera_pose(body, robot.mount(low=low))._replace(
            position_torso_in_odometry=(0.0, 0.0)
        )
        for low in (False, True)
    )
    x, y = began.transform_points([(2.4, 0.9)])[0].tolist()
    people = [robot.follow(2.4, 0.9)], [robot.follow(x, y)]
    both = FootDetector(), FootDetector()
    for i in range(2):
        far = robot.image(0.02 * i, [], low=False)
        both[0].learn(far, up, people[0])
        moved_up = CameraPose(turn @ up[0] + shift, turn @ up[1], began[:2])
        both[1].learn(far, moved_up, people[1])
    one, other = (feet.colours.counts for feet in both)
    assert np.abs(one - other).sum() < 1e-3 * one.sum()  # pixels on an edge
    near = robot.image(0.04, legs_at(0.6, 0.2), low=True)
    (here,) = both[0].observe(near, down)
    moved_down = CameraPose(turn @ down[0] + shift, turn @ down[1], began[:2])
    (there,) = both[1].observe(near, moved_down)
    moved = began.transform_points([(here.x_in_odometry, here.y_in_odometry)])[
        0
    ]
    assert (there.x_in_odometry, there.y_in_odometry) == pytest.approx(
        tuple(moved), abs=1e-6
    )
    assert here.bearing == pytest.approx(
        atan2(here.y_in_odometry, here.x_in_odometry), abs=1e-6
    )
    off = wrap_angle(there.bearing - here.bearing - began.theta)
    assert off == pytest.approx(0.0, abs=1e-6)


def test_floor_is_learnt_where_no_person_hides_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """From 0.5 m to 2.5 m, neither near a person nor behind one."""
    feet, robot, floors = FootDetector(), Standing(), []
    monkeypatch.setattr(
        feet.colours, "learn", lambda _, floor: floors.append(floor)
    )
    body = robot.perception.body
    assert body is not None
    camera = camera_pose(body, HEAD.top)._replace(
        position_torso_in_odometry=(0.1, 0.0)
    )
    image = robot.image(0.02, [], low=False)
    people = [robot.follow(1.9, 0.6), robot.follow(2.4, -1.2)]
    feet.learn(image, camera, people)
    points = floor_points(image, camera)
    wanted, farther = np.zeros(points.shape[:2], bool), 0
    for row, column in np.ndindex(wanted.shape):
        x, y = points[row, column]
        away = hypot(x - 0.1, y)
        near = [
            hypot(x - u, y - v) < 0.7 for u, v in ((1.9, 0.6), (2.4, -1.2))
        ]
        hidden = away > hypot(1.8, 0.6) - 0.7
        farther += hidden and not any(near) and away < 2.5
        wanted[row, column] = 0.5 < away < 2.5 and not hidden and not any(near)
    np.testing.assert_array_equal(floors[0], wanted)
    assert wanted.any() and farther > 100


def test_floor_under_a_person_is_not_learnt() -> None:
    """Nor of what is hidden behind."""
    feet, robot = FootDetector(), Standing()
    someone = robot.follow(1.0, 0.0)
    body = robot.perception.body
    assert body is not None
    camera = camera_pose(body, HEAD.top)._replace(
        position_torso_in_odometry=(0.0, 0.0)
    )
    image = robot.image(0.02, legs_at(1.0, 0.0), low=False)
    feet.learn(image, camera, [someone])
    assert not feet.colours.known
    feet.learn(image, camera, [])
    assert feet.colours.known
