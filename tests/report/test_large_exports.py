"""Test formats whose libraries are large: ``make test-export`` has them."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.spatial.transform import Rotation

from stepaside.cli.main import main
from stepaside.games.duel import run_duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.run import Run
from stepaside.games.run_archive import load_run, write_run_files
from stepaside.games.walk_game import run_walk
from stepaside.games.walk_settings import WalkSettings
from stepaside.robots.urdf_elements import BASE


def export(run: Path, name: str) -> Path:
    """Export a run by the command line, once; return the folder."""
    folder = run.with_name(f"{run.name}-{name}")
    if folder.exists():
        return folder
    words = ["export", str(run), "--to", name]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run folder of a duel of 1.6 s with cameras, in rays."""
    pytest.importorskip("cv2", reason="OpenCV is not installed")
    from stepaside.sim.camera_settings import CameraSettings, ColourSettings

    settings = DuelSettings(
        duration=1.6,
        start=StartSettings(
            distance=0.75, pursuer_offset=0.3, evader_offset=0.2
        ),
        sensing="cameras",
        cameras=CameraSettings(colour=ColourSettings(renderer="raycast")),
    )
    folder = tmp_path_factory.mktemp("large") / "duel"
    folder.mkdir()
    write_run_files(folder, run_duel(settings))
    return folder


