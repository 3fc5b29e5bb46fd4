"""Test models with several hinges in one body, and refusals of what is none.

MuJoCo hangs any number of joints on a body: all links but the last of such
a body have no mass.
"""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import multi_hinge_humanoid
from inline_executor import InlineExecutor
from stepaside.cli.main import main
from stepaside.core.errors import ModelError
from stepaside.fitting.derivation import DerivedDescription, derive
from stepaside.fitting.description_writer import write_description
from stepaside.fitting.gait_feasibility import step_loads
from stepaside.fitting.gait_search import GOOD
from stepaside.fitting.joint_strain import JointStrain
from stepaside.fitting.model_analysis import analyse_model
from stepaside.fitting.requirements import check_requirements
from stepaside.fitting.robot_verification import check_robot
from stepaside.fitting.walk_trials import WalkTrialResult
from stepaside.games.robot_settings import settings_from_description
from stepaside.robots.description import FILE, load_robot


@pytest.fixture(scope="module")
def both(
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[DerivedDescription, DerivedDescription]:
    """The same robot with several hinges in a body, and with one in each."""
    found = []
    for split in (False, True):
        folder = tmp_path_factory.mktemp("hinges")
        model = multi_hinge_humanoid.write(folder, split=split)
        found.append(derive(model, folder, []))
        text = write_description(found[-1])
        (folder / FILE).write_text(text, encoding="utf-8")
    return found[0], found[1]


def test_several_hinges_in_a_body_are_one_joint_each(
    both: tuple[DerivedDescription, DerivedDescription],
) -> None:
    merged, split = both
    assert merged.analysis.model.nbody < split.analysis.model.nbody
    for one, other in zip(
        merged.analysis.legs, split.analysis.legs, strict=True
    ):
        assert one.joints == other.joints and len(one.joints) == 6


def test_what_is_derived_depends_on_masses_and_not_on_bodies(
    both: tuple[DerivedDescription, DerivedDescription],
) -> None:
    """The limit of links that get ever lighter."""
    merged, split = (found.description for found in both)
    assert merged.gait == pytest.approx(split.gait, rel=1e-3, abs=1e-4)
    assert merged.standing == pytest.approx(split.standing, abs=1e-3)
    assert merged.control["method"] == split.control["method"]
    assert both[0].loads.joint == both[1].loads.joint
    assert both[0].loads.usual == pytest.approx(both[1].loads.usual, rel=5e-3)


def test_torques_of_a_step_stay_finite_without_a_mass(
    both: tuple[DerivedDescription, DerivedDescription],
) -> None:
    merged, split = (
        load_robot(Path(found.description.folder)) for found in both
    )
    limits = dict.fromkeys(merged.legs, 90.0)
    one, other = (
        step_loads(robot, settings_from_description(robot).gait, limits)
        for robot in (merged, split)
    )
    assert np.isfinite(one.usual) and 0.0 < one.usual < 2.0
    assert one.usual == pytest.approx(other.usual, rel=5e-3)


def test_a_robot_with_several_hinges_in_a_body_can_be_looked_at(
    tmp_path: Path,
) -> None:
    model = multi_hinge_humanoid.write(tmp_path, split=False)
    folder = tmp_path / "robot"
    words = ["robot", "init", str(model), "--output", str(folder)]
    shown = CliRunner().invoke(main, words)
    assert shown.exit_code == 0, shown.output
    found = check_requirements(load_robot(folder))
    assert {finding.verdict for finding in found} <= {"pass", "warn"}


LIMB = """<body name="{name}_{i}" pos="{place}">
<joint name="{name}_{i}" axis="{axis}" range="-1 1"/>
<geom size="0.03" mass="0.5"/>"""


def robot_with(folder: Path, limbs: dict[str, tuple[float, int, str]]) -> Path:
    """Write a torso with limbs.

    Args:
        folder: Where to.
        limbs: By name: place to the left [m], number of joints, their axis.
    """
    bodies = ""
    for name, (left, count, axis) in limbs.items():
        for i in range(count):
            place = f"0 {left} 0.2" if i == 0 else "0 0 -0.1"
            bodies += LIMB.format(name=name, i=i, place=place, axis=axis)
        bodies += "</body>" * count
    file = folder / "limbs.xml"
    file.write_text(f"""<mujoco><compiler angle="radian"/><worldbody>
    <body name="torso" pos="0 0 1"><freejoint/><geom size="0.1" mass="5"/>
    {bodies}</body></worldbody></mujoco>""")
    return file


@pytest.mark.parametrize(
    ("limbs", "said"),
    [
        ({}, "no body below its torso has a hinge"),
        ({"head": (0.0, 2, "0 0 1")}, "got 0 to the left and 0 to the right"),
        (
            {"left_arm": (0.2, 4, "0 1 0")},
            "got 1 to the left and 0 to the right",
        ),
        (
            {"right_arm": (-0.2, 4, "0 1 0"), "tail": (-0.1, 1, "0 0 1")},
            "got 0 to the left and 2 to the right",
        ),
        (
            {
                "left_arm": (0.2, 4, "0 1 0"),
                "right_arm": (-0.2, 4, "0 1 0"),
                "head": (0.0, 2, "0 0 1"),
            },
            "joints on the left ends in 'left_arm_3' and is not a leg",
        ),
        (
            {"eye": (0.02, 1, "0 0 1"), "other_eye": (-0.02, 1, "0 0 1")},
            "chain of joints on the left ends in 'eye_0' and is not a leg",
        ),
    ],
)
def test_arms_and_heads_are_not_called_legs(
    limbs: dict[str, tuple[float, int, str]], said: str, tmp_path: Path
) -> None:
    with pytest.raises(ModelError) as refused:
        analyse_model(robot_with(tmp_path, limbs), [])
    message = str(refused.value)
    assert said in message
    for name in limbs:
        assert f"leg that ends in '{name}" not in message
    assert "none" not in message and "of 0 chains" not in message


@pytest.mark.parametrize("torque", [0.5, 0.95, 1.0])
@pytest.mark.parametrize("off", [0.05, 0.3, 1.5])
def test_a_hint_names_tune_only_where_tune_searches(
    torque: float,
    off: float,
    both: tuple[DerivedDescription, DerivedDescription],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The search ends at once where walks are steady enough."""
    from stepaside.fitting import robot_verification as checking

    strain = JointStrain(0.1, "knee", torque, "hip", 0.0, 0.0)
    monkeypatch.setattr(
        checking,
        "walk_trial",
        lambda trial: WalkTrialResult(
            *(trial.path.name, trial.control.feedback, "walked", True, 1.0),
            *(1.0, 0.01, 1.0 + 0.15 * off, 1.0, strain),
        ),
    )
    robot = load_robot(Path(both[0].description.folder))
    checked = check_robot(robot, InlineExecutor())
    worst = max(w.unsteadiness for w in checked.walks)
    hints = [finding.hint for finding in checked.findings if finding.hint]
    if torque > checking.GREATEST_LOAD:
        assert any("torque limit of hip" in hint for hint in hints)
    if any("tune" in hint for hint in hints):
        assert worst >= GOOD
