"""Test the report on what is installed."""

import json
from collections.abc import Callable
from typing import Any

import pytest
from click.testing import CliRunner, Result

from stepaside.cli import doctor as command
from stepaside.cli.main import main
from stepaside.sim import offscreen_rendering


@pytest.fixture(autouse=True)
def no_graphics(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        offscreen_rendering, "choose_renderer", lambda: "raycast"
    )


def doctor(*options: str) -> Result:
    return CliRunner().invoke(main, ["doctor", *options])


def without(*names: str) -> Callable[[str], Any]:
    """Return a look-up that finds every module but those named."""
    return lambda name: None if name in names else object()


def test_an_extra_that_lacks_a_module_is_told_with_the_command(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(command, "find_spec", without("daqp"))
    done = doctor()
    assert done.exit_code == 0
    assert "no daqp: pip install 'stepaside[mpc]'" in done.output
    assert done.output.count("pip install") == 1
    heads = [x for x in done.output.splitlines() if x[:1] not in ("", " ")]
    assert [x.split()[0] for x in heads] == [
        "stepaside",
        "extras",
        "graphics:",
    ]


def test_a_missing_library_is_an_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(
        command, "_version", lambda name: None if name == "numpy" else "1"
    )
    done = doctor("--json")
    assert done.exit_code == 1
    assert json.loads(done.output)["missing"] == ["numpy"]


def test_missing_graphics_are_told_with_what_to_install() -> None:
    assert "libosmesa6" in doctor().output


def test_libraries_are_those_of_the_core_alone() -> None:
    found = json.loads(doctor("--json").output)["libraries"]
    assert {"mujoco", "numpy", "click"} <= set(found)
    assert not {"pytest", "viser"} & set(found)
