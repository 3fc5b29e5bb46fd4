"""Test motion of players that was recorded elsewhere, in ROS 2 bags."""

import json
from collections.abc import Callable
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array, Pose
from stepaside.games.experiment import import_experiment
from stepaside.games.game_settings import StartSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run_archive import write_run_files

pytest.importorskip("rosbags", reason="rosbags is not installed")

from rosbags.rosbag2 import StoragePlugin, Writer  # noqa: E402
from rosbags.typesys import Stores, get_typestore  # noqa: E402

pytestmark = pytest.mark.usefixtures("blank_figures")

STORE = get_typestore(Stores.ROS2_JAZZY)
RATE = 0.4  # turning rate of the players, in [rad/s]
Entry = tuple[float, str, str, Any]


def make(kind: str, *values: Any) -> Any:
    return STORE.types[kind](*values)


def header(time: float, frame: str) -> Any:
    stamp = round(time * 1e9)
    unix = make("builtin_interfaces/msg/Time", stamp // 10**9, stamp % 10**9)
    return make("std_msgs/msg/Header", unix, frame)


def turn(heading: float) -> Any:
    half = 0.5 * heading
    return make(
        "geometry_msgs/msg/Quaternion", 0.0, 0.0, np.sin(half), np.cos(half)
    )


def transform(time: float, parent: str, child: str, pose: Pose) -> Any:
    offset = make("geometry_msgs/msg/Vector3", pose.x, pose.y, 0.0)
    both = make("geometry_msgs/msg/Transform", offset, turn(pose.theta))
    return make(
        "geometry_msgs/msg/TransformStamped", header(time, parent), child, both
    )


def tf(topic: str, time: float, *transforms: Any) -> Entry:
    kind = "tf2_msgs/msg/TFMessage"
    return time, topic, kind, make(kind, list(transforms))


def odometry(topic: str, time: float, frame: str, pose: Pose) -> Entry:
    kind = "nav_msgs/msg/Odometry"
    point = make("geometry_msgs/msg/Point", pose.x, pose.y, 0.0)
    place = make("geometry_msgs/msg/Pose", point, turn(pose.theta))
    none = make("geometry_msgs/msg/Vector3", 0.0, 0.0, 0.0)
    unknown = np.zeros(36)
    message = make(
        kind,
        header(time, frame),
        "base_link",
        make("geometry_msgs/msg/PoseWithCovariance", place, unknown),
        make(
            "geometry_msgs/msg/TwistWithCovariance",
            make("geometry_msgs/msg/Twist", none, none),
            unknown,
        ),
    )
    return time, topic, kind, message


def write_bag(
    folder: Path, entries: list[Entry], *, plugin: Any = StoragePlugin.SQLITE3
) -> Path:
    """Write a bag in the order of its times."""
    with Writer(folder, version=9, storage_plugin=plugin) as writer:
        connections: dict[str, Any] = {}
        for time, topic, kind, message in sorted(entries, key=lambda e: e[0]):
            if topic not in connections:
                connections[topic] = writer.add_connection(
                    topic, kind, typestore=STORE
                )
            raw = STORE.serialize_cdr(message, kind)
            stamp = round((time + 1.7e9) * 1e9)
            writer.write(connections[topic], stamp, raw)
    return folder


def on_circle(time: float, radius: float, ahead: float) -> Pose:
    """Return a pose on a circle about (1, 2), walked to the left."""
    angle = RATE * time + ahead
    return Pose(
        1.0 + radius * np.cos(angle),
        2.0 + radius * np.sin(angle),
        angle + 0.5 * pi,
    )


@pytest.fixture
def circling(tmp_path: Path) -> Path:
    """Bag of two robots a quarter turn apart on a circle of 0.8 m.

    Their odometry begins elsewhere in a map; one is on ``tf`` at 20 Hz and
    the other at 7 Hz, and both are on odometry topics, too.
    """
    start = Pose(3.0, -1.0, 2.0)
    entries = [tf("/tf_static", 0.0, transform(0.0, "map", "a/odom", start))]
    for time in np.arange(0.0, 30.0, 0.05).tolist():
        pose = on_circle(time, 0.8, 0.0)
        local = start.inverse().compose(pose)
        entries.append(tf("/tf", time, transform(time, "a/odom", "a", local)))
        entries.append(odometry("/a/odometry", time, "map", pose))
    for time in np.arange(0.0, 30.0, 1.0 / 7.0).tolist():
        pose = on_circle(time, 0.8, 0.5 * pi)
        entries.append(tf("/tf", time, transform(time, "map", "b", pose)))
        entries.append(odometry("/b/odometry", time, "map", pose))
    return write_bag(tmp_path / "circling", entries)


def replay(*words: object) -> Result:
    return CliRunner().invoke(main, ["show", *map(str, words)])


@pytest.mark.slow
def test_a_duel_that_is_exported_and_imported_has_the_same_circle(
    tmp_path: Path,
) -> None:
    start = StartSettings(distance=0.9, pursuer_offset=0.1, evader_offset=0.2)
    run = run_game(duel(duration=6.0, start=start))
    folder = tmp_path / "duel"
    folder.mkdir()
    write_run_files(folder, run)
    words = ["show", str(folder), "-o", f"{folder}.mcap", "--no-repeat"]
    assert CliRunner().invoke(main, words).exit_code == 0
    frames = [f"--frame={n}={n}/base_footprint" for n in run.players]
    result = replay(folder.with_name("duel.mcap"), *frames, "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    for key in ("distance_m", "relative_orientation_deg"):
        assert found[key] == pytest.approx(getattr(run.summary, key), rel=1e-9)
    for name in run.players:
        radius = run.summary.players[name].radius_m
        again_radius = found["players"][name]["radius_m"]
        assert again_radius == pytest.approx(radius, rel=1e-9)
    file = folder.with_name("duel.mcap") / "duel.mcap"
    again = import_experiment(
        file, ("pursuer=/pursuer/pose", "evader=/evader/pose")
    )
    np.testing.assert_allclose(again.distance, run.distance, atol=1e-12)


def test_a_gap_is_noted(circling: Path, tmp_path: Path) -> None:
    entries = [
        odometry(f"/{name}", time, "map", on_circle(time, 1.0, ahead))
        for name, ahead in (("a", 0.0), ("b", 1.0))
        for time in np.arange(0.0, 10.0, 0.1).tolist()
        if name == "a" or not 3.0 < time < 5.0
    ]
    bag = write_bag(tmp_path / "gap", entries)
    run = import_experiment(bag, ("pursuer=/a", "evader=/b"))
    assert run.summary.notes == ["evader has no pose for 2.00 s; interpolated"]


def test_invalid_poses_are_left_out(tmp_path: Path) -> None:
    entries = []
    for name, ahead in (("a", 0.0), ("b", 0.5 * pi)):
        for i, time in enumerate(np.arange(0.0, 10.0, 0.05).tolist()):
            entry = odometry(
                f"/{name}", time, "map", on_circle(time, 1.0, ahead)
            )
            pose = entry[3].pose.pose
            q = pose.orientation
            # A quaternion of any length is a rotation; zero is none.
            q.z, q.w = 0.3 * q.z, 0.3 * q.w
            if name == "b" and i == 50:
                q.z = q.w = 0.0
            if name == "b" and i == 90:
                pose.position.x = np.nan
            entries.append(entry)
    bag = write_bag(tmp_path / "invalid", entries)
    run = import_experiment(bag, ("pursuer=/a", "evader=/b"))
    assert run.summary.distance_m == pytest.approx(2**0.5, rel=1e-3)
    assert run.summary.notes == ["evader has 2 invalid poses; left out"]
    times: Array = run.times
    expected = [on_circle(t, 1.0, 0.0) for t in times.tolist()]
    np.testing.assert_allclose(run.pursuer.torso, expected, atol=1e-6)


def _apart(folder: Path) -> Path:
    entries = [
        odometry("/a", t, "map", Pose(0.0, 0.0, 0.0)) for t in (1.0, 2.0)
    ] + [odometry("/b", t, "odom", Pose(1.0, 0.0, 0.0)) for t in (1.0, 2.0)]
    return write_bag(folder / "apart", entries)


def _never_together(folder: Path) -> Path:
    entries = [
        odometry("/a", t, "map", Pose(0.0, 0.0, 0.0)) for t in (1.0, 2.0)
    ] + [odometry("/b", t, "map", Pose(1.0, 0.0, 0.0)) for t in (5.0, 6.0)]
    return write_bag(folder / "never", entries)


def _not_finite(folder: Path) -> Path:
    entries = [
        odometry(topic, t, "map", Pose(np.nan if t > 1.5 else 0.0, 0.0, 0.0))
        for topic in ("/a", "/b")
        for t in (1.0, 2.0)
    ]
    return write_bag(folder / "nan", entries)


def _looped(folder: Path) -> Path:
    """The clock of the second player begins anew at 5 s."""
    entries = []
    for time in np.arange(0.0, 10.0, 0.1).tolist():
        pose = on_circle(time, 1.0, 0.0)
        entries.append(odometry("/a", time, "map", pose))
        again = time if time < 5.0 else time - 5.0
        pose = on_circle(time, 1.0, pi)
        _, *rest = odometry("/b", again, "map", pose)
        entries.append((time, rest[0], rest[1], rest[2]))
    return write_bag(folder / "looped", entries)


def _text(folder: Path) -> Path:
    file = folder / "text.mcap"
    file.write_text("no bag")
    return file


@pytest.mark.parametrize(
    ("bag_in", "words", "message"),
    [
        (_apart, ("p=/a", "e=/b"), "one frame, got p in map, e in odom"),
        (_apart, ("p=/a", "e=/c"), "got None in apart: /a, /b"),
        (_apart, ("p=/a", "e=c"), "e=c must be a frame of apart"),
        (_apart, ("p=/a",), "must be 2 to 32, each as --frame"),
        (_apart, ("p=/a", "p=/b"), "frame of p must be given once"),
        (_apart, ("p=/a", "P"), "frame must be NAME=FRAME"),
        (_never_together, ("p=/a", "e=/b"), "poses at common times"),
        (_not_finite, ("p=/a", "e=/b"), "must be finite"),
        (_looped, ("p=/a", "e=/b"), "stamps of e must not go back, got 4.90"),
        (_text, ("p=/a", "e=/b"), "must be a ROS 2 bag"),
    ],
)
def test_a_bag_that_cannot_be_measured_is_refused_in_one_line(
    bag_in: Callable[[Path], Path],
    words: tuple[str, ...],
    message: str,
    tmp_path: Path,
) -> None:
    bag = bag_in(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(ConfigurationError, match=message):
        import_experiment(bag, words)
    frames = [f"--frame={word}" for word in words]
    result = replay(bag, *frames, f"--output={tmp_path}/run")
    assert result.exit_code == 2 and result.stderr.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before
