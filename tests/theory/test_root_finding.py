"""Test the search of sign changes."""

from math import cos, pi, sin

import pytest

from stepaside.theory.unicycle.root_finding import bisect, sign_changes


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_bisection_ends_at_the_last_number(sign: float) -> None:
    assert bisect(lambda x: sign * cos(x), 0.0, 3.0) == pytest.approx(
        pi / 2, abs=3e-16
    )


def test_all_sign_changes_are_found_in_order() -> None:
    found = sign_changes(sin, 0.5, 10.0)
    assert found == pytest.approx([pi, 2.0 * pi, 3.0 * pi])
    assert sign_changes(sin, 0.0, 3.0) == []  # the lower end is open
    assert sign_changes(sin, 4.0, 3.0) == sign_changes(sin, 4.0, 4.0) == []


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("center", [0.5013, 0.00131, 0.99731])
def test_close_pair_between_two_knots_is_found(
    sign: float, center: float
) -> None:
    half = 1e-5

    def touch(x: float) -> float:
        return sign * ((x - center) ** 2 - half**2)

    found = sign_changes(touch, 0.0, 1.0)
    assert found == pytest.approx([center - half, center + half], abs=1e-12)
    assert sign_changes(lambda x: sign * (x - center) ** 2, 0.0, 1.0) == []
    away = sign_changes(lambda x: touch(x) + sign * 2e-10, 0.0, 1.0)
    assert away == []
