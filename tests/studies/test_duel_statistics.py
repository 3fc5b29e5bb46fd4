"""Test statistics of many duels by laws: what counts, and how surely."""

from statistics import fmean, stdev
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import t

from reference_statistics import is_wilson
from stepaside.games.duel_settings import DuelSettings
from stepaside.studies.duel_statistics import (
    VALUES,
    proportion,
    summarise_duels,
    value_row,
)

SETTINGS = DuelSettings()
ANY = st.floats(0.01, 99.0)
MAYBE = st.none() | ANY


@st.composite
def records(draw: st.DrawFn) -> list[dict[str, Any]]:
    """Records of duels that ended somehow, with or without figures."""
    rows: list[dict[str, Any]] = []
    for seed in range(draw(st.integers(1, 12))):
        rows.append(
            {name: draw(MAYBE) for name in VALUES}
            | {
                "seed": seed,
                "outcome": draw(
                    st.sampled_from(["completed", "fall", "contact"])
                ),
                "message": "",
                "evading_min_distance_m": draw(MAYBE),
                "certified_m": draw(MAYBE),
            }
        )
    return rows


@given(records())
def test_shares_are_of_all_duels_and_figures_of_completed_ones(
    rows: list[dict[str, Any]],
) -> None:
    found = summarise_duels(SETTINGS, rows)
    assert found["duels"] == len(rows)
    shares = [*found["outcomes"].values(), found["on_the_circle"]]
    shares.append(found["certificate"]["certified"])
    for each in shares:
        assert each["of"] == len(rows)
        assert is_wilson(each["low"], each["high"], each["number"], len(rows))
    ended = [each["number"] for each in found["outcomes"].values()]
    assert sum(ended) == len(rows)
    on = [r for r in rows if r["converged_at_s"] is not None]
    assert found["on_the_circle"]["number"] == len(on)
    whole = [r for r in rows if r["outcome"] == "completed"]
    assert len(found["not_completed"]) == len(rows) - len(whole)
    for name in VALUES:
        values = [r[name] for r in whole if r[name] is not None]
        row = found["figures"].get(name)
        assert (row is None) == (not values)
        if row is not None:
            assert row["number"] == len(values)
            assert row["mean"] == pytest.approx(fmean(values))


@given(st.lists(ANY, min_size=2, max_size=40), ANY)
def test_a_mean_has_the_interval_of_its_standard_error(
    values: list[float], theory: float
) -> None:
    rows = [{"seed": i, "x": value} for i, value in enumerate(values)]
    found = value_row("x", rows, theory, 0)
    assert found is not None
    n = len(values)
    half = t.ppf(0.975, n - 1) * stdev(values) / n**0.5
    low, high = found["mean_low"], found["mean_high"]
    assert low == pytest.approx(fmean(values) - half, rel=1e-3, abs=1e-3)
    assert high == pytest.approx(fmean(values) + half, rel=1e-3, abs=1e-3)
    assert found["deviation"] == pytest.approx(stdev(values))
    assert (found["least"], found["greatest"]) == (min(values), max(values))
    assert found["median"] == pytest.approx(float(np.median(values)))
    assert found["worst"] in values
    assert values[found["worst_seed"]] == found["worst"]
    off = [abs(value - theory) for value in values]
    assert abs(found["worst"] - theory) == pytest.approx(max(off))
    for bad, worst in ((1, max(values)), (-1, min(values))):
        row = value_row("x", rows, None, bad)
        assert row is not None and row["worst"] == worst


@given(st.integers(1, 300), st.data())
def test_a_share_counts_misses_too(number: int, data: st.DataObject) -> None:
    hits = data.draw(st.integers(0, number))
    found = proportion(i < hits for i in range(number))
    assert (found["number"], found["of"]) == (hits, number)
    assert is_wilson(found["low"], found["high"], hits, number)


@given(records())
def test_certified_distances_are_held_against_all_that_have_both(
    rows: list[dict[str, Any]],
) -> None:
    found = summarise_duels(SETTINGS, rows)["certificate"]
    over = [
        r["evading_min_distance_m"] - r["certified_m"]
        for r in rows
        if None not in (r["evading_min_distance_m"], r["certified_m"])
    ]
    nearer = found["nearer_than_certified"]
    assert nearer["of"] == len(over)
    assert nearer["number"] == sum(x < 0.0 for x in over)
    if over:
        assert found["least_excess_m"] == min(over)
        assert found["median_excess_m"] == pytest.approx(np.median(over))
