"""Test settings as values and as configuration files."""

from collections.abc import Callable
from dataclasses import FrozenInstanceError, asdict, fields, replace
from math import inf, nan, pi, radians
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
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.sim.body_settings import (
    BODIES,
    BodySettings,
    with_control_period,
)
from stepaside.sim.physics_settings import PhysicsSettings, SightSettings
from stepaside.sim.push import Push
from stepaside.strategies import Evasion

# The edges of every range: both are allowed, what lies beyond is not.
RANGES: list[tuple[Callable[..., Any], str, float, float]] = [
    (StartSettings, "distance", 0.4, 100.0),
    (StartSettings, "pursuer_offset", -pi, pi),
    (StartSettings, "evader_offset", -pi, pi),
    (SightSettings, "bearing_noise", 0.0, pi),
    (SightSettings, "distance_noise", 0.0, 100.0),
    (SightSettings, "delay", 0.0, 2.0),
    (SightSettings, "rate", 1e-3, inf),
    (PhysicsSettings, "friction", 1e-6, 100.0),
    (PhysicsSettings, "unevenness", 0.0, 0.1),
    (PhysicsSettings, "slope", 0.0, 0.5),
    (PhysicsSettings, "slope_direction", -pi, pi),
    (DuelSettings, "duration", 1e-3, 86400.0),
    (DuelSettings, "seed", 0, 2**70),
    (BodySettings, "cycle", 0.0, 0.1),
    (BodySettings, "delay_cycles", 0, 100),
    (BodySettings, "imu_delay_cycles", 0, 100),
    (BodySettings, "efficiency", 0.01, 1.0),
    (BodySettings, "stiffness", 0.0, 1.0),
    (BodySettings, "servo_gain", 0.01, 10.0),
    (BodySettings, "backlash", 0.0, 0.2),
    (BodySettings, "encoder_step", 1e-9, 0.1),
    (BodySettings, "gyro_noise", 0.0, 10.0),
    (BodySettings, "gyro_bias", 0.0, 10.0),
    (BodySettings, "accelerometer_noise", 0.0, 100.0),
    (BodySettings, "accelerometer_bias", 0.0, 100.0),
    (BodySettings, "force_noise", 0.0, 1000.0),
    (BodySettings, "force_gain_error", 0.0, 1.0),
    (BodySettings, "mass_error", 0.0, 0.9),
    (BodySettings, "com_error", 0.0, 0.1),
]


@pytest.mark.parametrize(("kind", "name", "low", "high"), RANGES)
def test_a_range_includes_its_limits_and_nothing_beyond(
    kind: Callable[..., Any], name: str, low: float, high: float
) -> None:
    beyond = [low - (1 if isinstance(low, int) else 1e-6), nan, -inf]
    if high < 1e6:
        beyond.append(high + (1 if isinstance(high, int) else 1e-6))
    for value in (low, high):
        assert getattr(kind(**{name: value}), name) == value
    for value in beyond:
        with pytest.raises(ConfigurationError, match=name):
            kind(**{name: value})


@pytest.mark.parametrize(
    "value",
    [
        StartSettings(),
        Evasion(),
        SightSettings(),
        PhysicsSettings(),
        DuelSettings(),
        BodySettings(),
        WalkSettings(),
        Push(1.0, 2.0, 0.0),
    ],
    ids=lambda value: type(value).__name__,
)
def test_settings_are_immutable(value: Any) -> None:
    for field in fields(value):
        with pytest.raises(FrozenInstanceError):
            setattr(value, field.name, getattr(value, field.name))
    assert not hasattr(value, "__dict__")


@pytest.mark.parametrize(
    ("name", "low", "high"), [("time_step", 1e-5, 0.01), ("tick", 1e-5, 0.1)]
)
def test_physics_settings_have_ranges(
    name: str, low: float, high: float
) -> None:
    for value in (low, high):
        PhysicsSettings(time_step=min(value, 0.01), tick=value)
    for value in (0.9 * low, 1.1 * high):
        with pytest.raises(ConfigurationError, match=name):
            changed: dict[str, Any] = {name: value}
            replace(PhysicsSettings(time_step=1e-5, tick=0.1), **changed)


@pytest.mark.parametrize(
    ("time_step", "tick", "steps"),
    [(0.002, 0.002, 1), (0.002, 0.012, 6), (0.001, 0.1, 100), (3e-5, 9e-5, 3)],
)
def test_a_tick_has_a_whole_number_of_time_steps(
    time_step: float, tick: float, steps: int
) -> None:
    physics = PhysicsSettings(time_step=time_step, tick=tick)
    assert physics.steps_per_tick == steps


@pytest.mark.parametrize("tick", [0.001, 0.0008, 0.0031, 0.00400001])
def test_a_tick_that_is_no_multiple_of_the_time_step_is_refused(
    tick: float,
) -> None:
    with pytest.raises(ConfigurationError, match="whole multiple"):
        PhysicsSettings(time_step=0.002, tick=tick)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"seed": 1.5}, "seed must be an integer"),
        ({"sensing": "ears"}, "sensing must be one of ideal, cameras"),
        ({"pursuer": "dog"}, "pursuer"),
    ],
)
def test_a_duel_refuses_unknown_choices(
    changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message):
        DuelSettings(**changes)


