"""Test what published models have that none of the others had before."""

import json
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

import vendor_humanoid as stranger
from stepaside.core.errors import ModelError
from stepaside.fitting.derivation import (
    GREATEST_BY_HEIGHT,
    LEAST_SPACING,
    derive,
    report_of,
)
from stepaside.fitting.description_writer import write_description
from stepaside.fitting.model_analysis import (
    DetectedLeg,
    analyse_model,
    forward_score,
)
from stored_values import DATA, compare_stored, words_of


def test_geoms_without_size_are_removed(tmp_path: Path) -> None:
    """As spheres of radius 0 at the corners of feet."""
    model = stranger.urdf(tmp_path)
    text = model.read_text()
    mark = "<collision><geometry><sphere radius='0.0'/></geometry></collision>"
    model.write_text(text.replace("</link>", f"{mark}</link>"))
    assert len(analyse_model(model, []).legs) == 2


def test_actuators_of_the_environment_are_removed(tmp_path: Path) -> None:
    """A body of the world's with motor and sensor: once a crash."""
    model = stranger.mjcf(tmp_path)
    text = model.read_text()
    text = text.replace(
        "</worldbody>",
        "<body name='ghost' pos='0 0 20'><joint name='spare'/>"
        "<geom size='0.01'/></body></worldbody>",
    ).replace(
        "<keyframe>",
        "<sensor><jointactuatorfrc joint='spare'/><jointpos joint='spare'/>"
        "</sensor><keyframe>",
    )
    text = text.replace("</actuator>", "<motor joint='spare'/></actuator>")
    model.write_text(text)
    found = analyse_model(model, [])
    assert "spare" not in found.joints
    assert found.model.nu == 0 and found.model.nsensor == 0


# What is changed in the text of a model, by pairs of old and new.
ODD: dict[str, list[list[str]]] = json.loads(
    (DATA / "odd_changes.json").read_text()
)


@pytest.mark.parametrize("odd", ODD)
def test_an_odd_model_is_described_or_refused(
    odd: str, tmp_path: Path
) -> None:
    """All that is derived, written and refused is stored."""
    model = stranger.mjcf(tmp_path)
    text = model.read_text()
    for old, new in ODD[odd]:
        assert old in text, old
        text = text.replace(old, new)
    model.write_text(text)
    try:
        found = derive(model, tmp_path / "robot", [])
    except ModelError as error:
        said = str(error)
    else:
        said = f"{report_of(found)}\n{write_description(found)}"
    compare_stored("odd_models.json", odd, words_of(said))


def _leg(outline: tuple[float, ...], **changes: Any) -> DetectedLeg:
    nothing = np.zeros(3)
    values = {
        "joints": ("knee",),
        "pitches": ("hip", "knee", "ankle"),
        "signs": (1.0, 1.0, 1.0),
        "is_guessed": False,
    } | changes
    return DetectedLeg(
        foot="foot",
        hip=nothing,
        ankle=nothing,
        sole=0.0,
        outline=outline,  # type: ignore[arg-type]
        axes=np.eye(3),
        pivots=np.zeros((3, 3)),
        **values,  # type: ignore[arg-type]
    )


@pytest.mark.parametrize(
    ("edges", "bends", "ahead"),
    [
        ((-0.06, 0.12), (0.0, 2.4), 1.0),
        ((-0.12, 0.06), (-2.4, 0.0), -1.0),
        ((-0.098, 0.072), (0.0, 2.8), 1.0),  # heels, but knees say more
        ((-0.05, 0.15), (-2.0, 0.0), 1.0),  # a bird's knees
        ((-0.09, 0.085), (-3.1, 3.1), 0.0),  # not stated
    ],
)
def test_toes_and_knees_determine_the_forward_direction(
    edges: tuple[float, float], bends: tuple[float, float], ahead: float
) -> None:
    low, high = bends
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><compiler angle='radian'/><worldbody><body>"
        f"<joint name='knee' range='{low} {high}'/><geom size='1'/>"
        "</body></worldbody></mujoco>"
    )
    leg = _leg((*edges, -0.04, 0.04))
    assert np.sign(forward_score(model, leg)) == ahead


def test_the_ankle_does_not_depend_on_the_anchor_along_its_axis(
    tmp_path: Path,
) -> None:
    """The ankle is where the roll axis crosses it."""
    model = stranger.mjcf(tmp_path)
    text = model.read_text()
    # Roll before pitch, whose place is off to the side.
    for side, sign in stranger.SIDES:
        text = text.replace(f"{side}_tip", f"{side}_x").replace(
            f"{side}_lean", f"{side}_tip"
        )
        text = text.replace(f"{side}_x", f"{side}_lean")
        text = _swapped(text, side, sign)
    model.write_text(text)
    left, right = analyse_model(model, []).legs
    assert left.joints[-2:] == ("near_lean", "near_tip")
    for leg in (left, right):
        assert abs(leg.ankle[1]) == pytest.approx(0.5 * stranger.WIDTH)
        _, _, inner, outer = leg.outline
        assert -inner == pytest.approx(outer)


def _swapped(text: str, side: str, sign: float) -> str:
    """Exchange the axes of the ankle's joints, the pitch's place aside."""
    pitch = f'<joint name="{side}_lean" axis="0 1 0"'
    roll = f'<joint name="{side}_tip" axis="1 0 0"'
    assert pitch in text and roll in text
    text = text.replace(pitch, f'<joint name="{side}_lean" axis="1 0 0"')
    return text.replace(
        roll, f'<joint name="{side}_tip" axis="0 1 0" pos="0 {0.03 * sign} 0"'
    )


def test_no_feet_are_wider_apart_than_suits_their_height(
    tmp_path: Path,
) -> None:
    model = stranger.mjcf(tmp_path)
    half = 0.5 * stranger.WIDTH
    wide = 2.2 * half
    model.write_text(
        model.read_text()
        .replace(f" {half} -0.08", f" {wide} -0.08")
        .replace(f" {-half} -0.08", f" {-wide} -0.08")
    )
    found = derive(model, tmp_path, [])
    spacing, highest = found.size.foot_spacing, found.highest
    assert spacing == pytest.approx(GREATEST_BY_HEIGHT * highest, rel=0.02)
    assert spacing < 2.0 * wide
    assert spacing > LEAST_SPACING * 2.0 * found.size.sole[3]
