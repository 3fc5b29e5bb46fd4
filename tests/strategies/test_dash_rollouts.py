"""Test rollouts of dashes against their closed forms."""

from math import atan2, cos, inf, pi

import numpy as np
import pytest

from stepaside.core.poses import ALL_AROUND, Pose, Sector
from stepaside.strategies.dash_evasion import (
    STEP,
    Opponent,
    closest_approaches,
    make_dashes,
    roll_out,
    unseen_shares,
)
from stepaside.strategies.velocity_set import (
    STILL,
    AxisValues,
    VelocitySet,
    greatest_velocity,
)

FAST, SLOW = 0.8, 0.4
AT_ONCE = VelocitySet((-FAST, FAST), (-SLOW, SLOW), (-1.0, 1.0))
WITH_LAG = AT_ONCE._replace(lags=AxisValues(0.3, 0.5, 0.0))
HERE = Pose(1.0, -2.0, 0.4)
NO_FEINT = np.zeros(1)


def test_someone_who_passes_is_unseen_while_behind() -> None:
    """Passes a standing robot at 1 m: in view for half of the way."""
    standing = make_dashes(4, HERE.theta, AT_ONCE, inf)
    paths = np.broadcast_to([HERE.x, HERE.y], (41, 9, 2))
    _, headings = roll_out(HERE, STILL, standing, AT_ONCE, 1)
    start = HERE.compose(Pose(2.0, 1.0, pi))
    passer = Opponent(start.x, start.y, start.theta, 1.0)
    ahead, behind = (Sector(middle, 0.5 * pi - 1e-6) for middle in (0.0, pi))
    for views in ((ahead,), (behind,)):
        shares = unseen_shares(paths, headings, passer, views)
        np.testing.assert_allclose(shares, 20 / 41, atol=0.03)
    assert not unseen_shares(paths, headings, passer, ALL_AROUND).any()


def test_the_greatest_velocity_is_on_the_edge_of_the_set() -> None:
    for angle in np.linspace(-pi, pi, 17).tolist():
        ahead, left = greatest_velocity(angle, AT_ONCE)
        assert (ahead / FAST) ** 2 + (left / SLOW) ** 2 == pytest.approx(1.0)
        assert cos(atan2(left, ahead) - angle) == pytest.approx(1.0)
    unicycle = AT_ONCE._replace(lateral=(0.0, 0.0))
    assert greatest_velocity(pi / 3, unicycle) == pytest.approx(
        (0.5 * FAST, 0.0)
    )


@pytest.mark.parametrize("offset", [0.0, 0.7])
def test_a_straight_opponent_passes_at_its_offset(offset: float) -> None:
    opponent = Opponent(-4.0, offset, 0.0, 1.4)
    stands = np.zeros((61, 1, 2))
    found = closest_approaches(stands, opponent, inf, NO_FEINT)
    assert found[0] == pytest.approx(offset, abs=0.5 * 1.4 * STEP)


def test_an_opponent_cannot_turn_within_its_radius() -> None:
    """A point that stands beside it, inside its circle, is not reached."""
    radius, aside = 2.0, 1.2
    opponent = Opponent(0.0, 0.0, 0.0, 1.0)
    stands = np.zeros((21, 1, 2))
    stands[..., 1] = aside
    found = closest_approaches(stands, opponent, radius, NO_FEINT)
    assert found[0] == pytest.approx(aside, abs=0.5 * STEP**2)
    assert closest_approaches(stands, opponent, 0.3, NO_FEINT)[0] < 0.2


def test_mirrored_games_mirror_the_values() -> None:
    count = 12
    pose = Pose(0.0, 0.0, 0.0)
    dashes = make_dashes(count, pose.theta, WITH_LAG, 0.6)
    paths, _ = roll_out(pose, STILL, dashes, WITH_LAG, 40)
    left = Opponent(-3.0, 0.3, 0.1, 1.4)
    right = left._replace(y=-left.y, course=-left.course)
    one, other = (
        closest_approaches(paths, each, 2.5, np.array([0.0, 1.0, -1.0]))
        for each in (left, right)
    )
    mirrored = 1 + (-np.arange(count)) % count
    quarter = [1 + count // 4, 1 + 3 * count // 4]  # the body may turn either
    kept = [i for i in range(count) if i + 1 not in quarter]
    np.testing.assert_allclose(
        one[1 : count + 1][kept], other[mirrored][kept], atol=1e-9
    )
