"""How far aside a unicycle gets, against its own differential equation."""

from math import pi, sin

import pytest

from stepaside.planning import PRESETS
from stepaside.theory.unicycle.lateral_evasion import (
    lateral_clearance,
    lateral_displacement,
)


@pytest.mark.parametrize("time", [0.3, 1.9, 4.0])
def test_displacement_solves_the_unicycle_equations(time: float) -> None:
    """Y' = v sin(theta), theta' = omega until a quarter turn."""
    count, way = 20_000, 0.0
    for i in range(count):
        way += 0.25 * sin(min(0.8 * (i + 0.5) * time / count, pi / 2))
    found = lateral_displacement(0.25, 0.8, time)
    assert found == pytest.approx(way * time / count, rel=1e-6)


def test_limits_of_short_and_long_times() -> None:
    assert lateral_displacement(0.25, 0.8, 1e-3) == pytest.approx(
        0.25 * 0.8e-6 / 2
    )
    late = lateral_displacement(0.25, 0.8, 11.0) - lateral_displacement(
        0.25, 0.8, 10.0
    )
    assert late == pytest.approx(0.25)
    assert lateral_displacement(0.25, 1e6, 2.0) == pytest.approx(0.5, rel=1e-4)


def test_fast_gait_clears_a_person_and_the_gait_of_the_paper_does_not() -> (
    None
):
    """At 1 m/s, seen at 3.5 m; the paper's gait below 0.4 m/s only."""

    def room(name: str, person: float) -> float:
        gait = PRESETS[name]
        pace = gait.path_interval / gait.step_duration
        return lateral_clearance(
            gait.speed * pace,
            0.5 * pi * gait.gain * pace,
            person_speed=person,
            distance=3.5,
            first_step=gait.start_support,
        )

    assert room("fast", 1.0) > 0.1
    assert room("nao", 1.0) < -0.4 < room("nao", 0.2)
