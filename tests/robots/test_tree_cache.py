"""Test trees of robots that are stored beside their descriptions."""

import json
import sys
from dataclasses import replace
from pathlib import Path
from shutil import copytree

import pytest

from stepaside.core.entries import to_entries
from stepaside.core.errors import ModelError
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import FILE, load_tree, store_tree
from stepaside.robots.tree_compiler import compile_tree
from synthetic_humanoid import synthetic_humanoid

NAO = load_robot("nao")


def without_mujoco(patch: pytest.MonkeyPatch) -> None:
    """Let MuJoCo be missing."""
    patch.setitem(sys.modules, "mujoco", None)
    patch.delitem(sys.modules, "stepaside.robots.tree_compiler", raising=False)


def test_the_stored_nao_is_what_mujoco_compiles() -> None:
    """If this fails: stepaside robot nao --compile."""
    stored = json.loads((NAO.folder / FILE).read_text(encoding="utf-8"))
    compiled = to_entries(compile_tree(NAO))
    del stored["version"], stored["digest"]
    assert stored == json.loads(json.dumps(compiled))


def test_the_stored_nao_is_up_to_date(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A copy, as the tree of the original may have been loaded already."""
    without_mujoco(monkeypatch)
    copytree(NAO.folder, tmp_path / "nao")
    copy = replace(NAO, folder=tmp_path / "nao")
    assert load_tree(copy).mass == pytest.approx(5.305, abs=2e-3)


def test_a_stored_tree_comes_back_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From what was stored: nothing can be compiled."""
    robot = synthetic_humanoid(tmp_path)
    tree = compile_tree(robot)
    store_tree(robot)
    without_mujoco(monkeypatch)
    assert to_entries(load_tree(robot)) == to_entries(tree)
    wrong = replace(robot, left_foot="hoof")  # of a tree that is known by now
    with pytest.raises(ModelError, match="hoof"):
        load_tree(wrong)
    assert load_tree(robot).links == tree.links
    assert load_tree(robot).sites == tree.sites


def test_an_old_tree_is_compiled_again(tmp_path: Path) -> None:
    robot = synthetic_humanoid(tmp_path)
    store_tree(robot)
    model = robot.folder / robot.model
    light = load_tree(robot).mass
    model.write_text(model.read_text().replace('mass="8"', 'mass="9"'))
    assert load_tree(robot).mass == pytest.approx(light + 1.0)


@pytest.mark.parametrize(
    ("kept", "why"),
    [
        (None, "is missing"),
        ("old", "is older than the model"),
        ("{", "cannot be read"),
        ("{}", "is older"),
    ],
)
def test_without_mujoco_a_stored_tree_is_required(
    kept: str | None, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = synthetic_humanoid(tmp_path)
    if kept == "old":
        store_tree(robot)
        model = robot.folder / robot.model
        model.write_text(model.read_text().replace('mass="8"', 'mass="9"'))
    elif kept is not None:
        (robot.folder / FILE).write_text(kept)
    without_mujoco(monkeypatch)
    words = rf"tree.json {why}.*`stepaside robot .* --compile`"
    with pytest.raises(ModelError, match=words):
        load_tree(robot)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("<freejoint/>", "", "'trunk' has no free joint"),
        (
            '<joint name="nod" axis="0 1 0" pos="0 0 0.03" range="-1 1"/>',
            '<joint name="nod" type="ball"/>',
            "'nod' of Synthetic must be a hinge or a slide",
        ),
        ('mass="8"', 'mass="0"', "does not compile"),
    ],
)
def test_a_model_that_cannot_be_moved_is_refused(
    old: str, new: str, words: str, tmp_path: Path
) -> None:
    robot = synthetic_humanoid(tmp_path)
    model = robot.folder / robot.model
    text = model.read_text()
    assert old in text
    model.write_text(text.replace(old, new))
    with pytest.raises(ModelError, match=words):
        load_tree(robot)
