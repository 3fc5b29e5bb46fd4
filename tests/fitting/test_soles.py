"""Test that feet and legs are found however they lie in the zero posture."""

import re
from collections.abc import Callable
from math import cos, sin
from pathlib import Path

import mujoco
import numpy as np
import pytest

import vendor_humanoid as stranger
from stepaside.core.errors import ModelError
from stepaside.fitting.derivation import derive
from stepaside.fitting.description_writer import write_description
from stepaside.fitting.model_analysis import (
    DetectedLeg,
    ModelAnalysis,
    analyse_model,
)
from stepaside.fitting.standing_posture import knee_limits, standing_of
from stepaside.robots.description import FILE, load_robot
from stepaside.robots.tree_compiler import compile_tree

BACK, FRONT, HALF = stranger.SOLE
OUTLINE = (BACK, FRONT, -HALF, HALF)
DOWN = 0.08 + 0.04 + stranger.THIGH + stranger.SHANK + stranger.FOOT
BOX = re.compile(r'<geom type="box" size="0.09 [^>]*>')


def edited(folder: Path, edit: Callable[[str], str]) -> Path:
    """The same robot, in a file that is written otherwise."""
    file = stranger.mjcf(folder)
    text = file.read_text()
    other = edit(text)
    assert other != text
    file.write_text(other)
    return file


def feet(file: Path) -> tuple[DetectedLeg, DetectedLeg]:
    return analyse_model(file, []).legs


def shaped(shape: str) -> Callable[[str], str]:
    """Feet of another shape, given in the frame under the ankle."""
    return lambda text: BOX.sub(shape, text)


def balls(pitch: float, radius: float = 0.012) -> str:
    """Four balls below a foot that points down by a pitch."""
    geoms = ""
    for x in (BACK, FRONT):
        for y in (-HALF, HALF):
            z = radius - stranger.FOOT
            a = x * cos(pitch) + z * sin(pitch)
            c = z * cos(pitch) - x * sin(pitch)
            geoms += f'<geom size="{radius}" pos="{a} {y} {c}"/>'
    return geoms


def tilted(roll: float, pitch: float) -> str:
    """A box that is turned about the ankle: roll, then pitch."""
    turn = np.zeros(4)
    mujoco.mju_euler2Quat(turn, np.array([0.0, pitch, roll]), "zyx")
    middle = np.zeros(3)
    half = 0.5 * (FRONT - BACK)
    mujoco.mju_rotVecQuat(
        middle, np.array([0.5 * (FRONT + BACK), 0.0, 0.01 - 0.05]), turn
    )
    x, y, z = middle.tolist()
    quat = " ".join(str(q) for q in turn.tolist())
    return (
        f'<geom type="box" size="{half} {HALF} 0.01" pos="{x} {y} {z}" '
        f'quat="{quat}"/>'
    )


@pytest.mark.parametrize(
    ("roll", "pitch"), [(0.0, 0.0), (0.0, 0.3), (0.0, -0.5), (0.15, 0.2)]
)
def test_a_sole_is_the_same_however_it_is_tilted(
    roll: float, pitch: float, tmp_path: Path
) -> None:
    if roll or pitch:
        file = edited(tmp_path, shaped(tilted(roll, pitch)))
    else:
        file = stranger.mjcf(tmp_path)
    for leg in feet(file):
        assert leg.outline == pytest.approx(OUTLINE, abs=1e-6)
        assert leg.sole == pytest.approx(-DOWN)
        up = np.array([sin(pitch) * cos(roll), -sin(roll)])
        np.testing.assert_allclose(leg.axes[:2, 2], up, atol=1e-6)


def level_in(found: ModelAnalysis) -> float:
    """How far from level soles are in the standing posture, in [rad]."""
    data = mujoco.MjData(found.model)
    data.qpos[:] = found.data.qpos
    for name, angle in standing_of(found).items():
        data.joint(name).qpos[0] = angle
    mujoco.mj_kinematics(found.model, data)
    off = []
    for leg in found.legs:
        before, after = (
            each.body(leg.foot).xmat.reshape(3, 3)
            for each in (found.data, data)
        )
        off.append(np.arccos(min(1.0, (after @ before.T @ leg.axes)[2, 2])))
    return float(max(off))


def test_a_robot_stands_flat_on_feet_tilted_in_the_zero_posture(
    tmp_path: Path,
) -> None:
    plain = analyse_model(stranger.mjcf(tmp_path), [])
    file = edited(tmp_path, shaped(tilted(0.0, 0.3)))
    found = analyse_model(file, [])
    stands, stood = standing_of(found), standing_of(plain)
    assert stands["near_tip"] == pytest.approx(
        stood["near_tip"] - 0.3, abs=0.02
    )
    assert level_in(plain) < 1e-3 and level_in(found) < 1e-3


