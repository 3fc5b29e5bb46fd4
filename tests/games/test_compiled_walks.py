"""Test that machine code does not change a run."""

from dataclasses import fields

import numpy as np
import pytest

from stepaside.core.machine_code import is_enabled, plain_python
from stepaside.core.poses import Array
from stepaside.games.walk_game import run_walk
from stepaside.games.walk_settings import WALKER, WalkSettings
from stepaside.locomotion.zmp.control_settings import OPEN_LOOP, STABILISED
from stepaside.sim.body_settings import BODIES


def arrays_of(settings: WalkSettings) -> dict[str, Array]:
    track = run_walk(settings).tracks[WALKER]
    values = {f.name: getattr(track, f.name) for f in fields(track)}
    return {n: v for n, v in values.items() if isinstance(v, np.ndarray)}


@pytest.mark.parametrize("body", ["ideal", "hardware"])
def test_a_walk_has_the_same_bits(body: str) -> None:
    """Of legs, loads, estimator and servos, in open loop and feedback."""
    pytest.importorskip("llvmlite")
    assert is_enabled()
    settings = WalkSettings(
        bearing=0.3,
        duration=3.0,
        body=BODIES[body],
        control=OPEN_LOOP if body == "ideal" else STABILISED,
    )
    compiled = arrays_of(settings)
    with plain_python():
        assert not is_enabled()
        plain = arrays_of(settings)
    assert plain.keys() == compiled.keys() and "qpos" in plain
    for name, values in plain.items():
        np.testing.assert_array_equal(compiled[name], values, err_msg=name)
