"""Test what is derived from a model as a vendor publishes it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from click.testing import CliRunner

import vendor_humanoid as stranger
from stepaside.cli.main import main
from stepaside.fitting import derivation
from stepaside.fitting.derivation import DerivedDescription, derive
from stepaside.fitting.description_writer import write_description
from stepaside.fitting.gait_feasibility import RobotSize, gait_of, game_of_size
from stepaside.fitting.motor_data import (
    LEAST_STIFFNESS,
    SATURATION_ANGLE,
    STIFFNESS,
    gains_of,
)
from stepaside.games import duel, run_game
from stepaside.games.game_settings import read_game
from stepaside.games.player_settings import settings_from_description
from stepaside.robots.description import FILE, RobotDescription, load_robot
from stepaside.robots.tree_compiler import compile_tree
from stepaside.sim.ground_truth import TrueRobotState

PUBLISHERS: dict[str, Callable[[Path], Path]] = {
    "mjcf": stranger.mjcf,
    "urdf": stranger.urdf,
}
Described = tuple[DerivedDescription, RobotDescription]


def described(model: Path, folder: Path) -> Described:
    """Derive a description, write it, and read it again."""
    folder.mkdir(exist_ok=True)
    found = derive(model, folder, [])
    (folder / FILE).write_text(write_description(found), encoding="utf-8")
    return found, load_robot(folder)


@pytest.fixture(scope="module")
def strangers(
    tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, Described]:
    """The same robot, from each kind of model."""
    return {
        kind: described(
            publish(tmp_path_factory.mktemp(kind)),
            tmp_path_factory.mktemp(kind) / "robot",
        )
        for kind, publish in PUBLISHERS.items()
    }


@pytest.mark.parametrize("kind", PUBLISHERS)
def test_legs_and_soles_are_found_in_the_tree(
    kind: str, strangers: dict[str, Described]
) -> None:
    found = strangers[kind][0].analysis
    left, right = found.legs
    assert left.joints == tuple(f"near_{part[0]}" for part in stranger.LEG)
    assert right.joints == tuple(f"far_{part[0]}" for part in stranger.LEG)
    assert left.pitches == ("near_swing", "near_bend", "near_tip")
    back, front, half = stranger.SOLE
    assert left.outline == pytest.approx((back, front, -half, half))
    assert left.hip[0] == pytest.approx(stranger.HIPS)
    down = 0.08 + 0.04 + stranger.THIGH + stranger.SHANK
    assert left.sole == pytest.approx(-down - stranger.FOOT)


@pytest.mark.parametrize("kind", PUBLISHERS)
def test_the_written_description_equals_the_derived_one(
    kind: str, tmp_path: Path
) -> None:
    model = PUBLISHERS[kind](tmp_path)
    before = model.read_bytes()
    found, robot = described(model, tmp_path / "robot")
    assert model.read_bytes() == before
    own = found.description
    assert robot.legs == own.legs and robot.standing == own.standing
    assert robot.overlay == own.overlay and robot.place == own.place
    assert robot.gait == own.gait and robot.control == own.control
    gait = settings_from_description(robot).gait
    assert gait.com_height == pytest.approx(found.size.com_height, abs=1e-4)
    assert gait.sole.front == pytest.approx(stranger.SOLE[1])


@pytest.mark.parametrize("kind", PUBLISHERS)
def test_the_overlay_lets_any_model_be_controlled(
    kind: str, strangers: dict[str, Described]
) -> None:
    _, robot = strangers[kind]
    model = robot.compile()
    free = int(mujoco.mjtJoint.mjJNT_FREE)
    assert model.jnt_type[model.body("chest").jntadr[0]] == free
    assert model.nu == 12 and model.nsensor == 10
    torques = model.actuator_forcerange[:, 1]
    np.testing.assert_allclose(torques, stranger.TORQUE)
    tree = compile_tree(robot)
    assert tree.mass == pytest.approx(12.0 + 2 * 6.6)
    assert all(servo.stiffness > 1000.0 for servo in tree.servos)
    names = {model.geom(i).name for i in range(model.ngeom)}
    assert "floor" not in names
    assert {f"{robot.left_foot}_box", f"{robot.right_foot}_box"} <= names


def test_the_damping_of_a_joint_becomes_that_of_its_servo(
    strangers: dict[str, Described],
) -> None:
    """It leads its targets by all of it, or the joints would lag."""
    found, robot = strangers["mjcf"]
    model = robot.compile()
    assert found.analysis.model.dof_damping.max() == 0.8
    assert not model.dof_damping.any()
    assert (-model.actuator_biasprm[:, 2] > 0.8).all()


def test_a_weak_servo_is_no_stiffer_than_its_torque_allows(
    strangers: dict[str, Described],
) -> None:
    """One that is at its limit after a small error holds nothing."""
    found = strangers["mjcf"][0].analysis
    height = 0.7
    tipping = found.mass * 9.81 * height
    leg = found.legs[0].joints
    for torque, stiffness in (
        (1e4, STIFFNESS * tipping),
        (5.0 * tipping * SATURATION_ANGLE, 5.0 * tipping),
        (1.0, LEAST_STIFFNESS * tipping),
    ):
        torques = dict.fromkeys(leg, torque)
        gains = gains_of(found, torques, height, weak=True)
        for name in leg:
            assert gains[name].stiffness == pytest.approx(stiffness, rel=0.01)
            assert gains[name].torque == pytest.approx(torque, rel=0.01)
        stiff = gains_of(found, torques, height)
        assert stiff[leg[0]].stiffness == pytest.approx(
            STIFFNESS * tipping, rel=0.01
        )


def test_the_place_of_a_torso_is_midway_between_its_hips(
    strangers: dict[str, Described],
) -> None:
    _, robot = strangers["mjcf"]
    assert robot.place.forward == pytest.approx(stranger.HIPS)
    model = robot.compile()
    data = mujoco.MjData(model)
    half_turn = (np.cos(0.4), 0.0, 0.0, np.sin(0.4))  # heading 0.8 rad
    data.qpos[:7] = (3.0, -1.0, 0.9, *half_turn)
    mujoco.mj_kinematics(model, data)
    state = TrueRobotState(model, data, "chest", place=robot.place)
    hips = [data.body(f"{s}_spin_link").xpos[:2] for s, _ in stranger.SIDES]
    np.testing.assert_allclose(
        state.position_torso_in_world, np.mean(hips, axis=0)
    )


def test_an_invalid_model_is_refused_in_one_line(tmp_path: Path) -> None:
    file = tmp_path / "nothing.xml"
    file.write_text("<mujoco><worldbody/></mujoco>")
    result = CliRunner().invoke(main, ["robot", "init", str(file)])
    assert result.exit_code == 2
    assert "has no body" in result.stderr
    assert result.stderr.count("\n") == 1


def test_a_joint_whose_range_lets_no_robot_stand_is_named(
    tmp_path: Path,
) -> None:
    model = stranger.mjcf(tmp_path)
    text = model.read_text().replace('range="-1.0 1.0"', 'range="0.1 0.9"')
    model.write_text(text)
    said = CliRunner().invoke(main, ["robot", "init", str(model)]).stderr
    assert "reaches no height" in said and said.count("\n") == 1
    assert "'near_tip' at 0.10 rad (0.10 to 0.90)" in said


def test_equal_shapes_walk_alike() -> None:
    """Lengths go with the CoM's height, times with the root of it."""
    sole = (-0.05, 0.1, 0.04, 0.04)
    small = RobotSize(0.3, 5.0, 0.1, sole, 0.2)
    times = 4.0
    large = RobotSize(0.3 * times, 320.0, 0.4, tuple(4 * e for e in sole), 0.8)  # type: ignore[arg-type]
    one, other = gait_of(small), gait_of(large)
    for name in ("stride", "step_height", "com_height", "foot_spacing"):
        assert other[name] == pytest.approx(times * one[name], rel=0.01)
    for name in ("single_support", "double_support", "start_support"):
        assert other[name] == pytest.approx(2.0 * one[name], rel=0.01)
    assert other["gain"] == pytest.approx(0.5 * one["gain"], rel=0.01)
    near, far = game_of_size(small, one), game_of_size(large, other)
    for name in ("safety_radius", "start_near", "start_far", "start_least"):
        expected = times * getattr(near, name)
        assert getattr(far, name) == pytest.approx(expected, rel=0.01)
    wide = game_of_size(replace(small, reach=2.0), one)
    assert wide.start_least == pytest.approx(4.0)  # or they would touch
    assert wide.start_least < wide.start_near < wide.safety_radius


