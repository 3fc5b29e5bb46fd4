"""Test the geometry of the head and the file that describes it."""

from math import cos, radians, sin
from pathlib import Path

import numpy as np
import pytest

from stepaside.core.errors import ModelError
from stepaside.robots.description import load_robot
from stepaside.robots.head import HeadDescription, load_head
from stored_values import rows_of

NAO = load_robot("nao")
HEAD = load_head(NAO)


def test_cameras_point_forward_and_slightly_down() -> None:
    for mount, degrees in ((HEAD.top, 1.2), (HEAD.depth_cameras[0], 8.0)):
        ahead = cos(radians(degrees)), 0.0, -sin(radians(degrees))
        np.testing.assert_allclose(mount.axes_in_body[:, 0], ahead, atol=1e-15)
        np.testing.assert_allclose(
            mount.axes_in_body[:, 1], (0, 1, 0), atol=1e-15
        )
        assert (
            mount.axes_in_body[2, 2] > 0.9 and mount.position_in_body[1] == 0.0
        )
    assert (
        HEAD.depth_cameras[0].position_in_body[2]
        > HEAD.top.position_in_body[2]
    )


def test_the_rear_camera_looks_backward_from_the_torso() -> None:
    rear = HEAD.depth_cameras[1]
    np.testing.assert_allclose(
        rear.axes_in_body, np.diag([-1.0, -1.0, 1.0]), atol=1e-15
    )
    assert rear.on_torso and HEAD.body_of(rear) == "torso"
    assert (
        HEAD.body_of(HEAD.depth_cameras[0]) == HEAD.body_of(HEAD.top) == "head"
    )


def rewritten(folder: Path, old: str, new: str) -> HeadDescription:
    text = (NAO.folder / "head.toml").read_text(encoding="utf-8")
    assert old in text
    for name in ("robot.toml", "model.xml"):
        (folder / name).write_bytes((NAO.folder / name).read_bytes())
    (folder / "head.toml").write_text(text.replace(old, new))
    return load_head(load_robot(folder))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    rows_of("test_a_wrong_head_is_refused_by_its_file"),
)
def test_a_wrong_head_is_refused_by_its_file(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(ModelError, match=message) as caught:
        rewritten(tmp_path, old, new)
    assert str(tmp_path / "head.toml") in str(caught.value)
