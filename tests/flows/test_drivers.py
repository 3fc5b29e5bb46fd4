"""Robots outside the simulator, against peers that are not ours."""

from collections.abc import Callable
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flows.calls import (
    load_run,
    measure_bag,
    play_own,
    play_ros2,
    serve_ros2,
    write_page_of,
)
from flows.running import Running, until
from stepaside import GaitSettings

SPEED, GAIN = 0.2, 0.5  # of the template, in [m/s] and [1/s]
BEARING = 0.4  # of the opponent, in [rad]
OPPONENT = (cos(BEARING), sin(BEARING))  # in the robot's frame, in [m]
EVASION = BEARING - 0.5 * pi  # error of the evader by (4) and (5), in [rad]


def test_a_robot_on_ros2_walks_as_the_laws_say_and_is_recorded(
    start: Callable[..., Running], tmp_path: Path
) -> None:
    from flows.ros2_peer import DOMAIN, Ros2Robot

    robot, folder = Ros2Robot("/walker", OPPONENT), tmp_path / "run"
    template: dict[str, Any] = {"speed": SPEED, "gain": GAIN, "domain": DOMAIN}
    play = start(play_ros2("/walker", duration=3.0, record=folder, **template))
    command = (-SPEED, GAIN * EVASION)
    try:
        until(lambda: np.allclose(robot.velocity, command, atol=1e-6))
        assert play.end() == 0, play.said
        until(lambda: not robot.moves)
    finally:
        robot.close()
    run = load_run(folder)
    path = run.tracks["evader"].torso
    off = np.abs(np.array(robot.told) - path[-1]).sum(axis=1)
    assert off.min() < 1e-6 and abs(path[-1, 2]) > 1.0
    opponent = run.tracks["pursuer"].torso[-1]
    x, y, heading = path[-1]
    seen = np.hypot(opponent[0] - x, opponent[1] - y)
    assert seen == pytest.approx(1.0, abs=1e-3)
    ahead = np.arctan2(opponent[1] - y, opponent[0] - x) - heading
    assert np.sin(ahead - BEARING) == pytest.approx(0.0, abs=1e-3)
    faces = run.tracks["pursuer"].torso[-1, 2] - heading - BEARING
    assert np.cos(faces) == pytest.approx(-1.0, abs=1e-3)
    told = run.summary
    assert told.min_distance_m == pytest.approx(1.0, abs=1e-3)
    own = told.players["evader"]
    assert own.path_m == pytest.approx(3.0 * SPEED, rel=0.25)
    page = write_page_of(folder, tmp_path / "page.html")
    assert "evader" in page.read_text(encoding="utf-8")


def test_a_served_robot_goes_where_its_peer_on_ros2_commands(
    start: Callable[..., Running], tmp_path: Path
) -> None:
    from flows.ros2_peer import DOMAIN, Node, twist

    forward, rate = 0.05, 0.1  # [m/s], [rad/s]
    folder = tmp_path / "run"
    serve = start(
        serve_ros2("/served", domain=DOMAIN, duration=8.0, output=folder)
    )
    node = Node()
    odometry = node.reader("/served/odom", "nav_msgs/Odometry")
    sight = node.reader("/served/ideal_sight", "geometry_msgs/PointStamped")
    commands = node.writer("/served/cmd_vel", "geometry_msgs/Twist")
    poses: list[tuple[float, float, float]] = []
    seen, speeds = [(0.0, 0.0)], [(0.0, 0.0)]

    def answer() -> bool:
        for message in odometry.take(10):
            if hasattr(message, "pose"):
                assert message.child_frame_id == "served/base_footprint"
                pose = message.pose.pose
                turn = 2.0 * np.arctan2(pose.orientation.z, pose.orientation.w)
                poses.append((pose.position.x, pose.position.y, turn))
                own = message.twist.twist
                speeds.append((own.linear.x, own.angular.z))
                commands.write(twist(forward, rate))
        for message in sight.take(10):
            if hasattr(message, "point"):
                seen.append((message.point.x, message.point.y))
        return serve.process.poll() is not None

    until(answer)
    assert serve.end() == 0, serve.said
    tracks = load_run(folder).tracks
    first, *_, last = tracks["pursuer"].place
    heading = last[2] - first[2]
    assert 0.4 < heading < 8.0 * rate
    arc = forward / rate * np.array([sin(heading), 1.0 - cos(heading)])
    back = np.array(
        [[cos(first[2]), sin(first[2])], [-sin(first[2]), cos(first[2])]]
    )
    np.testing.assert_allclose(back @ (last - first)[:2], arc, atol=0.04)
    np.testing.assert_allclose(poses[-1][:2], arc, atol=0.02)
    assert poses[-1][2] == pytest.approx(heading, abs=0.05)
    assert speeds[-1] == pytest.approx((forward, rate))
    x, y = tracks["evader"].place[-1, :2] - last[:2]
    bearing = np.arctan2(y, x) - last[2]
    assert abs(bearing) > 0.3
    assert np.arctan2(*seen[-1][::-1]) == pytest.approx(bearing, abs=0.05)
    assert np.hypot(*seen[-1]) == pytest.approx(np.hypot(x, y), abs=0.05)