def test_a_robot_of_other_size_plays_by_its_own_distances(
    tmp_path: Path,
) -> None:
    """NAO scaled by 1.7: nothing of NAO's is left but its shape."""
    nao = load_robot("nao")
    spec = mujoco.MjSpec.from_file(str(nao.folder / nao.model))
    scale = 1.7
    for body in spec.bodies:
        body.pos *= scale
        body.ipos *= scale
        body.mass *= scale**3
        body.inertia *= scale**5
        body.fullinertia *= scale**5
    for part in (*spec.geoms, *spec.sites):
        part.pos *= scale
        part.size *= scale
    for joint in spec.joints:
        joint.pos *= scale
    for actuator in spec.actuators:
        actuator.forcerange *= scale**4
    spec.compile()
    model = tmp_path / "large.xml"
    model.write_text(spec.to_xml())
    found, robot = described(model, tmp_path / "robot")
    gait = settings_from_description(robot).gait
    assert gait.com_height == pytest.approx(scale * 0.268, rel=0.02)
    assert gait.foot_spacing == pytest.approx(scale * 0.1, rel=0.05)
    assert found.description.legs[0] == "LHipYawPitch"
    settings = read_game(
        {"robot": str(robot.folder)}, base=duel(seed=3, duration=6.0)
    )
    assert settings.evader.evasion.safety_radius > 1.2
    assert settings.start.near > 0.9
    run = run_game(settings)
    assert run.outcome.value == "completed", run.message
    assert run.distance[0] >= settings.start.near - 1e-3


