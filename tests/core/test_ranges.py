"""Test that settings outside their ranges are refused with the range."""

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import StepAsideError
from stepaside.games.game_settings import GameSettings, StartSettings, duel
from stepaside.planning import GaitSettings
from stepaside.sim.physics_settings import PhysicsSettings, SightSettings


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
        GameSettings,
        StartSettings,
        PhysicsSettings,
        SightSettings,
        GaitSettings,
    )
    for entry in numbers(kind)
]


@pytest.mark.parametrize("power", [(10, 5000), (-1, 1), (2, 128)])
def test_a_seed_of_more_than_128_bits_is_refused(
    power: tuple[int, int],
) -> None:
    value = power[0] ** power[1]
    with pytest.raises(StepAsideError, match="seed") as refused:
        duel(seed=value)
    assert len(str(refused.value)) < 200


NARROW = [np.float16, np.float32, np.float64, np.longdouble]


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
