"""Test formats whose libraries are large: ``make test-export`` has them."""

import re
import subprocess
import sys
from math import pi
from pathlib import Path
from shutil import which
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.spatial.transform import Rotation

from stepaside.arena import Disc, Room
from stepaside.cli.main import main
from stepaside.core.poses import Pose
from stepaside.games.game_settings import StartSettings, duel
from stepaside.games.game_settings import walk as make_walk
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.run_archive import load_run, write_run_files
from stepaside.robots.urdf_writer import BASE


def export(run: Path, name: str) -> Path:
    """Export a run by the command line, once; return the folder."""
    folder = run.with_name(f"{run.name}.{name}")
    if folder.exists():
        return folder
    words = ["show", str(run), "-o", f"{run}.{name}"]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run folder of a duel of 1.6 s with cameras, in rays."""
    pytest.importorskip("cv2", reason="OpenCV is not installed")
    from stepaside.sim.camera_settings import CameraSettings, ColourSettings

    settings = duel(
        duration=1.6,
        start=StartSettings(
            distance=0.75, pursuer_offset=0.3, evader_offset=0.2
        ),
        senses="cameras",
        cameras=CameraSettings(colour=ColourSettings(renderer="raycast")),
    )
    folder = tmp_path_factory.mktemp("large") / "duel"
    folder.mkdir()
    write_run_files(folder, run_game(settings))
    return folder


@pytest.fixture(scope="module")
def run(folder: Path) -> Run:
    return load_run(folder)


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Run folder of a walk of 3 s."""
    folder = tmp_path_factory.mktemp("large") / "walk"
    folder.mkdir()
    write_run_files(folder, run_game(make_walk(duration=3.0)))
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


DRAWN = {
    "/evader/com": "InstancePoses3D:translations",
    "/evader/zmp": "InstancePoses3D:translations",
    "/pursuer/footsteps/planned": "Points3D:positions",
    "/pursuer/footsteps/landed": "Points3D:positions",
    "/tf": "Transform3D:translation",
    "/evader/visual_geometries/": "Ellipsoids3D:half_sizes",
    "/pursuer/visual_geometries/": "Cylinders3D:lengths",
    "/room/visual_geometries/": "Cylinders3D:lengths",
}
"""What Rerun draws, by the beginning of its entity."""


def test_rerun_draws_robots_footsteps_room_com_and_zmp(tmp_path: Path) -> None:
    rerun = which("rerun", path=str(Path(sys.executable).parent))
    if rerun is None:
        pytest.skip("Rerun is not installed")
    settings = duel(
        duration=10.0,
        room=Room(
            obstacles=(Disc(0.6, 1.4, 0.1),),
            starts=(Pose(0.0, 0.0, 0.2), Pose(1.0, 0.0, pi)),
        ),
    )
    folder = tmp_path / "room"
    folder.mkdir()
    write_run_files(folder, run_game(settings))
    bag = export(folder, "mcap") / "room.mcap"
    target = tmp_path / "room.rrd"
    for words in (
        ["mcap", "convert", str(bag), "-o", str(target)],
        ["rrd", "print", str(target)],
    ):
        done = subprocess.run(
            [rerun, *words], capture_output=True, text=True, check=True
        )
    chunks = re.findall(
        r"^Chunk.* - (/\S*) - .*columns: \[(.*)\]$", done.stdout, re.MULTILINE
    )
    for entity, archetype in DRAWN.items():
        assert any(
            path.startswith(entity) and archetype in columns
            for path, columns in chunks
        ), entity
