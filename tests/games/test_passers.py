"""Test people who pass while another person approaches."""

from dataclasses import replace
from math import cos, hypot, pi, radians, sin
from typing import Any

import mujoco
import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose, wrap_angle
from stepaside.games.configuration_file import (
    dump_configuration,
    load_configuration,
)
from stepaside.games.duel import Duel, run_duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.report.scene import RunScene
from stepaside.sim.passerby_settings import Passer
from stepaside.sim.person_settings import PersonSettings

EVADER = Pose(3.0, -1.0, 2.5)


def duel(*passers: Passer, **changes: Any) -> DuelSettings:
    """Return a duel with a person at low speed, 3 m ahead of the evader."""
    settings = DuelSettings(
        duration=3.0,
        pursuer="person",
        person=PersonSettings("straight", 0.1),
        start=StartSettings(3.0, 0.0, 0.0),
        passers=passers,
    )
    return replace(settings, **changes)


@pytest.mark.parametrize("bearing", [0.0, 1.2, -2.0, pi])
@pytest.mark.parametrize("miss", [1.2, -0.4])
def test_a_passer_approaches_from_its_direction_and_passes(
    bearing: float, miss: float
) -> None:
    passer = Passer(0.8, 4.0, bearing, miss)
    first = passer.pose_at(0.0, EVADER)
    away = hypot(first.x - EVADER.x, first.y - EVADER.y)
    assert away == pytest.approx(4.0)
    seen = EVADER.inverse().compose(first)
    assert seen.x == pytest.approx(4.0 * cos(bearing), abs=1e-9)
    assert seen.y == pytest.approx(4.0 * sin(bearing), abs=1e-9)
    poses = [passer.pose_at(0.01 * i, EVADER) for i in range(1200)]
    nearest = min(hypot(p.x - EVADER.x, p.y - EVADER.y) for p in poses)
    expected = 4.0 * abs(miss) / hypot(4.0, miss)
    assert nearest == pytest.approx(expected, abs=1e-3)
    way = hypot(poses[100].x - first.x, poses[100].y - first.y)
    assert way == pytest.approx(0.8)
    # To the left as it comes: the evader stays on its right.
    x, y, course = poses[0]
    turned = (EVADER.y - y) * cos(course) - (EVADER.x - x) * sin(course)
    assert np.sign(turned) == -np.sign(miss)
    assert all(wrap_angle(p.theta - course) == 0.0 for p in poses)


def trunk(model: mujoco.MjModel, data: mujoco.MjData, name: str) -> Any:
    """Return the position of the trunk of a figure, in [m]."""
    return data.mocap_pos[int(model.body(f"{name}/trunk").mocapid[0])][:2]


def test_a_passer_walks_in_the_world_and_in_the_replay() -> None:
    passers = Passer(0.8, 3.0, 1.5, 1.5), Passer(0.3, 2.5, -1.0, 1.3, "child")
    game = Duel(settings := duel(*passers, duration=0.4))
    evader = game.frames[1]
    while game.world.time < 0.2 - 1e-9:
        assert game.tick() is None
    for number, passer in enumerate(passers, start=1):
        place = trunk(game.world.model, game.world.data, f"passer {number}")
        last = 0.2 - settings.physics.time_step
        there = passer.pose_at(last, evader)
        assert place == pytest.approx((there.x, there.y), abs=1e-9)
    run = run_duel(settings)
    stage = RunScene(run)
    stage.put(10)
    for number, passer in enumerate(passers, start=1):
        there = passer.pose_at(float(run.times[10]), evader)
        place = trunk(stage.model, stage.data, f"passer {number}")
        assert place == pytest.approx((there.x, there.y), abs=1e-9)


def test_contact_with_a_passer_is_reported() -> None:
    run = run_duel(duel(Passer(1.5, 1.6, 1.0, 0.0)))
    assert run.outcome.value == "contact"
    assert run.message.startswith("evader and passer 1 touched at ")
    assert run.summary.touched == ["evader", "passer 1"]


def test_ideal_sight_reports_only_the_pursuer() -> None:
    """The duel is the same to the bit."""
    alone = run_duel(duel(duration=1.0))
    passed = run_duel(duel(Passer(0.8, 3.0, 1.5, 1.5), duration=1.0))
    np.testing.assert_array_equal(alone.evader.torso, passed.evader.torso)
    assert passed.outcome.value == "completed"


def test_passers_are_part_of_configurations(tmp_path: Any) -> None:
    settings = duel(Passer(0.8, 3.0, 1.5, -1.5, "child"), Passer(0.0, 2.0))
    file = tmp_path / "duel.toml"
    file.write_text(dump_configuration(settings), encoding="utf-8")
    assert load_configuration(file) == settings.resolved()
    shown = CliRunner().invoke(
        main,
        [
            *("duel", "--pursuer", "person", "--print-config"),
            *("--passer", "0.8@3:90deg:1.5", "--passer", "0.5@4:-1"),
        ],
    )
    assert shown.exit_code == 0, shown.stderr
    file.write_text(shown.stdout, encoding="utf-8")
    first, second = load_configuration(file).passers
    assert first == Passer(0.8, 3.0, radians(90.0), 1.5)
    assert second == Passer(0.5, 4.0, -1.0, 1.2)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("0.8@3", "SPEED@DISTANCE:BEARING"),
        ("fast@3:0", "must be a number [m/s], got 'fast'"),
        ("0.8@3:0:inf", "passer miss must lie in [-20, 20] [m], got inf"),
        ("9@3:0", "passer speed must lie in"),
        ("0.8@3:x", "must be an angle"),
    ],
)
def test_invalid_passers_are_refused(given: str, message: str) -> None:
    words = ["duel", "--pursuer", "person", "--passer", given]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 2 and message in result.stderr


def test_passers_need_a_person_as_pursuer_and_a_figure() -> None:
    with pytest.raises(ConfigurationError, match="passers need a person"):
        DuelSettings(passers=(Passer(0.8, 3.0),))
    with pytest.raises(ConfigurationError, match="passer figure must be"):
        Passer(0.8, 3.0, figure="giant")
