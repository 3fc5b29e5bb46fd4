"""Test the rows of a tournament by laws: every game counts in them."""

from statistics import fmean, stdev
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import t

from reference_statistics import is_wilson
from stepaside.studies.tournament_rows import tournament_rows

ASIDE = "evasion(safety_radius=100)"

OUTCOMES = ("survived", "captured", "contact", "touched", "fell")
MEANS = {
    "survived_s": ("mean_survival_s", 1.0),
    "closest_m": ("mean_closest_m", 1.0),
    "bound_m": ("mean_bound_m", 1.0),
    "floor_m2": ("floor_used_m2", 1.0),
    "turning_rad_s": ("turning_rad_s", 1.0),
    "unseen": ("out_of_view", 1.0),
    "decision_s": ("decision_ms", 1e3),
}
HALVES = {"closest_m": "mean_closest_pm_m", "floor_m2": "floor_used_pm_m2"}
SHARES = ("survived", "captured", "contact", "touched_obstacle", "fell")


@st.composite
def games(draw: st.DrawFn) -> list[dict[str, Any]]:
    """Games of two pairings, which ended somehow."""
    each = st.floats(0.01, 9.0)
    return [
        {name: draw(each) for name in (*MEANS, "longest_decision_s")}
        | {
            "evader": draw(st.sampled_from([ASIDE, "look-ahead"])),
            "pursuer": "pursuit",
            "seed": seed,
            "outcome": outcome,
            "contact": outcome == "contact",
        }
        for seed in range(draw(st.integers(1, 20)))
        for outcome in [draw(st.sampled_from(OUTCOMES))]
    ]


@given(games())
def test_means_and_shares_are_over_all_games_of_a_pairing(
    records: list[dict[str, Any]],
) -> None:
    rows = tournament_rows(records)
    assert sum(row["games"] for row in rows) == len(records)
    for row in rows:
        own = [r for r in records if r["evader"] == row["evader"]]
        assert row["games"] == len(own)
        for name, (mean, unit) in MEANS.items():
            values = [unit * r[name] for r in own]
            assert row[mean] == pytest.approx(fmean(values)), mean
            if name in HALVES and len(own) > 1:
                n = len(own)
                half = t.ppf(0.975, n - 1) * stdev(values) / n**0.5
                assert row[HALVES[name]] == pytest.approx(half, rel=1e-4)
        ratio = row["mean_closest_m"] / row["mean_bound_m"]
        assert row["closest_over_bound"] == pytest.approx(ratio)
        longest = max(r["longest_decision_s"] for r in own)
        assert row["longest_decision_ms"] == pytest.approx(1e3 * longest)


@given(games())
def test_shares_of_outcomes_are_shares_and_sum_to_one(
    records: list[dict[str, Any]],
) -> None:
    for row in tournament_rows(records):
        own = [r for r in records if r["evader"] == row["evader"]]
        ended = [r["outcome"] for r in own]
        assert sum(row[name] for name in SHARES) == pytest.approx(1.0)
        for name, outcome in zip(SHARES, OUTCOMES, strict=True):
            share = ended.count(outcome) / len(own)
            assert row[name] == pytest.approx(share), name
        low, high = row["survived_low"], row["survived_high"]
        assert is_wilson(low, high, ended.count("survived"), len(own))


@given(games(), st.randoms(use_true_random=False))
def test_outcomes_do_not_change_means(
    records: list[dict[str, Any]], random: Any
) -> None:
    other = [r | {"outcome": random.choice(OUTCOMES)} for r in records]
    untold = {*SHARES, "survived_low", "survived_high", "worst_seeds"}
    for one, two in zip(
        tournament_rows(records), tournament_rows(other), strict=True
    ):
        for name in set(one) - untold:
            assert one[name] == two[name], name


@given(games())
def test_lost_games_are_worse_than_any_that_was_survived(
    records: list[dict[str, Any]],
) -> None:
    for row in tournament_rows(records):
        own = {r["seed"]: r for r in records if r["evader"] == row["evader"]}
        worst = [own[seed] for seed in row["worst_seeds"]]
        assert len(worst) == min(5, len(own))
        survived = [r["outcome"] == "survived" for r in worst]
        assert survived == sorted(survived)
        lost = [r["survived_s"] for r in worst if r["outcome"] != "survived"]
        won = [r["closest_m"] for r in worst if r["outcome"] == "survived"]
        assert lost == sorted(lost) and won == sorted(won)
