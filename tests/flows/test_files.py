"""What other programs read: tables, bags, models, pages, films, figures."""

import csv
import json
import re
from base64 import b64decode
from math import cos, hypot, sin
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
import pytest

import stepaside as sa
from flows.calls import (
    draw_comparison,
    draw_saved_run,
    export_run,
    film_run,
    keep_duel,
    load_run,
    write_page_of,
)

GRAVITY = 9.81  # [m/s^2]
PLAYERS = ("pursuer", "evader")


class Table(NamedTuple):
    """Samples of a run as CSV: columns by name."""

    columns: dict[str, np.ndarray]

    def of(self, name: str, *parts: str) -> np.ndarray:
        """Columns of a signal. Shape (n, parts)."""
        return np.stack([self.columns[f"{name}/{p}"] for p in parts], axis=1)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Duel whose evader begins at once, turned by half a turn."""
    return keep_duel(
        tmp_path_factory.mktemp("files") / "duel",
        *(0.75, 0.3, 0.2),
        duration=6.0,
    )


@pytest.fixture(scope="module")
def run(folder: Path) -> Any:
    return load_run(folder)


@pytest.fixture(scope="module")
def table(folder: Path) -> Table:
    tables = export_run(folder, "csv", folder.with_name("csv"))
    with (tables / "samples.csv").open(newline="") as stream:
        names, *rows = csv.reader(stream)
    values = np.array([[float(v or "nan") for v in row] for row in rows])
    return Table(dict(zip(names, values.T, strict=True)))


@pytest.fixture(scope="module")
def bag(folder: Path) -> dict[str, list[tuple[float, Any]]]:
    """Times and messages by topic, read by mcap's own reader."""
    reader = pytest.importorskip("mcap.reader")
    decoder = pytest.importorskip("mcap_ros2.decoder")
    pytest.importorskip("rosbags")
    exported = export_run(folder, "mcap", folder.with_name("mcap"))
    topics: dict[str, list[tuple[float, Any]]] = {}
    with (exported / f"{folder.name}.mcap").open("rb") as stream:
        made = reader.make_reader(
            stream, decoder_factories=[decoder.DecoderFactory()]
        )
        for _, channel, record, message in made.iter_decoded_messages():
            entry = 1e-9 * record.log_time, message
            topics.setdefault(channel.topic, []).append(entry)
    return topics


def axes(quaternions: np.ndarray) -> np.ndarray:
    """Rotation matrices of (w, x, y, z). Shape (n, 3, 3)."""
    w, x, y, z = quaternions.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


def integral(values: np.ndarray, times: np.ndarray) -> np.ndarray:
    middles = 0.5 * (values[1:] + values[:-1])
    found: np.ndarray = (middles * np.diff(times)[:, None]).sum(axis=0)
    return found


@pytest.mark.parametrize("player", PLAYERS)
def test_velocities_of_a_turned_robot_are_those_of_the_world(
    player: str, table: Table
) -> None:
    """Velocities integrate to ways in the world, whatever the heading."""
    times = table.columns["time_s"]
    late = times > 1.0
    for place, velocity, parts in (
        ("base_link", "torso_velocity", "xyz"),
        ("com", "velocity", "xy"),
    ):
        way = table.of(f"{player}/{place}", *(f"{p}_m" for p in parts))[late]
        rate = table.of(f"{player}/{velocity}", *(f"{p}_m_s" for p in parts))
        passed = integral(rate[late], times[late])
        np.testing.assert_allclose(passed, way[-1] - way[0], atol=0.005)
        assert hypot(*passed[:2]) > 0.1
    if player == "evader":  # it looks back and walks backward: away
        assert passed[0] > 0.1


@pytest.mark.parametrize("player", PLAYERS)
def test_the_dcm_is_ahead_of_the_com_by_its_velocity(
    player: str, table: Table
) -> None:
    com = table.of(f"{player}/com", "x_m", "y_m")
    velocity = table.of(f"{player}/velocity", "x_m_s", "y_m_s")
    dcm = table.of(f"{player}/dcm", "x_m", "y_m")
    eta = sa.GaitSettings().eta
    np.testing.assert_allclose(dcm, com + velocity / eta, atol=1e-6)


