"""Test the walks of people, and their closest approach to the template."""

from math import atan2, cos, hypot, pi, sin
from pathlib import Path

import pytest

from stepaside.arena import Disc, Room
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose, wrap_angle
from stepaside.sim.person_motion import PersonMotion, Place, read_path
from stepaside.sim.person_settings import PersonSettings
from stored_values import rows_of

EVADER = (1.0, -2.0)


@pytest.mark.parametrize("miss", [-0.7, 0.0, 0.4])
@pytest.mark.parametrize("start", [(0.0, 0.0), (3.0, 1.0), (-1.0, -4.0)])
def test_a_straight_walk_aims_to_the_left_of_the_evader(
    start: Place, miss: float
) -> None:
    """A right miss is a negative one; the heading at the start is nothing."""
    person = PersonSettings("straight", 0.5, miss=miss)
    motion = PersonMotion(person, Pose(*start, 2.0), EVADER)
    assert motion.pose[:2] == start
    dx, dy = EVADER[0] - start[0], EVADER[1] - start[1]
    aside = wrap_angle(motion.pose.theta - atan2(dy, dx))
    assert aside == pytest.approx(atan2(miss, hypot(dx, dy)))


@pytest.mark.parametrize("bearing", [-3.0, -0.5, 0.5, 3.0])
@pytest.mark.parametrize("heading", [0.0, 3.0])
def test_steering_turns_the_short_way_and_walks_on(
    bearing: float, heading: float
) -> None:
    person = PersonSettings("steer", 0.4, 0.6)
    motion = PersonMotion(person, Pose(1.0, 2.0, heading), EVADER)
    assert motion.pose.theta == heading
    aim = heading + bearing
    evader = 1.0 + 9.0 * cos(aim), 2.0 + 9.0 * sin(aim)
    motion.advance(0.05, 0.05, evader)
    x, y, theta = motion.pose
    assert theta - heading == pytest.approx(0.05 * 0.6 * bearing)
    way = 0.05 * 0.4
    assert (x - 1.0, y - 2.0) == pytest.approx(
        (way * cos(theta), way * sin(theta))
    )


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_person_turns_no_tighter_than_its_radius(side: float) -> None:
    """Steering at someone inside its circle, it walks the circle."""
    radius = 0.5
    person = PersonSettings("steer", 1.0, 50.0, turning_radius=radius)
    motion = PersonMotion(person, Pose(0.0, 0.0, 0.0), EVADER)
    inside = (0.0, 0.8 * side * radius)
    for i in range(1, 400):
        motion.advance(0.01 * i, 0.01, inside)
        x, y, _ = motion.pose
        assert hypot(x, y - side * radius) == pytest.approx(radius, rel=0.02)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_person_feints_each_time_it_comes_near(side: float) -> None:
    """It turns by its limit for the duration, and then back."""
    radius, speed, feint_at = 0.5, 1.0, 2.0
    person = PersonSettings(
        *("steer", speed, 50.0),
        turning_radius=radius,
        feint_at=feint_at,
        feint=0.4 * side,
    )
    motion = PersonMotion(person, Pose(-4.0, 0.0, 0.0), (0.0, 0.0))
    headings, away = [], []
    for i in range(1, 400):
        motion.advance(0.01 * i, 0.01, (0.0, 0.0))
        headings.append(motion.pose.theta)
        away.append(hypot(motion.pose.x, motion.pose.y))
    begins = next(i for i, d in enumerate(away) if d < feint_at)
    assert headings[begins] == pytest.approx(0.0, abs=1e-9)
    turn = 0.4 * speed / radius * side
    assert headings[begins + 41] == pytest.approx(turn, abs=0.05)
    assert side * headings[begins + 60] < side * turn
    assert min(away) < 0.2  # it steers at the evader in the end


def recorded(folder: Path, lines: str) -> Path:
    file = folder / "walk.csv"
    file.write_text("time, x, y\n" + lines, encoding="utf-8")
    return file


