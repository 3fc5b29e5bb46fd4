"""Test formats whose libraries are large: ``make test-export`` has them."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.games.duel import run_duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.run import Run
from stepaside.games.run_archive import load_run, write_run_files
from stepaside.robots.urdf_elements import BASE


def export(run: Path, name: str) -> Path:
    """Export a run by the command line; return the folder."""
    folder = run.with_name(f"{run.name}-{name}")
    words = ["export", str(run), "--to", name]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run folder of a duel of 3 s with cameras, in rays."""
    pytest.importorskip("cv2", reason="OpenCV is not installed")
    from stepaside.sim.camera_settings import CameraSettings, ColourSettings

    settings = DuelSettings(
        duration=3.0,
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
