"""Test robot descriptions: another humanoid needs no code."""

from pathlib import Path

import numpy as np
import pytest

from stepaside.core.errors import ModelError
from stepaside.robots.description import known_robots, load_robot
from stored_values import rows_of

NAO = load_robot("nao")


def copy_of_nao(folder: Path, **changes: str) -> Path:
    text = (NAO.folder / "robot.toml").read_text()
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (folder / "robot.toml").write_text(text)
    (folder / "model.xml").write_text(NAO.mjcf())
    return folder


def test_a_changed_description_is_read_again(tmp_path: Path) -> None:
    folder = copy_of_nao(tmp_path)
    load_robot(folder).standing.clear()
    assert load_robot(folder).standing == NAO.standing
    assert load_robot(copy_of_nao(folder, NAO="Ann")).name == "Ann"


def test_another_robot_is_a_folder(tmp_path: Path) -> None:
    """Longer legs and another name, and it stands."""
    from stepaside.robots.leg_kinematics import BodyReference, LegKinematics

    folder = copy_of_nao(tmp_path, NAO="Tall NAO")
    model = (folder / "model.xml").read_text()
    longer = model.replace('pos="0 0 -0.1"', 'pos="0 0 -0.13"')
    assert longer != model
    (folder / "model.xml").write_text(longer)
    robot = load_robot(folder)
    assert robot.name == "Tall NAO"
    stance = BodyReference(
        (0.02, 0.0, 0.29), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
    )
    assert LegKinematics(robot, tick=0.004).stand(stance).size == 23


def test_unknown_robot_names_the_known_ones() -> None:
    assert known_robots() == ["nao"]
    with pytest.raises(ModelError, match="one of nao.*got 'atlas'"):
        load_robot("atlas")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    rows_of("test_wrong_description_is_refused_by_name"),
)
def test_wrong_description_is_refused_by_name(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    folder = copy_of_nao(tmp_path, **{old: new})
    with pytest.raises(ModelError, match=message):
        load_robot(folder).compile()


def test_a_colour_is_that_of_the_accent_alone() -> None:
    plain, painted = NAO.compile(), NAO.compile((0.1, 0.9, 0.2, 1.0))
    accent = painted.material(NAO.accent).id
    assert painted.mat_rgba[accent].tolist() == pytest.approx(
        [0.1, 0.9, 0.2, 1.0]
    )
    others = np.arange(plain.nmat) != accent
    np.testing.assert_array_equal(
        painted.mat_rgba[others], plain.mat_rgba[others]
    )