@pytest.mark.parametrize("player", PLAYERS)
def test_the_imu_measures_in_the_torso(player: str, table: Table) -> None:
    """Turned into the world, gravity is up and the gyro's turn is true."""
    times = table.columns["time_s"]
    late = times > 1.0
    turn = axes(table.of(f"{player}/base_link", "qw", "qx", "qy", "qz"))
    gyro = table.of(f"{player}/gyro", *(f"{p}_rad_s" for p in "xyz"))
    force = table.of(f"{player}/accelerometer", *(f"{p}_m_s2" for p in "xyz"))
    mean = np.einsum("nij,nj->ni", turn, force)[late].mean(axis=0)
    np.testing.assert_allclose(mean, [0.0, 0.0, GRAVITY], atol=0.15)
    # The rate in the body is that of R' dR/dt.
    middle = 0.5 * (turn[1:] + turn[:-1])
    change = np.diff(turn, axis=0) / np.diff(times)[:, None, None]
    spin = np.einsum("nji,njk->nik", middle, change)
    body = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
    about = table.of(
        f"{player}/torso_velocity", *(f"about_{p}_rad_s" for p in "xyz")
    )
    for measured in (gyro, about):
        both = 0.5 * (measured[1:] + measured[:-1])
        for axis in range(3):
            pair = body[late[1:], axis], both[late[1:], axis]
            assert np.corrcoef(*pair)[0, 1] > 0.8
            assert np.std(pair[0]) == pytest.approx(np.std(pair[1]), rel=0.3)


def test_the_first_sample_of_the_imu_is_gravity(table: Table) -> None:
    force = table.columns["evader/accelerometer/z_m_s2"]
    assert force[0] == pytest.approx(GRAVITY, abs=0.5)


@pytest.mark.parametrize("player", PLAYERS)
def test_references_and_footsteps_are_in_the_world(
    player: str, table: Table, folder: Path
) -> None:
    com = table.of(f"{player}/com", "x_m", "y_m")
    planned = table.of(f"{player}/com_reference", "x_m", "y_m")
    off = np.hypot(*(com - planned).T)
    assert np.nanmax(off) < 0.03
    tables = folder.with_name("csv.csv")
    feet = {}
    for kind in ("planned", "landed"):
        name = f"{player}-footsteps-{kind}.csv"
        with (tables / name).open(newline="") as stream:
            names, *rows = csv.reader(stream)
        assert names == ["time_s", "side", "x_m", "y_m", "heading_rad"]
        feet[kind] = np.array(rows, dtype=float)
    assert len(feet["landed"]) >= 5
    times, place = table.columns["time_s"], f"{player}/place"
    for time, side, x, y, _ in feet["landed"]:
        row = int(np.searchsorted(times, time - 1e-9))
        px, py, heading = table.of(place, "x_m", "y_m", "heading_rad")[row]
        left = cos(heading) * (y - py) - sin(heading) * (x - px)
        assert 0.02 < side * left < 0.08  # a foot beside the middle
    number = len(feet["landed"])
    apart = feet["landed"][:, 2:4] - feet["planned"][:number, 2:4]
    assert np.hypot(*apart.T).max() < 0.02


def test_distance_and_angle_follow_from_the_places(table: Table) -> None:
    one, two = (
        table.of(f"{p}/place", "x_m", "y_m", "heading_rad") for p in PLAYERS
    )
    apart = np.hypot(*(two - one)[:, :2].T)
    np.testing.assert_allclose(table.columns["distance/m"], apart, atol=1e-9)
    assert apart[0] == pytest.approx(0.75, abs=1e-3)
    turn = two[:, 2] - one[:, 2]
    angle = np.abs(np.arctan2(np.sin(turn), np.cos(turn)))
    found = table.columns["angle_between_headings/rad"]
    np.testing.assert_allclose(found, angle, atol=1e-9)


