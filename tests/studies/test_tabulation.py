"""Test tables of records: shares, means and their intervals."""

from math import sqrt

import numpy as np
import pytest
from scipy.stats import binomtest, t

from stepaside.core.errors import ConfigurationError
from stepaside.studies.tabulation import mean_of, share_of, tabulate

RECORDS = [
    {"who": "a", "outcome": "won", "fell": False, "far_m": 1.0},
    {"who": "a", "outcome": "lost", "fell": True, "far_m": 2.0},
    {"who": "b", "outcome": "won", "fell": False, "far_m": None},
    {"who": "a", "outcome": "won", "fell": False, "far_m": 6.0},
]


def test_rows_are_groups_in_the_order_of_their_first_record() -> None:
    rows = tabulate(RECORDS, ["who"], ["outcome", "fell", "far_m"])
    assert [(row["who"], row["number"]) for row in rows] == [
        ("a", 3),
        ("b", 1),
    ]
    assert rows[0]["outcome"]["won"] == share_of(2, 3)
    assert rows[0]["fell"] == share_of(1, 3)
    assert rows[0]["far_m"] == mean_of([1.0, 2.0, 6.0])
    assert rows[1]["far_m"] is None
    (row,) = tabulate([{"who": "a"}, {"who": None}], [], ["who"])
    assert row["who"] == {"a": share_of(1, 2)}


@pytest.mark.parametrize(("count", "number"), [(0, 7), (3, 7), (7, 7)])
def test_the_interval_of_a_share_is_wilsons(count: int, number: int) -> None:
    exact = binomtest(count, number).proportion_ci(method="wilson")
    row = share_of(count, number)
    assert (row["low"], row["high"]) == pytest.approx(exact, abs=1e-7)


@pytest.mark.parametrize("number", [3, 12])
def test_the_interval_of_a_mean_is_students(number: int) -> None:
    values = np.random.default_rng(number).normal(size=number)
    low, high = t.interval(
        0.95, number - 1, values.mean(), values.std(ddof=1) / sqrt(number)
    )
    row = mean_of(values.tolist())
    assert row["mean"] - row["half"] == pytest.approx(low)
    assert row["mean"] + row["half"] == pytest.approx(high)
    assert mean_of([1.0, 2.0])["half"] is None


def test_an_unknown_value_is_refused_with_those_that_exist() -> None:
    with pytest.raises(ConfigurationError, match="who, outcome.*'speed'"):
        tabulate(RECORDS, ["who"], ["speed"])
    (row,) = tabulate([{"walking": None}], [], ["walking.steps"])
    assert row["walking.steps"] is None  # a level without steps


@pytest.mark.parametrize("number", [1, 20, 63, 800])
def test_the_interval_of_a_share_holds_the_share(number: int) -> None:
    """To the last bit: bars of figures must not have negative lengths."""
    for count in range(number + 1):
        row = share_of(count, number)
        assert 0.0 <= row["low"] <= row["share"] <= row["high"] <= 1.0