def test_a_recorded_walk_is_where_and_heads_as_recorded(
    tmp_path: Path,
) -> None:
    file = recorded(tmp_path, "1,0,0\n3,-1,-1\n5,-1.5,-2\n")
    person = PersonSettings(str(file))
    motion = PersonMotion(person, Pose(9.0, 9.0, 1.0), EVADER)
    aslant, down = -0.75 * pi, atan2(-1.0, -0.5)
    assert motion.pose == pytest.approx((0.0, 0.0, 0.0))  # not begun yet
    for time, pose in (
        (1.5, (-0.25, -0.25, aslant)),
        (2.0, (-0.5, -0.5, aslant)),
        (2.95, (-0.975, -0.975, atan2(-0.05, -0.0375))),  # 0.1 s ahead
        (4.0, (-1.25, -1.5, down)),
        (4.99, (-1.4975, -1.995, down)),
        (8.0, (-1.5, -2.0, down)),  # there it stands
    ):
        motion.advance(time, 0.004, EVADER)
        assert motion.pose == pytest.approx(pose)


@pytest.mark.parametrize(
    ("lines", "message"), rows_of("test_invalid_rows_are_refused")
)
def test_invalid_rows_are_refused(
    tmp_path: Path, lines: str, message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message):
        read_path(recorded(tmp_path, lines))


def test_columns_of_a_recorded_walk_are_named(tmp_path: Path) -> None:
    file = tmp_path / "walk.csv"
    file.write_text("x,y,time\n0,0,0\n1,1,1\n")
    with pytest.raises(ConfigurationError, match="first line must be time,x"):
        read_path(file)


@pytest.mark.parametrize("path", ["straight", "steer"])
@pytest.mark.parametrize("reaction", ["none", "regular"])
def test_a_person_stays_in_its_room(path: str, reaction: str) -> None:
    """The evader stands behind a disc, near a corner."""
    if path == "steer" and reaction != "none":
        return
    room = Room(4.0, 4.0, (Disc(0.5, 0.3, 0.3),))
    person = PersonSettings(path, 1.0, 1.0, reaction=reaction)
    start, evader = Pose(-1.2, -0.4, 0.3), (1.6, 1.4)
    motion = PersonMotion(person, start, evader, room.solid_set)
    for i in range(800):
        motion.advance(0.01 * (i + 1), 0.01, evader)
        place = [motion.pose[:2]]
        assert room.solid_set.clearance(place)[0] > 0.1
    moved = hypot(motion.pose.x - start.x, motion.pose.y - start.y)
    assert moved > 1.0


def walked(person: PersonSettings, ways: int = 40) -> list[Pose]:
    """Poses of a walk in steps of 0.05 m, the start among them."""
    motion = PersonMotion(person, Pose(0.0, 0.0, 0.0), (9.0, 0.0))
    poses = [motion.pose]
    for i in range(ways):
        motion.advance(0.1 * (i + 1), 0.1, (9.0, 0.0))
        poses.append(motion.pose)
    return poses


@pytest.mark.parametrize("path", ["straight", "steer"])
def test_a_halted_person_stands_at_the_set_distance(path: str) -> None:
    poses = walked(PersonSettings(path, 0.5, halt_after=1.0))
    assert poses[20].x == pytest.approx(1.0)
    assert poses[20:] == [poses[20]] * 21
    assert walked(PersonSettings(path, 0.5, halt_after=0.0))[-1].x == 0.0


@pytest.mark.parametrize("turn", [-1.0, 0.5 * pi, pi])
@pytest.mark.parametrize("after", [0.0, 1.0])
def test_a_turned_person_walks_in_the_new_direction(
    turn: float, after: float
) -> None:
    person = PersonSettings("straight", 0.5, turn_after=after, turn=turn)
    poses = walked(person)
    rest = 2.0 - after
    assert poses[-1].theta == pytest.approx(turn)
    end = after + rest * cos(turn), rest * sin(turn)
    assert poses[-1][:2] == pytest.approx(end)


@pytest.mark.parametrize("path", ["straight", "steer"])
def test_a_backward_walk_follows_the_same_path_facing_away(path: str) -> None:
    ahead = walked(PersonSettings(path, 0.5, miss=0.3, turn_after=1.0))
    back = walked(
        PersonSettings(path, 0.5, miss=0.3, turn_after=1.0, backward=True)
    )
    for one, other in zip(ahead, back, strict=True):
        assert other[:2] == pytest.approx(one[:2])
        off = wrap_angle(other.theta - one.theta)
        assert abs(off) == pytest.approx(pi)