def test_frames_of_a_bag_are_those_of_ros(
    bag: dict[str, list[tuple[float, Any]]], table: Table
) -> None:
    """Odometry begins at the player; below it the way is in its axes."""
    row = len(bag["/tf"]) - 1
    time, message = bag["/tf"][row]
    assert time == pytest.approx(table.columns["time_s"][row], abs=1e-6)
    given = [*bag["/tf_static"][0][1].transforms, *message.transforms]
    frames = {each.child_frame_id: each for each in given}
    for player in PLAYERS:
        places = table.of(f"{player}/place", "x_m", "y_m", "heading_rad")
        first, last = places[0], places[row]
        odometry = frames[f"{player}/odom"]
        assert odometry.header.frame_id == "map"
        np.testing.assert_allclose(planar(odometry), first, atol=1e-6)
        foot = frames[f"{player}/base_footprint"]
        assert foot.header.frame_id == f"{player}/odom"
        dx, dy, turn = last - first
        c, s = cos(first[2]), sin(first[2])
        own = c * dx + s * dy, c * dy - s * dx, turn
        np.testing.assert_allclose(planar(foot), own, atol=1e-6)
        sign = 1.0 if player == "pursuer" else -1.0
        assert sign * planar(foot)[0] > 0.05
        torso = frames[f"{player}/base_link"]
        assert torso.header.frame_id == f"{player}/base_footprint"
        move = torso.transform.translation
        c, s = cos(last[2]), sin(last[2])
        x, y = c * move.x - s * move.y, s * move.x + c * move.y
        base = table.of(f"{player}/base_link", "x_m", "y_m", "z_m")[row]
        np.testing.assert_allclose((last[0] + x, last[1] + y, move.z), base)
        knee = frames[f"{player}/r_tibia"].transform.rotation
        bend = table.columns[f"{player}/joint_position/RKneePitch_rad"][row]
        assert 2.0 * np.arctan2(knee.y, knee.w) == pytest.approx(bend)
        pose = bag[f"/{player}/pose"][row][1]
        assert pose.header.frame_id == "map"
        np.testing.assert_allclose(
            (pose.pose.position.x, pose.pose.position.y), last[:2], atol=1e-9
        )


def planar(transform: Any) -> tuple[float, float, float]:
    """Place and heading of a transform message."""
    move, turn = transform.transform.translation, transform.transform.rotation
    return move.x, move.y, 2.0 * float(np.arctan2(turn.z, turn.w))


def test_signals_of_a_bag_are_those_of_the_tables(
    bag: dict[str, list[tuple[float, Any]]], table: Table
) -> None:
    row = 200
    for topic, column in (
        ("/distance_m", "distance/m"),
        ("/angle_rad", "angle_between_headings/rad"),
    ):
        value = bag[topic][row][1].data
        assert value == pytest.approx(table.columns[column][row])
    for player in PLAYERS:
        point = bag[f"/{player}/com"][row][1]
        assert point.header.frame_id == "map"
        place = point.pose.position
        com = table.of(f"{player}/com", "x_m", "y_m", "z_m")[row]
        np.testing.assert_allclose((place.x, place.y, place.z), com)
        state = bag[f"/{player}/joint_states"][row][1]
        for kind, unit, values in (
            ("position", "rad", state.position),
            ("velocity", "rad_s", state.velocity),
            ("effort", "n_m", state.effort),
        ):
            names = (f"joint_{kind}/{name}_{unit}" for name in state.name)
            found = [table.columns[f"{player}/{name}"][row] for name in names]
            assert found == list(values)
        imu = bag[f"/{player}/imu"][row][1]
        assert imu.header.frame_id == f"{player}/imu_link"
        assert imu.orientation_covariance[0] == -1.0  # none, says ROS
        gyro = table.of(f"{player}/gyro", *(f"{p}_rad_s" for p in "xyz"))[row]
        rate = imu.angular_velocity
        np.testing.assert_allclose((rate.x, rate.y, rate.z), gyro)
        wrenches = [
            m.wrench
            for sole in ("l_sole", "r_sole")
            for _, m in bag[f"/{player}/{sole}/wrench"]
        ]
        load = sum(w.force.z for w in wrenches)
        weight = GRAVITY * sa.load_tree(sa.load_robot("nao")).mass
        samples = len(bag[f"/{player}/imu"])
        assert load / samples == pytest.approx(weight, rel=0.05)
        # The centre of pressure is that much ahead of the ankles.
        ahead = -sum(w.torque.y for w in wrenches) / load
        gait = sa.GaitSettings()
        assert ahead == pytest.approx(gait.zmp_forward, abs=0.01)


