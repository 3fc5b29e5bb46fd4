"""Survival with confidence, and limits beside the pendulum's bound."""

from dataclasses import replace
from math import exp
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference_statistics import coverage, is_wilson
from stepaside.planning import GaitSettings
from stepaside.studies.push_limits import push_cases
from stepaside.studies.robustness_trial import (
    DIRECTIONS,
    STRENGTHS,
    RobustnessTrial,
)
from stepaside.studies.survival_statistics import (
    PUSH,
    limit_rows,
    push_bound_at,
    push_survival_rows,
    survival_rows,
)
from stepaside.studies.tabulation import wilson_interval

TRIAL = RobustnessTrial("backlash", 1.0, "", 0.0, 1, "mpc", "ideal")
MIRRORED = {"left": "right", "right": "left"}


def row(
    limit: float, method: str = "mpc", direction: str = "left", **changes: Any
) -> dict[str, Any]:
    """Row of a limit beside bounds of 2 and 1 N s."""
    return {
        "method": method,
        "direction": direction,
        "phase": 0.0,
        "limit_n_s": limit,
        "bound_n_s": 2.0,
        "impulse_bound_n_s": 1.0,
        "ratio": 0.5 * limit,
        **changes,
    }


@pytest.mark.parametrize(
    ("survived", "number", "low", "high"),
    [  # worked out from Wilson's formula with z = 1.96
        (0, 0, 0.0, 1.0),
        (0, 10, 0.0, 0.2775),
        (10, 10, 0.7225, 1.0),
        (5, 10, 0.2366, 0.7634),
        (81, 263, 0.2553, 0.3662),
    ],
)
def test_wilson_interval_has_the_known_values(
    survived: int, number: int, low: float, high: float
) -> None:
    assert wilson_interval(survived, number) == pytest.approx(
        (low, high), abs=1e-4
    )


def test_survival_is_counted_over_the_seeds_of_each_strength() -> None:
    grid = [
        replace(TRIAL, strength=x, seed=seed)
        for x in (1.0, 2.0)
        for seed in range(4)
    ]
    one, two = survival_rows(
        (t, {"survived": t.strength + t.seed < 4.5}) for t in grid[:-1]
    )
    assert (one["strength"], one["survived"], one["trials"]) == (1.0, 4, 4)
    assert (two["strength"], two["survived"], two["trials"]) == (2.0, 3, 3)
    assert (one["low"], one["high"]) == wilson_interval(4, 4)


def test_survival_of_pushes_is_the_share_of_phases_with_that_limit() -> None:
    found = push_survival_rows([row(1.0), row(1.4), row(0.3)])
    assert [r["strength"] for r in found] == list(STRENGTHS["push"])
    by_strength = {r["strength"]: r["survived"] for r in found}
    assert by_strength[0.4] == 2 and by_strength[1.0] == 2
    assert by_strength[1.2] == by_strength[1.4] == 1
    assert by_strength[1.6] == 0
    assert {r["trials"] for r in found} == {3}


def test_limit_is_the_largest_push_survived_with_all_smaller_ones() -> None:
    """One survived above a failure does not count."""
    case = next(push_cases(["mpc"], "ideal", phases=2))
    tried = {0.4: True, 0.8: False, 1.2: True, 0.6: True, 0.7: False}
    record = {"strengths": [*tried], "survived": [*tried.values()]}
    [found] = limit_rows([(case, record)])
    assert found["limit_n_s"] == 0.6
    assert found["bound_n_s"] == push_bound_at(case.direction, case.phase)
    assert found["ratio"] == 0.6 / found["bound_n_s"]
    assert found["impulse_bound_n_s"] < found["bound_n_s"]


@pytest.mark.parametrize("impulse", [False, True])
@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("phase", [0.0, 0.125, 0.3, 0.45])
def test_bounds_half_a_cycle_apart_mirror_each_other(
    direction: str, phase: float, impulse: bool
) -> None:
    other = MIRRORED.get(direction, direction)
    assert push_bound_at(direction, phase, impulse=impulse) == pytest.approx(
        push_bound_at(other, phase + 0.5, impulse=impulse), rel=1e-9
    )


def test_bound_is_of_the_walk_under_way() -> None:
    """50 ms into single support, by hand, with the DCM that recurs there."""
    gait, mass = GaitSettings(), 5.30535
    eta, sole = gait.eta, gait.sole
    dcm_x, dcm_y, middle = 0.02224408, 0.00521494, 0.5 * PUSH
    # The ZMP rests at the anchor meanwhile, so the DCM runs away from it.
    x = gait.zmp_forward + (dcm_x - gait.zmp_forward) * exp(eta * middle)
    y = dcm_y * exp(eta * middle)
    fade = exp(-eta * (gait.single_support - middle))
    ahead = fade * (0.08 + sole.front) + (1.0 - fade) * sole.front
    assert push_bound_at("forward", 0.0, impulse=True) == pytest.approx(
        mass * eta * (ahead - x), rel=1e-5
    )
    assert push_bound_at("right", 0.0, impulse=True) == pytest.approx(
        mass * eta * (sole.outer + y), rel=1e-5
    )


def test_a_push_that_lasts_may_be_harder_than_an_impulse_in_its_middle() -> (
    None
):
    """The ZMP need not wait for the middle."""
    for direction in DIRECTIONS:
        for phase in (0.0, 0.1, 0.2):
            assert push_bound_at(direction, phase) > 1.1 * push_bound_at(
                direction, phase, impulse=True
            )


@given(st.integers(1, 400), st.data())
def test_wilsons_ends_are_as_unlikely_as_95_percent_says(
    number: int, data: st.DataObject
) -> None:
    hits = data.draw(st.integers(0, number))
    low, high = wilson_interval(hits, number)
    assert is_wilson(low, high, hits, number)
    # A miss is the hit of the opposite share.
    other = wilson_interval(number - hits, number)
    assert (1.0 - other[1], 1.0 - other[0]) == pytest.approx((low, high))


@pytest.mark.parametrize("number", [50, 200])
def test_wilsons_interval_holds_the_share_19_times_in_20(number: int) -> None:
    bounds = [wilson_interval(hits, number) for hits in range(number + 1)]
    shares = [0.01 * i for i in range(10, 91)]
    held = [coverage(bounds, share) for share in shares]
    assert sum(held) / len(held) == pytest.approx(0.95, abs=0.01)
    assert min(held) > 0.9


@given(st.lists(st.floats(0.0, 4.0), min_size=1, max_size=20))
def test_a_push_is_survived_where_the_limit_reaches_it(
    limits: list[float],
) -> None:
    """Phases at which nothing is survived count as well."""
    for found in push_survival_rows([row(limit) for limit in limits]):
        reached = [x >= found["strength"] - 1e-9 for x in limits]
        assert found["trials"] == len(limits)
        assert found["survived"] == sum(reached)
        low, high = found["low"], found["high"]
        assert is_wilson(low, high, sum(reached), len(limits))