def test_an_own_robot_keeps_its_limits_along_the_same_curve(
    start: Callable[..., Running], tmp_path: Path
) -> None:
    """Beyond a limit, speed and turning rate shrink by the same factor."""
    file, log = tmp_path / "mine.py", tmp_path / "log"
    file.write_text(VELOCITY_ROBOT.format(log=log), encoding="utf-8")
    rate = GAIN * BEARING
    play = start(
        play_own(f"{file}:Mine", role="pursuer", speed=SPEED, gain=GAIN)
    )
    share = 0.15 / rate
    expected = (SPEED * share, 0.0, 0.15)

    def commanded() -> bool:
        lines = log.read_text().splitlines() if log.exists() else []
        newest = lines[-1].split() if lines else ["0"] * 3
        return np.allclose([float(v) for v in newest], expected, atol=1e-9)

    until(commanded)
    assert play.interrupt() == 0, play.said
    assert not any(map(float, log.read_text().splitlines()[-1].split()))


VELOCITY_ROBOT = """
from time import monotonic, sleep
import stepaside as sa

class Mine(sa.VelocityRobot):
    limits = sa.VelocityLimits(forward=1.0, backward=1.0, turn=0.15)

    def listen(self):
        sleep(0.02)
        now = monotonic()
        seen = sa.Sighting(now, 0.4, 1.0)
        return sa.RobotState(now, sighting=seen, pose=sa.Pose(0.0, 0.0, 0.0))

    def command(self, forward, lateral, turn):
        with open("{log}", "a") as log:
            print(forward, lateral, turn, file=log)
"""
JOINT_ROBOT = '''
import stepaside as sa

class Mine(sa.JointRobot):
    """NAO whose joints are where they are told to be; its time may pause."""

    tick, paced, time = 0.012, False, 0.0
    joints = sa.load_tree(sa.load_robot("nao")).joints
    gains = dict.fromkeys(joints, (100.0, 5.0))
    angles = [0.0] * len(joints)

    def listen(self):
        self.time += self.tick
        force = (0.0, 0.0, 9.8 + 0.01 * (round(self.time / self.tick) % 7))
        return sa.RobotState(
            self.time, self.angles, (0.0, 0.0, 0.0), force, [6.5] * 8,
            sa.Sighting(self.time, 0.4, 0.7),
            joint_velocities=[0.0] * len(self.joints), tilt=(0.0, 0.0),
        )

    def command(self, targets):
        self.angles = targets.angles

    def release(self):
        with open("{log}", "a") as log:
            print("released", file=log)
'''


def test_an_own_robot_of_joints_walks_the_papers_gait(
    start: Callable[..., Running], tmp_path: Path
) -> None:
    file, log = tmp_path / "mine.py", tmp_path / "log"
    file.write_text(JOINT_ROBOT.format(log=log), encoding="utf-8")
    folder = tmp_path / "run"
    play = start(play_own(f"{file}:Mine", duration=8.0, record=folder))
    assert play.end() == 0, play.said
    assert log.read_text().split() == ["released"]
    run = load_run(folder)
    check_evasion(run)


def check_evasion(run: Any) -> None:
    """Check gait and turns of an evader that sees its opponent at 0.4 rad."""
    gait = GaitSettings()
    began, ended = (
        next(c.time_s for c in run.summary.play.changes if c.state == state)
        for state in ("walking", "stopping")
    )
    assert ended - began == pytest.approx(8.0, abs=0.05)
    steps = (ended - began - gait.start_support) // gait.step_duration
    assert abs(run.summary.planning.steps - steps) <= 1
    walk = (run.times > began + 3.0) & (run.times < ended)
    path, times = run.tracks["evader"].torso[walk], run.times[walk]
    share = gait.path_interval / gait.step_duration  # of path per gait time
    rate = np.polyfit(times, np.unwrap(path[:, 2]), 1)[0]
    assert rate == pytest.approx(gait.gain * EVASION * share, rel=0.05)
    ahead = np.stack([np.cos(path[:, 2]), np.sin(path[:, 2])], axis=1)
    velocity = np.diff(path[:, :2], axis=0) / np.diff(times)[:, None]
    speed = (velocity * ahead[1:]).sum(axis=1).mean()
    assert speed == pytest.approx(-gait.stride / gait.step_duration, rel=0.1)


