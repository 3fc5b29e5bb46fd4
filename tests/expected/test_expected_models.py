"""What was once wrong with models of robots, and what still is.

Each that still is wrong is expected to fail until it is mended.
"""

from dataclasses import replace
from pathlib import Path

import pytest

import vendor_humanoid as stranger
from flows.calls import stepaside
from stepaside.fitting.requirements import check_requirements
from stepaside.robots.description import RobotDescription, load_robot


def verdict(description: RobotDescription) -> str:
    """Return the verdict on the mirror symmetry of a robot."""
    found = check_requirements(description)
    (check,) = [each for each in found if each.name == "mirror symmetry"]
    return check.verdict


def test_a_symmetric_robot_mirrors_itself() -> None:
    assert verdict(load_robot("nao")) == "pass"


def test_a_foot_ahead_of_the_other_does_not_mirror_it() -> None:
    """Pitched by equal and opposite angles: neither is higher."""
    nao = load_robot("nao")
    pitch = nao.standing.get("LHipPitch", 0.0)
    angles = {"LHipPitch": pitch + 0.2, "RHipPitch": pitch - 0.2}
    assert verdict(replace(nao, standing=nao.standing | angles)) == "warn"


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (('<mass value="', '<mass value="-'), "mass"),
        (('lower="-', 'lower="9'), "limit"),
    ],
)
@pytest.mark.xfail(
    strict=True,
    raises=AssertionError,
    reason="negative masses and reversed limits are taken without a word",
)
def test_impossible_values_of_a_model_are_refused_by_name(
    change: tuple[str, str], word: str, tmp_path: Path
) -> None:
    model = stranger.urdf(tmp_path)
    text = model.read_text(encoding="utf-8")
    if change[0] not in text:
        raise ValueError(f"{change[0]} is not in the model")
    model.write_text(text.replace(*change), encoding="utf-8")
    answer = stepaside("robot", "init", model, status=2, cwd=tmp_path)
    assert word in answer.err and "Traceback" not in answer.err