@pytest.fixture(scope="module")
def run(folder: Path) -> Run:
    return load_run(folder)


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run folder of a walk of 3 s."""
    folder = tmp_path_factory.mktemp("large") / "walk"
    folder.mkdir()
    write_run_files(folder, run_walk(WalkSettings(duration=3.0)))
    return folder


def bag_of(folder: Path) -> dict[str, list[Any]]:
    """Messages of an exported bag, by topic, read by mcap-ros2-support."""
    decoder = pytest.importorskip(
        "mcap_ros2.decoder", reason="mcap-ros2-support is not installed"
    )
    from mcap.reader import make_reader

    file = export(folder, "mcap") / f"{folder.name}.mcap"
    found: dict[str, list[Any]] = {}
    with file.open("rb") as stream:
        factory = decoder.DecoderFactory()
        reader = make_reader(stream, decoder_factories=[factory])
        for _, channel, _, message in reader.iter_decoded_messages():
            found.setdefault(channel.topic, []).append(message)
    return found


def pose_in(tree: dict[str, Any], frame: str, root: str) -> Any:
    """Pose of a frame in a root, by walking the tree. Shape (4, 4)."""
    if frame == root:
        return np.eye(4)
    stamped = tree[frame]
    t, q = stamped.transform.translation, stamped.transform.rotation
    step = np.eye(4)
    turn = Rotation.from_quat([q.x, q.y, q.z, q.w])
    step[:3, :3] = turn.as_matrix()
    step[:3, 3] = t.x, t.y, t.z
    return pose_in(tree, stamped.header.frame_id, root) @ step


@pytest.mark.parametrize("kind", ["folder", "walk"])
def test_transforms_and_urdf_agree_in_programs_of_others(
    kind: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """A duel with cameras and a walk, at their last samples."""
    yourdfpy = pytest.importorskip(
        "yourdfpy", reason="yourdfpy is not installed"
    )
    folder: Path = request.getfixturevalue(kind)
    bag = bag_of(folder)
    run = load_run(folder)
    name = run.robots[0]
    urdf = tmp_path / "robot.urdf"
    urdf.write_text(bag[f"/{name}/robot_description"][0].data)
    robot = yourdfpy.URDF.load(str(urdf), load_meshes=False)
    state = bag[f"/{name}/joint_states"][-1]
    angles = dict(zip(state.name, state.position, strict=True))
    robot.update_cfg({n: angles[n] for n in robot.actuated_joint_names})
    messages = [bag["/tf_static"][0], bag["/tf"][-1]]
    tree = {
        each.child_frame_id: each
        for message in messages
        for each in message.transforms
    }
    for link in ("l_sole", "r_sole", "camera_optical_frame", "imu_link"):
        ours = pose_in(tree, f"{name}/{link}", f"{name}/{BASE}")
        theirs = robot.get_transform(link, BASE)
        # In physics a shared motor couples two joints to 0.03 mrad only.
        np.testing.assert_allclose(ours, theirs, atol=1e-4)


def test_images_travel_with_their_calibration(folder: Path) -> None:
    cv2 = pytest.importorskip("cv2", reason="OpenCV is not installed")
    bag = bag_of(folder)
    images = bag["/evader/camera/image_raw/compressed"]
    infos = bag["/evader/camera/camera_info"]
    assert len(images) == len(infos) > 20
    data = np.frombuffer(images[-1].data, np.uint8)
    height, width = cv2.imdecode(data, cv2.IMREAD_COLOR).shape[:2]
    assert (infos[-1].height, infos[-1].width) == (height, width)
    assert images[-1].header.frame_id == "evader/camera_optical_frame"


def test_rerun_reads_a_walk_back(walk: Path) -> None:
    rerun = pytest.importorskip("rerun", reason="Rerun is not installed")
    run = load_run(walk)
    (name,) = run.robots
    file = export(walk, "rerun") / "walk.rrd"
    with rerun.server.Server(datasets={"runs": [str(file)]}) as server:
        dataset = server.client().get_dataset("runs")
        base = f"/world/{name}/{BASE}"
        view = dataset.filter_contents([base])
        table = view.reader(index="time").to_pandas().sort_values("time")
    column = table[f"{base}:Transform3D:translation"].dropna()
    qpos = run.tracks[name].qpos
    assert qpos is not None
    found = np.stack([row[0] for row in column])
    np.testing.assert_allclose(found, qpos[:, :3], atol=1e-6)


def test_a_dataset_has_an_episode_for_each_robot(
    folder: Path, run: Run
) -> None:
    pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    av = pytest.importorskip("av", reason="PyAV is not installed")
    from pyarrow.parquet import read_schema, read_table

    root = export(folder, "lerobot")
    info = json.loads((root / "meta/info.json").read_text())
    frames = read_table(root / "data/chunk-000/file-000.parquet")
    camera = "observation.images.camera"
    assert {*frames.column_names, camera} == set(info["features"])
    assert frames.num_rows == info["total_frames"] == 2 * len(run.times)
    for key, feature in info["features"].items():
        if feature["shape"] != [1] and key != camera:
            assert [frames[key].type.list_size] == feature["shape"]
    count = len(run.times)
    [first, second] = read_table(
        root / "meta/episodes/chunk-000/file-000.parquet"
    ).to_pylist()
    assert (first["dataset_to_index"], second["length"]) == (count, count)
    qpos = run.evader.qpos
    assert qpos is not None

    def column(name: str) -> Any:
        rows = frames[name].to_pylist()
        return np.array(rows[second["dataset_from_index"] :])

    np.testing.assert_array_equal(column("observation.state"), qpos[:, 7:])
    sight = column("observation.environment_state")
    np.testing.assert_allclose(sight[:, 1], run.distance, rtol=1e-6)
    times = run.times - run.times[0]
    np.testing.assert_allclose(column("timestamp"), times, atol=1e-6)
    tasks = read_schema(root / "meta/tasks.parquet").pandas_metadata
    assert tasks["index_columns"] == ["task"]
    number = second[f"videos/{camera}/file_index"]
    video = info["video_path"].format(
        video_key=camera, chunk_index=0, file_index=number
    )
    with av.open(str(root / video)) as container:
        images = sum(1 for _ in container.decode(video=0))
    assert images == count


def test_statistics_are_those_of_all_frames(folder: Path, run: Run) -> None:
    pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    root = folder.with_name("duel-lerobot")
    stats = json.loads((root / "meta/stats.json").read_text())
    angles = [run.tracks[name].qpos for name in run.robots]
    both = np.concatenate([q[:, 7:] for q in angles if q is not None])
    found = stats["observation.state"]
    for name, values in (
        ("mean", both.astype(float).mean(0)),
        ("std", both.astype(float).std(0)),
        ("min", both.min(0)),
    ):
        np.testing.assert_allclose(found[name], values, atol=1e-6)
    assert found["count"] == [2 * len(run.times)]


def test_rerun_reads_poses_and_numbers_back(folder: Path, run: Run) -> None:
    rerun = pytest.importorskip("rerun", reason="Rerun is not installed")
    file = export(folder, "rerun") / "duel.rrd"
    with rerun.server.Server(datasets={"runs": [str(file)]}) as server:
        dataset = server.client().get_dataset("runs")
        base = f"/world/evader/{BASE}"
        view = dataset.filter_contents([base, "/signals/distance"])
        table = view.reader(index="time").to_pandas().sort_values("time")
    column = f"{base}:Transform3D:translation"
    known = table[column].notna()
    found = np.stack([row[0] for row in table[column][known]])
    qpos = run.evader.qpos
    assert qpos is not None
    np.testing.assert_allclose(found, qpos[:, :3], atol=1e-6)
    numbers = table["/signals/distance:Scalars:scalars"].dropna()
    distance = np.array([row[0] for row in numbers])
    np.testing.assert_allclose(distance, run.distance)
