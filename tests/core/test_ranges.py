"""Test that settings outside their ranges are refused with the range."""

from dataclasses import fields, replace
from math import inf, nan
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.errors import (
    PlanError,
    StepAsideError,
    check_finite,
    check_not_negative,
    check_positive,
    check_within,
)
from stepaside.core.setting import ranges_of
from stepaside.games.configuration_file import dump_configuration
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.planning import (
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
)
from stepaside.sim.physics_settings import PhysicsSettings, SightSettings

GAIT = [  # without those that may be zero
    name
    for name, r in ranges_of(GaitSettings).items()
    if r.low > 0 and not r.whole
]
ABSURD = (1e18, 1e300, 5e-324, 1e-18, inf, nan, -1.0, True, 0.0)


@pytest.mark.parametrize("name", GAIT)
@pytest.mark.parametrize("value", ABSURD)
def test_a_gait_refuses_absurd_values(name: str, value: Any) -> None:
    with pytest.raises(PlanError, match=name):
        replace(GaitSettings(), **{name: value})


@pytest.mark.parametrize("name", GAIT)
def test_values_beyond_a_bound_are_refused(name: str) -> None:
    low, high = ranges_of(GaitSettings)[name][:2]
    for value in (low * 0.99, high * 1.01):
        changes: dict[str, Any] = {name: value}
        with pytest.raises(PlanError, match=f"{name} must lie in"):
            replace(GaitSettings(), **changes)


def numbers(kind: Any) -> list[Any]:
    """Return the numeric attributes of a class of settings."""
    return [
        (kind, field.name)
        for field in fields(kind)
        if field.type in (float, int, float | None)
        or str(field.type) in ("float", "int", "float | None")
    ]


ALL = [
    entry
    for kind in (
        DuelSettings,
        StartSettings,
        PhysicsSettings,
        SightSettings,
        GaitSettings,
    )
    for entry in numbers(kind)
]


@pytest.mark.parametrize("value", [True, False, nan])
def test_a_numeric_setting_refuses_bool_and_nan(value: Any) -> None:
    for kind, name in ALL:
        with pytest.raises(StepAsideError, match=name):
            kind(**{name: value})


@pytest.mark.parametrize("power", [(10, 5000), (-1, 1), (2, 128)])
def test_a_seed_of_more_than_128_bits_is_refused(
    power: tuple[int, int],
) -> None:
    value = power[0] ** power[1]
    with pytest.raises(StepAsideError, match="seed") as refused:
        DuelSettings(seed=value)
    assert len(str(refused.value)) < 200


def test_a_plan_refuses_absurd_bearings_and_times() -> None:
    planner = ManeuverPlanner(GaitSettings())
    for bearing in (1e308, -1e18, nan, inf):
        with pytest.raises(PlanError, match="bearing"):
            planner.plan(
                bearing,
                Direction.FORWARD,
                first_foot=Foot.LEFT,
                standing=True,
            )
    plan = planner.plan(
        0.5, Direction.FORWARD, first_foot=Foot.LEFT, standing=True
    )
    for times in ([nan], [0.0, inf]):
        with pytest.raises(PlanError, match="times"):
            plan.sample(times)


@pytest.mark.parametrize(
    "words",
    [
        "unicycles --duration 1e18",
        "unicycles --duration 5e-324",
        "duels --workers 1000000000000",
        "duel --duration 1e18",
        "duel --gain 1e300",
        "duel --friction 1e18",
        "duel --start-support 1e-18",
        "duel --single-support 1e18",
        "replay . --rate 1e18",
        "replay . --speed 5e-324",
        "view --serve-for 1e18",
        f"duel --seed {'9' * 4000}",
    ],
)
def test_commands_refuse_absurd_values_in_one_line(words: str) -> None:
    result = CliRunner().invoke(main, words.split())
    assert result.exit_code == 2, result.output
    assert result.stderr.count("\n") == 1


def holds(check: Any, value: Any, *bounds: float) -> bool:
    try:
        check(value, *bounds, "x", "m")
    except PlanError:
        return False
    return True


NARROW = [np.float16, np.float32, np.float64, np.longdouble]


@pytest.mark.filterwarnings("ignore:overflow")
@pytest.mark.parametrize("kind", NARROW)
@pytest.mark.parametrize(
    "text", "inf -inf nan 0 1 -1 6e-8 1e-13 1e-7 65504 1e13 3e38 1e300".split()
)
def test_checks_convert_narrow_floats_to_double(kind: Any, text: str) -> None:
    narrow = kind(text)
    wide = float(narrow)
    for check in (check_finite, check_positive, check_not_negative):
        assert holds(check, narrow) == holds(check, wide)
    for bounds in ((0.0, 1e9), (1e-9, 1.0), (1e-3, 65504.5), (0.0, 1e40)):
        assert holds(check_within, narrow, *bounds) == holds(
            check_within, wide, *bounds
        )


@pytest.mark.filterwarnings("ignore:overflow")
@pytest.mark.parametrize("kind", NARROW)
@pytest.mark.parametrize("text", ["inf", "-inf", "nan", "0", "1e-13"])
def test_settings_convert_narrow_floats_to_double(
    kind: Any, text: str
) -> None:
    def made(owner: Any, name: str, value: Any) -> Any:
        try:
            return replace(owner(), **{name: value})
        except StepAsideError:
            return None

    wide = float(kind(text))
    for owner, name in ALL:
        narrow = made(owner, name, kind(text))
        assert narrow == made(owner, name, wide), (owner, name)
        if narrow is not None:
            assert type(getattr(narrow, name)) is float, (owner, name)


@pytest.mark.parametrize("value", [10**400, -(10**400)])
def test_an_integer_beyond_the_double_range_is_refused(value: int) -> None:
    for check in (check_finite, check_positive):
        assert not holds(check, value)


def test_settings_of_numpy_types_are_written_as_python_numbers() -> None:
    settings = DuelSettings(
        seed=np.int64(3),  # type: ignore[arg-type]
        duration=np.float32(2.5),  # type: ignore[arg-type]
    )
    wanted = dump_configuration(DuelSettings(seed=3, duration=2.5))
    assert dump_configuration(settings) == wanted