def test_a_robot_on_lola_walks_the_papers_gait(
    start: Callable[..., Running], tmp_path: Path
) -> None:
    from flows.lola_peer import LolaRobot

    robot = LolaRobot(tmp_path / "e", BEARING, 0.7)
    folder = tmp_path / "run"
    play = start(play_own(robot.client, duration=8.0, record=folder))
    assert play.end() == 0, play.said
    assert robot.moved > 1.0
    check_evasion(load_run(folder))


def test_motion_that_others_recorded_is_measured(tmp_path: Path) -> None:
    """Two robots on one circle: one on tf, one on a topic, in one map.

    They were recorded later, and at half the pace, from another bag.
    """
    rosbag = pytest.importorskip("rosbags.rosbag2")
    typesys = pytest.importorskip("rosbags.typesys")
    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    radius, apart, rate = 0.8, 2.0, 0.4  # [m], [rad], [rad/s]
    origin = 3.0, -1.0, 2.0  # of the first robot's odometry in the map

    def make(kind: str, *values: Any) -> Any:
        return store.types[kind.replace("/", "/msg/")](*values)

    def stamped(time: float, frame: str) -> Any:
        stamp = divmod(round(1e9 * time), 10**9)
        made = make("builtin_interfaces/Time", *stamp)
        return make("std_msgs/Header", made, frame)

    def turn(heading: float) -> Any:
        half = 0.5 * heading
        return make("geometry_msgs/Quaternion", 0.0, 0.0, sin(half), cos(half))

    def tf(time: float, parent: str, child: str, pose: Any) -> Any:
        offset = make("geometry_msgs/Vector3", pose[0], pose[1], 0.0)
        both = make("geometry_msgs/Transform", offset, turn(pose[2]))
        head = stamped(time, parent)
        one = make("geometry_msgs/TransformStamped", head, child, both)
        return make("tf2_msgs/TFMessage", [one])

    def on_circle(angle: float) -> tuple[float, float, float]:
        x, y = 1.0 + radius * cos(angle), 2.0 + radius * sin(angle)
        return x, y, angle + 0.5 * pi

    bag = tmp_path / "bag"
    with rosbag.Writer(bag, version=9) as writer:

        def channel(topic: str, kind: str) -> Callable[[float, Any], None]:
            name = kind.replace("/", "/msg/")
            made = writer.add_connection(topic, name, typestore=store)

            def write(time: float, message: Any) -> None:
                raw = store.serialize_cdr(message, name)
                writer.write(made, round(1e9 * (5.0 + 2.0 * time)), raw)

            return write

        static = channel("/tf_static", "tf2_msgs/TFMessage")
        moving = channel("/tf", "tf2_msgs/TFMessage")
        topic = channel("/b/pose", "geometry_msgs/PoseStamped")
        static(0.0, tf(0.0, "map", "a/odom", origin))
        for time in np.arange(0.0, 30.0, 0.05):
            x, y, heading = on_circle(rate * time)
            dx, dy = x - origin[0], y - origin[1]
            c, s = cos(origin[2]), sin(origin[2])
            own = c * dx + s * dy, c * dy - s * dx, heading - origin[2]
            moving(time, tf(time, "a/odom", "a", own))
            x, y, heading = on_circle(rate * time + apart)
            point = make("geometry_msgs/Point", x, y, 0.0)
            place = make("geometry_msgs/Pose", point, turn(heading))
            head = stamped(time, "map")
            topic(time, make("geometry_msgs/PoseStamped", head, place))

    folder = tmp_path / "run"
    summary = measure_bag(bag, folder, pursuer="a", evader="/b/pose")
    chord = 2.0 * radius * sin(0.5 * apart)
    for player in ("pursuer", "evader"):
        found = summary["players"][player]["radius_m"]
        assert found == pytest.approx(radius, rel=1e-3)
    assert summary["distance_m"] == pytest.approx(chord, rel=1e-3)
    assert summary["min_distance_m"] == pytest.approx(chord, rel=1e-3)
    found = np.radians(summary["relative_orientation_deg"])
    assert found == pytest.approx(apart, abs=1e-3)
    run = load_run(folder)
    middle = len(run.times) // 2
    expected = on_circle(rate * run.times[middle])
    np.testing.assert_allclose(
        run.tracks["pursuer"].torso[middle][:2], expected[:2], atol=1e-6
    )
