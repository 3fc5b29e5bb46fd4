"""Test settings as values and as configuration files."""

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.configuration_file import (
    dump_configuration,
    load_configuration,
    parse_settings,
)
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.initial_poses import draw_start
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.sim.body_settings import (
    BODIES,
    BodySettings,
    with_control_period,
)
from stepaside.sim.physics_settings import PhysicsSettings
from stepaside.strategies import Evasion


@pytest.mark.parametrize("tick", [0.001, 0.0008, 0.0031, 0.00400001])
def test_a_tick_that_is_no_multiple_of_the_time_step_is_refused(
    tick: float,
) -> None:
    with pytest.raises(ConfigurationError, match="whole multiple"):
        PhysicsSettings(time_step=0.002, tick=tick)


def test_a_body_may_set_the_control_period() -> None:
    physics = PhysicsSettings()
    assert with_control_period(physics, BodySettings()) is physics
    asked = with_control_period(physics, BodySettings(cycle=0.012))
    assert asked == replace(physics, tick=0.012)
    with pytest.raises(ConfigurationError, match="whole multiple"):
        with_control_period(physics, BodySettings(cycle=0.011))


def test_starts_fill_their_ranges_and_repeat() -> None:
    """Distance and offsets of both, in the ranges of the docstring."""
    drawn = [draw_start(DuelSettings(seed=seed)) for seed in range(400)]
    for name, low, high in (
        ("distance", 0.6, 1.5),
        ("pursuer_offset", -pi / 2, pi / 2),
        ("evader_offset", -pi / 6, pi / 6),
    ):
        values = [getattr(start, name) for start in drawn]
        assert low <= min(values) < low + 0.03 * (high - low)
        assert high - 0.03 * (high - low) < max(values) <= high
    assert draw_start(DuelSettings(seed=7)) == drawn[7]


def test_given_start_values_are_kept_and_others_drawn_unchanged() -> None:
    whole = draw_start(DuelSettings(seed=5))
    for name in ("distance", "pursuer_offset", "evader_offset"):
        given = StartSettings(**{name: 0.5})
        found = draw_start(DuelSettings(seed=5, start=given))
        assert found == replace(whole, **{name: 0.5})
    away = draw_start(DuelSettings(seed=5, pursuer="person"))
    assert away.distance == pytest.approx((whole.distance or 0.0) + 1.5)
    assert away.evader_offset == whole.evader_offset


def test_a_configuration_is_read_as_written(tmp_path: Path) -> None:
    settings = DuelSettings(
        seed=9,
        duration=33.0,
        start=StartSettings(distance=0.9),
        strategy=Evasion(angle=0.4, saturated=True),
        body=BODIES["hardware"],
        control=ControlSettings(method="measured", feedback=True),
    )
    file = tmp_path / "duel.toml"
    file.write_text(dump_configuration(settings), encoding="utf-8")
    assert "pursuer_offset" not in file.read_text(encoding="utf-8")
    assert load_configuration(file) == settings.resolved()


def test_integers_are_converted_to_floats_but_not_conversely() -> None:
    settings = parse_settings(DuelSettings, {"duration": 30}, "here")
    assert settings.duration == 30.0 and isinstance(settings.duration, float)
    given = parse_settings(DuelSettings, {"start": {"distance": 1}}, "here")
    assert given.start.distance == 1.0
    assert isinstance(given.start.distance, float)
    for entries in ({"seed": 1.5}, {"seed": "2"}, {"duration": "1"}):
        with pytest.raises(ConfigurationError, match="here: .* must (be|lie)"):
            parse_settings(DuelSettings, entries, "here")


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        (
            {"weather": 1, "mood": 2},
            "here: unknown entry weather, mood; there are",
        ),
        (
            {"physics": {"tock": 1.0}},
            "unknown entry physics.tock; did you mean physics.tick",
        ),
        (
            {"physics": {"tick": "x"}},
            r"physics.tick must lie in .* \[s\], got 'x'",
        ),
        ({"duration": -1.0}, "duration must lie in"),
        ({"seed": True}, "seed must be an integer in .*, got True"),
        ({"physics": {"friction": float("nan")}}, "physics.friction .*nan"),
        ({"pushes": [{"impulse": -1}]}, "pushes 1.impulse .*pushes 1.time"),
        ({"seed": -1, "duration": 0}, "seed must .*; duration must"),
        ({"physics": {"tick": 0.0031}}, "physics: tick must be a whole"),
    ],
)
def test_errors_in_a_configuration_are_named(
    entries: dict[str, Any], message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message):
        parse_settings(DuelSettings, entries, "here")
