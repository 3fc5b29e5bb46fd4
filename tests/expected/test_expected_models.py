"""What was once wrong with models of robots."""

import re
from dataclasses import replace
from pathlib import Path

import mujoco
import pytest

import vendor_humanoid as stranger
from expected.asking import refused
from flows.calls import stepaside
from stepaside.fitting.robot_verification import check_requirements
from stepaside.robots.description import RobotDescription, load_robot


def checked(description: RobotDescription, name: str) -> tuple[str, str]:
    """Return verdict and value of a check of a robot."""
    found = check_requirements(description)
    (check,) = [each for each in found if each.name == name]
    return check.verdict, check.value


def symmetry(description: RobotDescription) -> str:
    return checked(description, "mirror symmetry")[0]


def test_a_symmetric_robot_mirrors_itself() -> None:
    assert symmetry(load_robot("nao")) == "pass"


def test_a_foot_ahead_of_the_other_does_not_mirror_it() -> None:
    """Pitched by equal and opposite angles: neither is higher."""
    nao = load_robot("nao")
    pitch = nao.standing.get("LHipPitch", 0.0)
    angles = {"LHipPitch": pitch + 0.2, "RHipPitch": pitch - 0.2}
    assert symmetry(replace(nao, standing=nao.standing | angles)) == "warn"


def test_standing_loads_an_arm_by_its_weight_at_its_lever() -> None:
    nao = load_robot("nao")
    ahead = {"LShoulderPitch": 0.0, "RShoulderPitch": 0.0}
    stretched = replace(nao, standing=nao.standing | ahead)
    model = nao.compile()
    data = mujoco.MjData(model)
    for name, angle in stretched.standing.items():
        data.joint(name).qpos[:] = angle
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    joint = model.joint("LShoulderPitch")
    lever = data.subtree_com[joint.bodyid[0]] - data.xanchor[joint.id]
    torque = 9.81 * model.body_subtreemass[joint.bodyid[0]] * lever[0]
    (motor,) = (model.actuator_trnid[:, 0] == joint.id).nonzero()[0]
    share = 100.0 * torque / model.actuator_forcerange[motor, 1]
    found = checked(stretched, "torque of standing")
    assert found == ("pass", f"{share:.0f} % of the limit of LShoulderPitch")


LIMITS = 'lower="-0.9" upper="0.9"'


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (('<mass value="', '<mass value="-'), "mass"),
        (('lower="-', 'lower="9'), "limit"),
        ((LIMITS, 'lower="-52" upper="52"'), "limit"),
        ((LIMITS, 'lower="0" upper="0"'), "limit"),
    ],
)
def test_impossible_values_of_a_model_are_refused_by_name(
    change: tuple[str, str], word: str, tmp_path: Path
) -> None:
    model = stranger.urdf(tmp_path)
    text = model.read_text(encoding="utf-8")
    if change[0] not in text:
        raise ValueError(f"{change[0]} is not in the model")
    model.write_text(text.replace(*change), encoding="utf-8")
    assert word in refused("robot", "init", model, cwd=tmp_path)


@pytest.mark.parametrize("change", ["banner", "late", "ampersand", "comma"])
def test_a_model_that_mujoco_compiles_is_read(
    change: str, tmp_path: Path
) -> None:
    """A banner as a comment, or a declaration after a blank line."""
    model = stranger.urdf(tmp_path)
    text = model.read_text(encoding="utf-8")
    match change:
        case "banner":
            text = text.replace("<link", "<!------ LEGS ------><link", 1)
        case "late":
            text = '\n<?xml version="1.0"?>\n' + text
        case "ampersand":
            text = text.replace('name="stranger"', 'name="A & B"', 1)
        case "comma":
            text = re.sub('velocity="[^"]*"', 'velocity="12,5"', text, count=1)
    model.write_text(text, encoding="utf-8")
    mujoco.MjModel.from_xml_path(str(model))
    stepaside("robot", "init", model, cwd=tmp_path)


COUPLING = (
    '</worldbody><equality><joint joint1="near_spin" joint2="far_spin"/>'
    "</equality>"
)
ARM = (
    '<body name="{0}_a" pos="0 {1} 0.2"><joint name="{0}_1" axis="0 1 0"/>'
    '<geom size="0.05"/><body name="{0}_b" pos="0 0 -0.3"><joint '
    'name="{0}_2" axis="0 1 0"/><geom size="0.05"/></body></body>'
)


def turned(text: str) -> str:
    """Return a model whose y axis points up, as z did before."""

    def turn(found: re.Match[str]) -> str:
        name, values = found[1], found[2].split()
        if len(values) == 3:
            x, y, z = values
            values = [x, z, y if "pos" not in name else f"{-float(y)}"]
        return f'{name}="{" ".join(values)}"'

    names = "pos|axis|size|diaginertia"
    text = re.sub(r'<geom name="floor"[^>]*>', "", text)
    return re.sub(rf'({names})="([^"]*)"', turn, text)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("one name", "the joint of 'near_spin_link' must have a name"),
        ("no names", "the joint of 'near_spin_link' must have a name"),
        ("coupled yaws", "must not turn about parallel axes"),
        ("y up", "stands along the y axis"),
        ("upper body", "no leg found on the left"),
    ],
)
def test_models_that_cannot_walk_are_refused_by_name(
    change: str, said: str, tmp_path: Path
) -> None:
    """MuJoCo compiles all of them."""
    model = stranger.mjcf(tmp_path, motors=False)
    text = re.sub("<asset>.*|<keyf.*|<geom.*mesh.*", "", model.read_text())
    match change:
        case "one name":
            text = text.replace('joint name="near_spin"', "joint")
        case "no names":
            text = re.sub('joint name="[^"]*"', "joint", text)
        case "coupled yaws":
            text = text.replace("</worldbody>", COUPLING)
        case "y up":
            text = turned(text)
        case "upper body":
            arms = ARM.format("l", 0.2) + ARM.format("r", -0.2)
            text = re.sub('<body name="near_spin.*', arms, text)
    model.write_text(text)
    mujoco.MjModel.from_xml_path(str(model))
    assert said in refused("robot", "init", model, cwd=tmp_path)


def test_estimates_are_named_where_they_are_judged(tmp_path: Path) -> None:
    """The model has no limits of speeds and torques."""
    model = stranger.mjcf(tmp_path, motors=False)
    stepaside("robot", "init", model, "--output", tmp_path / "robot")
    tables = "speed_limits, overlay.servos"
    made = load_robot(tmp_path / "robot")
    assert checked(made, "estimates") == ("warn", tables)
    assert checked(load_robot("nao"), "estimates") == ("pass", "none")