@pytest.mark.slow
def test_weak_ankles_get_a_gentler_gait(tmp_path: Path) -> None:
    """The ZMP is nearer to them, servos give way, and feedback holds."""
    model = stranger.mjcf(tmp_path)
    text = model.read_text()
    for side, _ in stranger.SIDES:
        ankle = f'joint="{side}_tip" gear="30" ctrlrange="-3.0 3.0"'
        assert ankle in text
        text = text.replace(ankle, ankle.replace("3.0", "0.2"))
    model.write_text(text)
    found, robot = described(model, tmp_path / "robot")
    assert found.zmp_offset < 1.0 and found.is_weak
    back, front, *_ = stranger.SOLE
    ahead = 0.45 * (front + back)
    assert robot.gait["zmp_forward"] == pytest.approx(
        found.zmp_offset * ahead, abs=1e-4
    )
    assert robot.control["feedback"] is True
    servos = robot.overlay.servos
    assert servos["near_tip"].stiffness < servos["near_bend"].stiffness
    assert "for the ankle torques" in write_description(found)


def test_a_lower_com_is_tried_down_to_the_lowest_in_reach(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of legs that are the faster the more they are bent."""
    monkeypatch.setattr(derivation, "with_gait", lambda _, gait: (gait,))
    monkeypatch.setattr(
        derivation, "feasible_lengths", lambda gait: -10 * gait["com_height"]
    )
    size = RobotSize(0.5, 5.0, 0.1, (-0.05, 0.1, 0.04, 0.04), 0.2)
    found, lengths = derivation.choose_com_height(
        load_robot("nao"), size, 0.455
    )
    assert 0.455 <= found.com_height < 0.465
    assert lengths == pytest.approx(-10 * found.com_height)