def test_what_is_written_of_a_tilted_foot_is_level_in_the_legs_solver(
    tmp_path: Path,
) -> None:
    """The foot frame is put on the foot as it stands, not as it lies."""
    file = edited(tmp_path, shaped(tilted(0.0, 0.3)))
    found = derive(file, tmp_path, [])
    (tmp_path / FILE).write_text(write_description(found), encoding="utf-8")
    robot = load_robot(tmp_path)
    tree = compile_tree(robot)
    frames = [tree.sites[n] for n in (robot.left_foot, robot.right_foot)]
    for foot in frames:
        up = np.array(foot.axes)[:, 2]
        np.testing.assert_allclose(up, (sin(0.3), 0, cos(0.3)), atol=1e-6)
    assert found.highest == pytest.approx(0.62, abs=0.05)


def test_an_ankle_is_where_its_axes_cross(tmp_path: Path) -> None:
    """Wherever along the roll axis the model says that it is."""
    back = ('_lean" axis="1 0 0"', '_lean" pos="-0.1 0 0" axis="1 0 0"')
    for leg in feet(edited(tmp_path, lambda text: text.replace(*back))):
        assert leg.outline == pytest.approx(OUTLINE, abs=1e-6)


BODY = '<body name="{}_{}_link" pos="'
CROUCH = {"swing": -0.5, "bend": 0.9, "tip": -0.4}


def crouched(text: str) -> str:
    """A model whose zero posture has bent knees, its ranges as before."""
    for name, angle in CROUCH.items():
        turn = f'quat="{cos(0.5 * angle)} 0 {sin(0.5 * angle)} 0" pos="'
        low, high = next(p[3] for p in stranger.LEG if p[0] == name)
        for side, _ in stranger.SIDES:
            body = BODY.format(side, name)
            text = text.replace(body, body.replace('pos="', turn))
            joint = f'"{side}_{name}" axis="0 1 0" damping="0.8" range="'
            text = text.replace(
                f'{joint}{low} {high}"',
                f'{joint}{low - angle} {high - angle}"',
            )
    return text


def test_the_zero_posture_may_be_a_crouch(tmp_path: Path) -> None:
    plain = analyse_model(stranger.mjcf(tmp_path), [])
    found = analyse_model(edited(tmp_path, crouched), [])
    stands, stood = standing_of(found), standing_of(plain)
    for name, angle in CROUCH.items():
        assert stands[f"near_{name}"] == pytest.approx(
            stood[f"near_{name}"] - angle, abs=0.02
        )
    limits = knee_limits(found, found.legs[1])
    assert limits[0] == pytest.approx(0.05 - CROUCH["bend"], abs=1e-3)
    assert level_in(found) < 1e-3


def test_a_toe_is_part_of_its_foot(tmp_path: Path) -> None:
    def edit(text: str) -> str:
        for side, _ in stranger.SIDES:
            text = text.replace(
                BODY.format(side, "lean"),
                f'<body name="{side}_lean_link" pos="',
            )
        toe = (
            '<body name="{0}_toe_link" pos="0.11 0 -0.04">'
            '<joint name="{0}_toe" axis="0 1 0" range="-0.5 0.5"/>'
            '<inertial mass="0.05" pos="0 0 0" '
            'diaginertia="1e-5 1e-5 1e-5"/>'
            '<geom type="box" size="0.02 0.045 0.01" pos="0.02 0 0"/></body>'
        )
        parts = BOX.split(text)
        assert len(parts) == 3
        box = BOX.findall(text)[0]
        return (
            f"{parts[0]}{box}{toe.format('near')}"
            f"{parts[1]}{box}{toe.format('far')}{parts[2]}"
        )

    left, right = feet(edited(tmp_path, edit))
    assert left.joints == tuple(f"near_{part[0]}" for part in stranger.LEG)
    assert right.foot == "far_lean_link"
    assert left.outline[1] == pytest.approx(0.15)


@pytest.mark.parametrize(("x", "y"), [(0.2, 0.0), (0.0, 0.2)])
def test_a_sole_beside_its_ankle_is_refused(
    x: float, y: float, tmp_path: Path
) -> None:
    box = f'<geom type="box" size="0.06 0.03 0.01" pos="{x} {y} -0.04"/>'
    with pytest.raises(ModelError, match="must be under its ankle"):
        feet(edited(tmp_path, shaped(box)))
