"""What was once wrong with robots."""

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stepaside as sa
from flows.calls import stepaside
from legs_robot import nao_on_legs
from stepaside.fitting.robot_verification import PATHS, walk_trial
from stepaside.games.game import play
from stepaside.games.game_settings import read_game
from stepaside.robots.description import load_robot
from stepaside.robots.head import load_head

NAO = Path(sa.__file__).parent / "robots" / "nao"
IMU = '<site name="imu"'  # in the torso, 0.33 m above the floor
MAST = '<geom class="body" type="capsule" fromto="0 0 0 0 0 0.8" size="0.03"/>'
ARMS = '<geom class="body" type="box" pos="0.3 0 0.1" size="0.03 0.1 0.03"/>'
SHIN = 'size="0.017 0.026 0.040" material='  # the lowest trim


def changed_nao(folder: Path, file: str, *changes: tuple[str, str]) -> Path:
    """Write a NAO with other texts in one file of its description."""
    shutil.copytree(NAO, folder)
    text = (folder / file).read_text(encoding="utf-8")
    for old, new in changes:
        if old not in text:
            raise ValueError(f"{old} is not in {file}")
        text = text.replace(old, new)
    (folder / file).write_text(text, encoding="utf-8")
    return folder


def test_a_head_at_1_m_looks_down_at_a_person_nearby(tmp_path: Path) -> None:
    """From 1.1 m above the floor, a person at 0.8 m is below."""
    tall = changed_nao(
        tmp_path / "tall",
        "head.toml",
        ("[0.05871, 0.0, 0.06364]", "[0.05871, 0.0, 0.7]"),
        ("[0.03, 0.0, 0.145]", "[0.03, 0.0, 0.7]"),
    )
    stepaside(
        *("duel", "--robot", tall, "--sensing", "cameras", "--seed", 1),
        *("--pursuer", "person", "--set", "person.path=straight"),
        *("--set", "person.speed=0.6", "--set", "person.halt_after=1.2"),
        *("--strategy", "stand", "--distance", 2, "--duration", 2.6),
        *("--output", tmp_path / "run"),
    )
    run = sa.load_run(tmp_path / "run")
    assert run.evader.qpos is not None
    head_pitch = run.evader.qpos[-1, 8]  # [rad], positive downward
    assert 0.3 < head_pitch < 0.52


def test_trim_of_another_height_gives_the_right_distance(
    tmp_path: Path,
) -> None:
    """The lowest trim is on the thighs, 0.1 m higher than on the shins."""
    robot = changed_nao(
        tmp_path / "nao", "model.xml", (f'{SHIN}"accent"', f'{SHIN}"shell"')
    )
    summary = stepaside(
        *("duel", "--robot", robot, "--sensing", "cameras", "--json"),
        *(
            "--set",
            "cameras.colour.renderer=raycast",
            "--distance",
            1.5,
            "--duration",
            0.6,
        ),
        *("--set", "start.pursuer_offset=0", "--set", "start.evader_offset=0"),
    ).json
    errors = summary["players"]["pursuer"]["sight"]
    assert errors["distance_error_median_m"] < 0.1


def mapped(robot: Path, away: float, heights: tuple[float, float]) -> bool:
    """Let a robot map a thing between two heights; whether it is on the map.

    Args:
        robot: Folder of its description.
        away: Distance from the depth camera, in [m].
        heights: Lowest and highest point, in [m].
    """
    pytest.importorskip("cv2")
    from stepaside.perception.body_pose import camera_pose
    from stepaside.perception.floor_map import FloorMap
    from stepaside.perception.images import DepthImage
    from synthetic_cameras import CAMERA, TICK, Eyes

    description, floor = load_robot(str(robot)), FloorMap()
    head = load_head(description)
    eyes = Eyes(floor=floor, robot=description, head=head)
    eyes.see(0.0)
    body = eyes.perception.body
    assert body is not None
    eye = camera_pose(body, head.depth_cameras[0])
    rays = eye.rays(CAMERA)
    depths = away / np.hypot(rays[..., 0], rays[..., 1])
    above = eye.position_in_odometry[2] + depths * rays[..., 2]
    depths[(above < heights[0]) | (above > heights[1])] = 0.0
    image = DepthImage(0.0, CAMERA, depths.astype(np.float32), 0.1, 3.5)
    for tick in range(1, 4):
        eyes.see(tick * TICK, replace(image, time=tick * TICK))
    return len(floor.occupied_cells()) > 0


def of_robots(part: str) -> pytest.MarkDecorator:
    """Parametrize over a plain NAO and one with a part."""
    ids = ["NAO", "changed"]
    return pytest.mark.parametrize("part", ["", part], ids=ids)


@of_robots(MAST)
def test_a_beam_is_an_obstacle_of_higher_robots(
    part: str, tmp_path: Path
) -> None:
    robot = changed_nao(tmp_path / "nao", "model.xml", (IMU, part + IMU))
    assert mapped(robot, 1.0, (0.75, 0.9)) == bool(part)


@of_robots(ARMS)
def test_own_long_arms_are_no_obstacle(part: str, tmp_path: Path) -> None:
    robot = changed_nao(tmp_path / "nao", "model.xml", (IMU, part + IMU))
    assert mapped(robot, 0.25, (0.4, 0.46)) == (not part)


def test_velocities_of_a_hardware_body_are_those_of_its_encoders(
    tmp_path: Path,
) -> None:
    pytest.importorskip("onnxruntime")
    folder = nao_on_legs(tmp_path / "nao")
    settings = read_game({"robot": str(folder)}, base=sa.duel(duration=1.0))
    duel = sa.RecordedGame(replace(settings, body=sa.BODIES["hardware"]))
    play(duel)
    evader: Any = duel.in_physics.players[1]
    robot = evader.robot
    step, tick = sa.BODIES["hardware"].encoder_step, robot.tick
    before = robot.read().joint_positions
    duel.in_physics.step()
    read = robot.read()
    changed = read.joint_positions - before
    np.testing.assert_allclose(read.joint_velocities, changed / tick)
    steps = read.joint_velocities * tick / step
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-6)
    assert not np.isin(read.joint_velocities, duel.in_physics.data.qvel).all()


def test_walks_of_a_check_are_planned_on_learned_legs_too(
    tmp_path: Path,
) -> None:
    robot = load_robot(nao_on_legs(tmp_path / "nao"))
    walked = walk_trial(robot, PATHS[0], feedback=False)
    assert walked.lasted > 0.05 and "walker" in walked.message
    with pytest.raises(sa.StepAsideError, match="empty in a walk"):
        sa.walk(robot=str(robot.folder))