def test_negative_rates_are_refused_even_infinite_ones() -> None:
    for rate in (-inf, 0.0, -1.0):
        with pytest.raises(ConfigurationError, match="rate"):
            SightSettings(rate=rate)


def test_a_strategy_is_its_own_setting() -> None:
    strategy = Evasion(0.4, True, 0.7, 1.3, 0.2)
    assert strategy.angle == 0.4 and strategy.saturated
    assert strategy.safety_radius == 0.7 and strategy.release_distance == 1.3
    assert strategy.side_hysteresis == 0.2
    usual = Evasion()
    assert usual.angle == pi / 2 and not usual.saturated
    assert usual.safety_radius == 0.8 and usual.release_distance == inf
    assert usual.side_hysteresis == pytest.approx(radians(20.0))


def test_an_invalid_strategy_is_refused_at_once() -> None:
    with pytest.raises(ValueError, match="safety"):
        Evasion(safety_radius=-1.0)


def test_a_body_may_set_the_control_period() -> None:
    physics = PhysicsSettings()
    assert with_control_period(physics, BodySettings()) is physics
    asked = with_control_period(physics, BodySettings(cycle=0.012))
    assert asked == replace(physics, tick=0.012)
    with pytest.raises(ConfigurationError, match="whole multiple"):
        with_control_period(physics, BodySettings(cycle=0.011))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("delay_cycles", 1),
        ("torque_speed", True),
        ("efficiency", 0.99),
        ("stiffness", 0.99),
        ("servo_gain", 1.01),
        ("backlash", 0.001),
    ],
)
def test_any_servo_effect_enables_the_servo_model(
    name: str, value: float
) -> None:
    effects: dict[str, Any] = {name: value}
    body = replace(BodySettings(), **effects)
    assert not body.has_ideal_servos and not body.has_sensor_errors


@pytest.mark.parametrize(
    "name",
    [
        "imu_delay_cycles",
        "encoder_step",
        "gyro_noise",
        "gyro_bias",
        "accelerometer_noise",
        "accelerometer_bias",
        "force_noise",
        "force_gain_error",
    ],
)
def test_any_sensor_error_enables_the_error_model(name: str) -> None:
    effects: dict[str, Any] = {name: 1 if "cycles" in name else 0.1}
    body = replace(BodySettings(), **effects)
    assert body.has_sensor_errors and body.has_ideal_servos


def test_mass_errors_enable_neither_servo_nor_sensor_models() -> None:
    body = BodySettings(mass_error=0.1, com_error=0.01, cycle=0.012)
    assert body.has_ideal_servos and not body.has_sensor_errors


def test_presets_are_those_of_the_documents() -> None:
    """Values are those of docs/walking.md, with their source."""
    assert BODIES["ideal"] == BodySettings()
    assert asdict(BODIES["delayed"]) == asdict(BodySettings()) | {
        "cycle": 0.012,
        "delay_cycles": 3,
        "imu_delay_cycles": 1,
    }
    assert asdict(BODIES["hardware"]) == {
        "cycle": 0.012,
        "delay_cycles": 3,
        "imu_delay_cycles": 1,
        "torque_speed": True,
        "efficiency": 0.6,
        "stiffness": 1.0,
        "servo_gain": 0.75,
        "backlash": pytest.approx(pi / 180.0),
        "encoder_step": pytest.approx(2.0 * pi / 4096),
        "gyro_noise": 0.01,
        "gyro_bias": 0.01,
        "accelerometer_noise": 0.2,
        "accelerometer_bias": 0.1,
        "force_noise": 0.4,
        "force_gain_error": 0.1,
        "mass_error": 0.03,
        "com_error": 0.003,
    }


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
        with pytest.raises(ConfigurationError, match="here: .* must be"):
            parse_settings(DuelSettings, entries, "here")


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"duration": True}, "here: duration must be a float, got True"),
        ({"seed": False}, "here: seed must be a int, got False"),
        ({"start": {"distance": True}}, "here: start.distance must be"),
    ],
)
def test_booleans_are_not_accepted_as_numbers(
    entries: dict[str, Any], message: str
) -> None:
    """Python converts them to 1 and 0: a duel of one second."""
    with pytest.raises(ConfigurationError, match=message):
        parse_settings(DuelSettings, entries, "here")


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"weather": 1, "mood": 2}, "here: unknown entry mood, weather"),
        ({"physics": {"tock": 1.0}}, "here: unknown entry tock"),
        ({"physics": {"tick": "x"}}, "physics.tick must be a float, got 'x'"),
        ({"duration": -1.0}, "duration must lie in"),
    ],
)
def test_errors_in_a_configuration_are_named(
    entries: dict[str, Any], message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message):
        parse_settings(DuelSettings, entries, "here")


def test_invalid_configuration_files_are_refused(tmp_path: Path) -> None:
    broken = tmp_path / "broken.toml"
    with pytest.raises(ConfigurationError, match=r"broken\.toml"):
        load_configuration(broken)
    broken.write_text("seed = = 1", encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"broken\.toml"):
        load_configuration(broken)
    broken.write_bytes(b"\xff\xfe")
    with pytest.raises(ConfigurationError, match=r"broken\.toml"):
        load_configuration(broken)
    broken.write_text("weather = 1", encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"broken\.toml: unknown"):
        load_configuration(broken)
