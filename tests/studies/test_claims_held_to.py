"""Test expected values and tolerances against the numbers of the paper."""

from math import degrees, pi, sqrt
from statistics import fmean, stdev

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.studies.claim_jobs import JOBS
from stepaside.studies.claims import Claim, ClaimRow

SPEED, GAIN, STRIDE = 0.1, 0.2, 0.04  # of Sec. IV, in [m/s], [1/s], [m]
SINGLE, DOUBLE = 0.425, 0.122  # of the supports, in [s]
STEP = SINGLE + DOUBLE
RADIUS = 4.0 * SPEED / (pi * GAIN)
APART = sqrt(2.0) * RADIUS  # of the players on the circle, in [m]
UNIT = 4.0 / (pi * 0.5)  # the same with speeds of 1 m/s, gains of 1/2
EXACT = 1e-3

# Expected value, and tolerance of the mean of the runs.
EXPECTED = {
    "circle.pursuer_radius": (UNIT, EXACT),
    "circle.evader_radius": (UNIT, EXACT),
    "circle.one_circle": (0.0, EXACT),
    "circle.distance": (sqrt(2.0) * UNIT, EXACT),
    "circle.orientation": (pi / 2, EXACT),
    "circle.pursuer_speed": (1.0, EXACT),
    "circle.same_speed": (1.0, EXACT),
    "saturated.radius": (1.0 / 0.5, EXACT),
    "saturated.smaller": (1.0, 0.0),
    "saturated.less": (pi / 2, 0.0),
    "saturated.namely": (pi - 2.0, EXACT),
    "strategies.apart": (0.0, 1e-4),
    "strategies.grows": (1.0, 0.0),
    "strategies.unbounded": (2.0 / 0.5, 0.001 * 4.0),
    "strategies.back": (0.0, EXACT),
    "sampled.radius": (RADIUS, EXACT),
    "sampled.distance": (APART, EXACT),
    "sampled.orientation": (pi / 2, EXACT),
    "path.arc": (0.0, 1e-9),
    "path.way": (SPEED / GAIN, 1e-6),
    "path.heading": (1.0, 1e-9),
    "path.line": (0.0, 1e-9),
    "footsteps.stepsize": (STRIDE, 1e-6),
    "footsteps.sides": (0.5 * 0.1, 1e-6),
    "footsteps.tangent": (0.0, 1e-5),
    "com.bounded": (0.1, 0.0),
    "com.pendulum": (0.0, 1e-4),
    "com.integral": (0.0, 1e-6),
    "com.reached": (degrees(0.9), 1e-9),
    "timing.planning": (10.0, 0.0),
    "humanoids.pursuer_radius": (RADIUS, 0.04 * RADIUS),
    "humanoids.evader_radius": (RADIUS, 0.04 * RADIUS),
    "humanoids.one_circle": (0.0, 0.02),
    "humanoids.distance": (APART, 0.04 * APART),
    "humanoids.orientation": (90.0, 3.0),
    "humanoids.same_speed": (1.0, 0.04),
    "humanoids.settled": (2.0 / 3.0 * 120.0, 0.0),
    "humanoids.landings": (STEP, 0.02),
    "humanoids.both_feet": (1.0, 0.0),
    "humanoids.at_its_end": (0.5 * DOUBLE, 0.0),
    "humanoids.straight_part": (1.0, 0.0),
    "humanoids.place_jump": (0.0, 1e-8),
    "humanoids.velocity_jump": (0.0, 1e-6),
    "durations.printed_slide": (1.0, 0.0),
    "durations.printed_tilt": (3.0, 0.0),
    "durations.upright_for": (30.0, 1e-6),
    "durations.tilt": (10.0, 0.0),
    "durations.distance": (STRIDE / STEP * 29.2, 0.05 * STRIDE / STEP * 29.2),
    "durations.speed": (STRIDE / STEP, 0.1 * STRIDE),
    "slip.slide": (1.0, 0.0),
    "slip.slower": (1.0, 0.0),
    "slip.smaller": (1.0, 0.0),
    "evading.farther": (1.2, 0.0),
    "evading.best": (0.95, 0.0),
    "evading.survives": (1.0, 0.1),
    "evading.clear": (-1e-9, 0.0),
    "evading.aside": (0.1, 0.0),
    "evading.decision": (10.0, 0.0),
    "rooms.touched": (0.0, 0.0),
    "rooms.clear": (0.0, 0.0),
    "rooms.free": (40.0, 1e-6),
}
CLAIMS = {
    f"{name}.{claim.key}": claim
    for name, job in JOBS.items()
    for claim in job.claims
}


@pytest.mark.parametrize("name", CLAIMS)
def test_expected_value_and_tolerance_are_those_of_the_paper(
    name: str,
) -> None:
    claim = CLAIMS[name]
    found = claim.expected, claim.tolerance
    assert found == pytest.approx(EXPECTED[name], rel=1e-9, abs=1e-15)
    assert (claim.tolerance > 0.0) is (claim.relation == "=") or (
        name in ("humanoids.both_feet", "rooms.touched")  # counts
    )


@pytest.mark.parametrize(
    "name",
    [
        *("circle.pursuer_speed", "timing.planning"),
        *("humanoids.landings", "evading.decision"),
    ],
)
def test_text_names_the_expected_value(name: str) -> None:
    claim = CLAIMS[name]
    assert f"{claim.expected:.3g} {claim.unit}" in claim.text


@given(st.lists(st.floats(-5.0, 5.0), min_size=1, max_size=9))
def test_measured_value_is_the_mean_of_all_runs(
    values: list[float],
) -> None:
    """Whether the claim holds or not; with the standard deviation."""
    claim = Claim("x", "is one", "I", "steps", 1.0, "m", 0.1)
    row = ClaimRow("job.x", claim, tuple(values), "1")
    assert row.measured == pytest.approx(fmean(values))
    spread = stdev(values) if len(values) > 1 else 0.0
    assert row.spread == pytest.approx(spread, abs=1e-9)
    entries = row.to_json()
    assert (entries["least"], entries["greatest"]) == (
        min(values),
        max(values),
    )
    assert entries["runs"] == len(values)
    assert (entries["verdict"] == "holds") == row.holds
