"""Known faults of robots, as tests of what is right.

Each is expected to fail until it is mended; one that passes fails the run.
"""

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stepaside as sa
from flows.calls import stepaside
from legs_robot import nao_on_legs
from stepaside.games.match import play
from stepaside.games.robot_settings import with_robot

NAO = Path(sa.__file__).parent / "robots" / "nao"


@pytest.mark.xfail(
    strict=True,
    raises=AssertionError,
    reason="the gaze reckons with the height of NAO's camera on every robot",
)
def test_a_head_at_1_m_looks_down_at_a_person_nearby(tmp_path: Path) -> None:
    """From 1.1 m above the floor, a person at 0.8 m is below."""
    tall = tmp_path / "tall"
    shutil.copytree(NAO, tall)
    head = tall / "head.toml"
    text = head.read_text(encoding="utf-8")
    for near, far in (
        ("[0.05871, 0.0, 0.06364]", "[0.05871, 0.0, 0.7]"),
        ("[0.03, 0.0, 0.145]", "[0.03, 0.0, 0.7]"),
    ):
        assert text.count(near) == 1
        text = text.replace(near, far)
    head.write_text(text, encoding="utf-8")
    stepaside(
        *("duel", "--robot", tall, "--sensing", "cameras", "--seed", 1),
        *("--pursuer", "person", "--person-path", "straight"),
        *("--person-speed", 0.6, "--person-halt-after", 1.2),
        *("--evader-strategy", "stand", "--distance", 2, "--duration", 2.6),
        *("--output", tmp_path / "run"),
    )
    run = sa.load_run(tmp_path / "run")
    assert run.evader.qpos is not None
    head_pitch = run.evader.qpos[-1, 8]  # [rad], positive downward
    assert 0.3 < head_pitch < 0.52


@pytest.mark.xfail(
    strict=True,
    raises=AssertionError,
    reason="the hardware body gives learned legs the exact joint velocities",
)
def test_velocities_of_a_hardware_body_are_those_of_its_encoders(
    tmp_path: Path,
) -> None:
    pytest.importorskip("onnxruntime")
    folder = nao_on_legs(tmp_path / "nao")
    settings = with_robot(sa.DuelSettings(duration=1.0), str(folder))
    duel = sa.Duel(replace(settings, body=sa.BODIES["hardware"]))
    play(duel, 0.5)
    evader: Any = duel.players[1]
    measured = evader.robot.read().joint_velocities
    exact = duel.world.data.qvel
    assert not np.isin(measured, exact).all()
