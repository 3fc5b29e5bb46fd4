"""Test exported runs with readers that are not ours."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.poses import Array
from stepaside.games.game_settings import StartSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.run_archive import load_run, write_run_files
from stepaside.robots.description import load_robot


class Bag(NamedTuple):
    """Messages of a bag.

    Attributes:
        folder: Folder of the bag.
        topics: Times, in [s], and messages, by topic.
    """

    folder: Path
    topics: dict[str, list[tuple[float, Any]]]


def export(run: Path, name: str, *words: str) -> Path:
    """Export a run by the command line; return the folder."""
    folder = run.with_name(f"{run.name}.{name}")
    words = ("show", str(run), "-o", str(folder), *words)
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run folder of a duel of 3 s; the evader begins to walk at once."""
    start = StartSettings(distance=0.75, pursuer_offset=0.3, evader_offset=0.2)
    run = run_game(duel(duration=3.0, start=start))
    folder = tmp_path_factory.mktemp("export") / "duel"
    folder.mkdir()
    write_run_files(folder, run)
    return folder


@pytest.fixture(scope="module")
def run(folder: Path) -> Run:
    return load_run(folder)


@pytest.fixture(scope="module")
def bag(folder: Path) -> Bag:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    decoder = pytest.importorskip(
        "mcap_ros2.decoder", reason="mcap-ros2-support is not installed"
    )
    from mcap.reader import make_reader

    exported = export(folder, "mcap")
    topics: dict[str, list[tuple[float, Any]]] = {}
    with (exported / "duel.mcap").open("rb") as stream:
        reader = make_reader(
            stream, decoder_factories=[decoder.DecoderFactory()]
        )
        for _, channel, record, message in reader.iter_decoded_messages():
            entry = (1e-9 * record.log_time, message)
            topics.setdefault(channel.topic, []).append(entry)
    return Bag(exported, topics)


def points(message: Any) -> Array:
    """Return the points of a cloud. Shape (n, 3)."""
    rows = np.frombuffer(bytes(message.data), "<f4").reshape(-1, 3)
    return rows.astype(np.float64)


def matrix(transform: Any) -> Array:
    """Return the 4 by 4 matrix of a transform message."""
    t, q = transform.translation, transform.rotation
    axes = np.zeros(9)
    mujoco.mju_quat2Mat(axes, np.array([q.w, q.x, q.y, q.z]))
    found = np.eye(4)
    found[:3, :3] = axes.reshape(3, 3)
    found[:3, 3] = t.x, t.y, t.z
    return found


def poses_in_map(bag: Bag, index: int) -> dict[str, Array]:
    """Return the poses of all frames at a sample, by walking the tree."""
    above: dict[str, tuple[str, Array]] = {}
    for topic, number in (("/tf_static", 0), ("/tf", index)):
        for each in bag.topics[topic][number][1].transforms:
            assert each.child_frame_id not in above
            above[each.child_frame_id] = (
                each.header.frame_id,
                matrix(each.transform),
            )
    found: dict[str, Array] = {"map": np.eye(4)}

    def pose(frame: str) -> Array:
        if frame not in found:
            parent, step = above[frame]
            found[frame] = pose(parent) @ step
        return found[frame]

    for frame in above:
        pose(frame)
    return found


@pytest.mark.parametrize("index", [0, 100, -1])
def test_every_link_is_where_mujoco_puts_it(
    bag: Bag, run: Run, index: int
) -> None:
    model = load_robot("nao").compile()
    data = mujoco.MjData(model)
    poses = poses_in_map(bag, index)
    for name in run.players:
        qpos = run.tracks[name].qpos
        assert qpos is not None
        data.qpos[:] = qpos[index]
        data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
        mujoco.mj_kinematics(model, data)
        for body in range(1, model.nbody):
            own = data.body(body)
            expected = np.column_stack([own.xmat.reshape(3, 3), own.xpos])
            found = poses[f"{name}/{model.body(body).name}"][:3]
            np.testing.assert_allclose(found, expected, atol=2e-6)
        sole = data.site("r_sole_center")
        found = poses[f"{name}/r_sole"][:3]
        np.testing.assert_allclose(found[:, 3], sole.xpos, atol=2e-6)


def test_the_zmp_follows_from_the_wrenches_of_the_soles(
    bag: Bag, run: Run
) -> None:
    """Moments about the soles' frames give the recorded ZMP again."""
    zmp = run.evader.zmp
    assert zmp is not None
    for index in (10, 70, 120):
        poses = poses_in_map(bag, index)
        force, moment = 0.0, np.zeros(2)
        for side in "lr":
            pose = poses[f"evader/{side}_sole"]
            wrench = bag.topics[f"/evader/{side}_sole/wrench"][index][1].wrench
            up = wrench.force.z
            local = np.array([-wrench.torque.y, wrench.torque.x, 0.0])
            force += up
            moment += up * pose[:2, 3] + (pose[:3, :3] @ local)[:2]
        np.testing.assert_allclose(moment / force, zmp[index], atol=2e-3)


def test_without_a_repeated_game_channels_are_absent_and_said_to_be(
    folder: Path,
) -> None:
    output = folder.with_name("recorded.csv")
    words = ["show", str(folder), "-o", str(output), "--no-repeat", "--json"]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    plain = json.loads(result.stdout)
    assert "IMU" in plain["files"][str(output)]["absent"][0]
    header = (output / "samples.csv").read_text()
    columns = header.partition("\n")[0].split(",")
    assert "evader/com/x_m" in columns
    assert not any("effort" in column for column in columns)


def test_an_incomplete_run_is_refused_and_leaves_nothing(
    folder: Path, tmp_path: Path
) -> None:
    broken = tmp_path / "broken"
    broken.mkdir()
    for name in ("configuration.toml", "summary.json"):
        (broken / name).write_bytes((folder / name).read_bytes())
    words = ["show", str(broken), "-o", f"{tmp_path}/x.csv"]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 2 and "trajectories.npz" in result.stderr
    assert list(tmp_path.iterdir()) == [broken]