def test_mujoco_reads_the_model_with_its_masses_and_ranges(
    folder: Path,
) -> None:
    import mujoco

    files = export_run(folder, "urdf", folder.with_name("urdf"))
    model = mujoco.MjModel.from_xml_path(str(files / "evader.urdf"))
    data = mujoco.MjData(model)
    nao = sa.load_robot("nao")
    tree = sa.load_tree(nao)
    bent = {"LHipPitch": -0.4, "RKneePitch": 0.8, "LAnkleRoll": 0.2}
    bent |= {"HeadYaw": 0.5, "RShoulderPitch": 1.0}
    own = nao.compile()
    posture = mujoco.MjData(own)
    for name, angle in bent.items():
        data.joint(name).qpos = posture.joint(name).qpos = angle
    mujoco.mj_forward(model, data)
    mujoco.mj_forward(own, posture)
    com = posture.subtree_com[0] - posture.body(nao.torso).xpos
    # MuJoCo leaves out what is fixed to the world, here the torso.
    root = ElementTree.parse(files / "evader.urdf").getroot()
    torso = root.find("link[@name='torso']/inertial")
    assert torso is not None
    weight, place = torso.find("mass"), torso.find("origin")
    assert weight is not None and place is not None
    own_mass = float(weight.attrib["value"])
    own_place = np.array(place.attrib["xyz"].split(), float)
    moving = model.body_mass.sum()
    assert own_mass + moving == pytest.approx(tree.mass, rel=1e-6)
    total = own_mass * own_place + moving * data.subtree_com[0]
    np.testing.assert_allclose(total / tree.mass, com, atol=1e-6)
    for name in tree.joints:
        np.testing.assert_allclose(
            model.joint(name).range, own.joint(name).range, atol=1e-6
        )


def test_a_page_from_disk_holds_the_run(
    folder: Path, run: Any, tmp_path: Path
) -> None:
    text = write_page_of(folder, tmp_path / "page.html").read_text("utf-8")
    assert not re.search(r'(src|href)="https?:', text)
    (found,) = re.findall(r"(\{\"times\".*\})", text)
    page = json.loads(found)
    times = np.array(page["times"])
    rows = np.searchsorted(run.times, times - 1e-6)
    np.testing.assert_allclose(times, run.times[rows], atol=1e-9)
    np.testing.assert_allclose(page["distance"], run.distance[rows], atol=2e-3)
    raw = np.frombuffer(b64decode(page["positions"]), "<f4")
    bodies = raw.reshape(len(times), -1, 3)
    raw = np.frombuffer(b64decode(page["quaternions"]), "<i2")
    turns = raw.reshape(len(times), -1, 4) / 32767.0
    listed = list(page["bodies"])
    for player in page["players"]:
        torso = run.tracks[player["name"]].qpos[rows, :3]
        shown = bodies[:, listed.index(player["torso"])]
        np.testing.assert_allclose(shown, torso, atol=1e-5)
        turn = turns[:, listed.index(player["torso"])]
        quaternion = run.tracks[player["name"]].qpos[rows, 3:7]
        np.testing.assert_allclose(turn, quaternion, atol=1e-4)


def test_a_film_shows_the_duel(folder: Path, tmp_path: Path) -> None:
    av = pytest.importorskip("av")
    film = film_run(
        folder, tmp_path / "film.mp4", 160, 120, rate=1, seconds=3.5
    )
    with av.open(str(film)) as container:
        stream = container.streams.video[0]
        frames = [
            f.to_ndarray(format="rgb24") for f in container.decode(stream)
        ]
        assert stream.average_rate == 1
    assert len(frames) == 4 and frames[0].shape == (120, 160, 3)
    first, last = (f.astype(int) for f in (frames[0], frames[-1]))
    assert np.abs(last - first).max() > 60  # it moves
    for frame in (first, last):
        red, green, blue = frame.transpose(2, 0, 1)
        assert ((red - blue > 60) & (red - green > 60)).sum() > 20
        assert (blue - red > 60).sum() > 20


def test_a_comparison_draws_the_paths_to_scale(
    folder: Path, run: Any, tmp_path: Path
) -> None:
    figure = draw_comparison(tmp_path / "runs.svg", folder, folder)
    text = figure.read_text(encoding="utf-8")
    lines = [
        np.array([p.split() for p in re.findall(r"[ML] (\S+ \S+)", d)], float)
        for d in re.findall(r'd="(M[^"]*)"', text)
    ]
    drawn = [line for line in lines if len(line) > 60][:2]
    ends = np.array([p for line in drawn for p in (line[0], line[-1])])
    places = np.array(
        [run.tracks[n].torso[i, :2] for n in PLAYERS for i in (0, -1)]
    )
    # One scale for both axes, up is up.
    scale = np.ptp(ends[:, 0]) / np.ptp(places[:, 0])
    expected = scale * (places - places[0]) * [1.0, -1.0]
    np.testing.assert_allclose(ends - ends[0], expected, atol=0.5)


def test_the_figure_of_a_saved_run_is_drawn_again(
    folder: Path, tmp_path: Path
) -> None:
    assert draw_saved_run(folder, tmp_path / "again.png").stat().st_size > 0
