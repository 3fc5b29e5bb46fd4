"""Test that description and check of each setting agree."""

from typing import Any

import click
import pytest

from stepaside.cli.main import all_commands
from stepaside.cli.options.parameter_types import NumberType
from stepaside.cli.options.setting_options import SettingOption
from stepaside.core.errors import StepAsideError
from stepaside.core.ranges import Range, check_count
from stepaside.core.setting import check_settings, ranges_of, settings_of
from stepaside.sim.physics_settings import PhysicsSettings
from tools.documents.tables.settings import LISTS, all_settings

SETTINGS = all_settings()
NUMBERS = [
    path
    for path, setting in SETTINGS.items()
    if setting.name in ranges_of(setting.kind)
]
OTHERS = sorted(SETTINGS.keys() - NUMBERS - LISTS.keys())


def test_every_setting_is_described() -> None:
    for path, setting in SETTINGS.items():
        assert settings_of(setting.kind)[setting.name].meaning, path


def test_a_range_has_unit_and_reason() -> None:
    for path in NUMBERS:
        setting = SETTINGS[path]
        allowed = ranges_of(setting.kind)[setting.name]
        assert allowed.unit and allowed.why, path
        assert allowed.low < allowed.high, path


def test_settings_without_a_range_are_no_numbers() -> None:
    for path in OTHERS:
        default = SETTINGS[path].default
        assert default is None or isinstance(default, bool | str), path


def numbers_of(name: str) -> list[click.Parameter]:
    return [
        param
        for param in all_commands()[name].params
        if not isinstance(param, SettingOption)
    ]


@pytest.mark.parametrize("name", all_commands())
def test_every_number_of_a_command_has_two_limits(name: str) -> None:
    for param in numbers_of(name):
        kind: Any = param.type
        assert kind not in (click.INT, click.FLOAT), param.opts
        if isinstance(kind, click.IntRange | click.FloatRange):
            assert kind.min is not None and kind.max is not None, param.opts
        if isinstance(kind, NumberType):
            assert kind.is_bounded, param.opts


def test_a_range_includes_its_limits_and_named_values() -> None:
    closed = Range(1.0, 2.0, "m", "why", also=(None, 0.0))
    held: list[Any] = [1, 1.0, 2.0, None, 0.0, 0]
    assert all(closed.holds(v) for v in held)
    refused: list[Any] = [0.99, 2.01, True, "1", [], 1j]
    assert not any(closed.holds(v) for v in refused)
    half_open = Range(1.0, 2.0, "m", "why", above=True)
    assert not half_open.holds(1.0) and half_open.holds(1.0 + 1e-15)
    whole = Range(0, 5, "1", "why", whole=True)
    assert whole.holds(5) and not whole.holds(5.0) and not whole.holds(10**99)
    assert closed.words == "1 to 2 or none or 0"
    assert half_open.text == "(1, 2]" and half_open.words == "above 1 to 2"


def test_a_message_has_name_rule_unit_and_value() -> None:
    wanted = r"^x must lie in \[1, 2\] \[m\], got 3$"
    with pytest.raises(StepAsideError, match=wanted):
        Range(1.0, 2.0, "m", "why").check(3, "x")
    with pytest.raises(StepAsideError) as refused:
        Range(1.0, 2.0, "m", "why").check(["a" * 9999], "x")
    assert len(str(refused.value)) < 200


def test_sections_and_booleans_have_their_types() -> None:
    check_settings(PhysicsSettings())
    for path in OTHERS:
        setting = SETTINGS[path]
        if isinstance(setting.default, bool):
            changes: dict[str, Any] = {setting.name: 1}
            with pytest.raises(StepAsideError, match="must be true or false"):
                setting.kind(**changes)


def test_lists_are_bounded() -> None:
    check_count([1, 2], 2, "x")
    for value in ([1, 2, 3], "ab", None):
        with pytest.raises(StepAsideError, match="x must be a list of at"):
            check_count(value, 2, "x")
