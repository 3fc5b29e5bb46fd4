"""Test the circles of games: closed forms, a dense search, simulation."""

from math import cos, inf, nan, pi, sin

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.core.poses import wrap_angle
from stepaside.theory.unicycle import LAWS, Unicycles
from stepaside.theory.unicycle.circles import (
    Circle,
    circle_of,
    circles_of,
    find_circle,
)
from stepaside.theory.unicycle.simulation import play_games
from stepaside.theory.unicycle.start_maps import find_basins, random_starts

SATURATED = "saturated"
FAST = Unicycles(2.0, 1.0, 1.0, 4.0)
FAST_6 = Unicycles(2.0, 1.0, 1.0, 4.0, pi / 2, "saturated")


def random_games(count: int, seed: int = 8) -> np.ndarray:
    """Speeds and gains within a factor of e^0.9 of one, any angle."""
    rng = np.random.default_rng(seed)
    values = np.exp(rng.uniform(-0.9, 0.9, (count, 4)))
    return np.column_stack([values, rng.uniform(0.05, 3.1, count)])


def game_of(values: np.ndarray, law: str, rule: str) -> Unicycles:
    """Unicycles of a row of :func:`random_games`."""
    vp, ve, kp, ke, angle = (float(v) for v in values)
    return Unicycles(vp, ve, kp, ke, angle, law, side_rule=rule)


def rates(
    game: Unicycles, state: np.ndarray, evader_turns: float
) -> np.ndarray:
    """Rates of (r, a, psi) under the printed laws, at side +1."""
    r, a, psi = state
    vp, ve = game.pursuer_speed, game.evader_speed
    sight = (vp * sin(a) - ve * sin(psi)) / r
    closing = ve * cos(psi) - vp * cos(a)
    turn_p = game.pursuer_gain * wrap_angle(a)
    return np.array([closing, sight - turn_p, sight - evader_turns])


def evader_rate(game: Unicycles, circle: Circle, psi: float) -> float:
    """Turning rate of the evader near a circle; its own when it slides."""
    error = wrap_angle(psi + game.angle)
    if game.law == "proportional":
        return game.evader_gain * error
    if circle.sliding:
        return circle.turning_rate_rad_s
    return game.evader_gain * float(np.sign(error))


def state_of(circle: Circle) -> np.ndarray:
    return np.array(
        [circle.distance_m, circle.pursuer_error_rad, circle.bearing_rad]
    )


def test_faster_pursuer_has_a_close_reversed_circle_too() -> None:
    main, other = circles_of(FAST)
    assert (main.direction, other.direction) == (1, -1)
    assert main.distance_m == pytest.approx(2.0805, abs=1e-4)
    assert other.distance_m == pytest.approx(0.5876, abs=1e-4)
    assert main.behind and other.behind
    assert main.stable and other.stable
    near = circles_of(Unicycles(1.01, 1.0, 1.0, 4.0))[1]
    assert near.stable and near.distance_m < 0.03


@pytest.mark.parametrize("rule", ["behind", "latched"])
@pytest.mark.parametrize("law", LAWS)
def test_every_circle_is_an_equilibrium_of_the_printed_law(
    law: str, rule: str
) -> None:
    seen = 0
    for values in random_games(60):
        game = game_of(values, law, rule)
        for circle in circles_of(game):
            seen += 1
            state = state_of(circle)
            turn = evader_rate(game, circle, circle.bearing_rad)
            np.testing.assert_allclose(rates(game, state, turn), 0, atol=1e-9)
            rate = circle.turning_rate_rad_s
            assert rate == pytest.approx(turn)
            assert circle.direction == np.sign(rate)
            assert abs(rate) <= game.evader_gain * (
                1.0 + 1e-12 if game.saturated else pi
            )
            assert circle.distance_m > 0.0
            for error in (circle.pursuer_error_rad, circle.evader_error_rad):
                assert -pi < error <= pi
            assert circle.radius_evader_m * abs(rate) == pytest.approx(
                game.evader_speed
            )
            if rule == "behind":
                assert -pi < circle.bearing_rad < 0.0
            if circle.sliding:
                assert circle.evader_error_rad == 0.0
    assert seen > 40


def searched(game: Unicycles) -> list[float]:
    """Turning rates of the rests at side +1, by search over a plain grid."""
    vp, ve = game.pursuer_speed, game.evader_speed
    kp, ke, alpha = game.pursuer_gain, game.evader_gain, game.angle

    def crossings(x: np.ndarray, f: np.ndarray) -> list[float]:
        i = np.flatnonzero((f[1:] > 0) != (f[:-1] > 0))
        roots = x[i] + (x[i + 1] - x[i]) * f[i] / (f[i] - f[i + 1])
        return [float(root) for root in roots]

    line = np.linspace(-pi, pi, 40001)
    if not game.saturated:
        omega = line * min(kp, ke)
        f = ve * np.cos(omega / ke - alpha) - vp * np.cos(omega / kp)
        pairs = [(w, w / ke) for w in crossings(omega, f)]
    else:
        f = ve * cos(alpha) - vp * np.cos(line)
        slid = [kp * a for a in crossings(line, f)]
        pairs = [(w, 0.0) for w in slid if abs(w) < ke]
        for way in (-1.0, 1.0):
            if ke / kp < pi:
                f = ve * np.cos(line - alpha) - vp * cos(ke / kp)
                bs = crossings(line, f)
                pairs += [(way * ke, b) for b in bs if way * b > 0.0]
    return sorted(
        w for w, b in pairs if (vp * sin(w / kp) - ve * sin(b - alpha)) / w > 0
    )


@pytest.mark.parametrize("law", LAWS)
def test_dense_search_finds_no_other_circle(law: str) -> None:
    for values in random_games(150, seed=9):
        game = game_of(values, law, "latched")
        ours = sorted(c.turning_rate_rad_s for c in circles_of(game))
        assert ours == pytest.approx(searched(game), abs=1e-6), values


def test_two_nearly_coincident_circles_are_both_found() -> None:
    """Up to the speed at which two of one direction meet and are gone."""
    gaps = []
    for speed in np.linspace(1.2629, 1.26545, 60):
        game = Unicycles(
            float(speed), 1.2627, 0.8583, 0.503, 0.0792, side_rule="latched"
        )
        ours = sorted(c.turning_rate_rad_s for c in circles_of(game))
        assert ours == pytest.approx(searched(game), abs=1e-5)
        if len(ours) == 2:
            gaps.append(ours[1] - ours[0])
    piece = 2.0 * pi * 0.503 / 96
    assert min(gaps) < 0.5 * piece < piece < max(gaps)


def test_reversed_circle_is_behind_only_where_the_pursuer_is_faster() -> None:
    """There r = (v_p sin|a| - v_e sin|psi|) / |omega|, cosines equal."""
    seen = 0
    for values in random_games(200):
        for law in LAWS:
            for circle in circles_of(game_of(values, law, "behind")):
                if circle.direction < 0:
                    seen += 1
                    assert values[0] > values[1]
    assert seen > 20


@pytest.mark.parametrize("law", LAWS)
def test_eigenvalues_are_those_of_the_printed_law(law: str) -> None:
    """Finite differences of the rates, of the sliding motion if it slides."""
    h = 1e-6
    for values in random_games(25):
        game = game_of(values, law, "latched")
        for circle in circles_of(game):
            rest = state_of(circle)
            columns = []
            for j in range(3):
                step = h * np.eye(3)[j]
                ends = [
                    rates(game, s, evader_rate(game, circle, s[2]))
                    for s in (rest + step, rest - step)
                ]
                columns.append((ends[0] - ends[1]) / (2.0 * h))
            size = 2 if circle.sliding else 3
            matrix = np.array(columns).T[:size, :size]
            expected = np.linalg.eigvals(matrix)
            np.testing.assert_allclose(
                np.poly(np.array(circle.eigenvalues)),
                np.poly(expected),
                atol=1e-5,
            )
            slowest = float(expected.real.max())
            assert circle.stable == (slowest < 0.0)


def test_main_circle_comes_first_and_only_once() -> None:
    for values in random_games(80):
        for law in LAWS:
            for rule in ("behind", "latched"):
                game = game_of(values, law, rule)
                main, found = circle_of(game), circles_of(game)
                if main.exists:
                    assert found[0] == main
                states = [state_of(c) for c in found]
                for i, one in enumerate(states):
                    for other in states[:i]:
                        assert np.abs(one - other).max() > 1e-6
                ways = [c.direction for c in found]
                assert ways == sorted(ways, reverse=True)


def test_hysteresis_lets_circles_beyond_the_axis_stay() -> None:
    game = Unicycles(1.3, 1.0, 1.0, 1.0, 1.2, hysteresis=1.0)
    inside = circle_of(game)
    assert inside in circles_of(game)
    kept = circles_of(Unicycles(1.0, 1.0, 0.5, 0.5, 1.2, side_rule="latched"))
    reversed_one = kept[1]  # at the bearing -pi - 0.6
    for width, expected in ((0.0, False), (0.59, False), (0.61, True)):
        behind = Unicycles(1.0, 1.0, 0.5, 0.5, 1.2, hysteresis=width)
        assert (reversed_one in circles_of(behind)) == expected


@pytest.mark.parametrize("game", [FAST, FAST_6])
def test_every_game_settles_on_one_of_two_circles(game: Unicycles) -> None:
    starts = random_starts(game, 150, seed=3)
    found = find_basins(game, starts)
    assert ((found.circle >= 0) | found.captured).all()
    assert 0.1 < found.shares(2)[1] < 0.35
    near = np.array([state_of(c) for c in circles_of(game)])
    mirrored = near * [1.0, -1.0, -1.0]
    out = play_games(game, [*near, *mirrored], 5.0)
    assert out.circle.tolist() == [0, 1, 0, 1]
    assert out.settled_time.max() < 0.1
    assert out.sides.tolist() == [1, 1, -1, -1]


def test_side_of_the_smaller_error_is_the_side_behind() -> None:
    for angle in (0.4, pi / 2, 2.9):
        for psi in np.linspace(-3.1, 3.1, 41):
            errors = {s: abs(wrap_angle(psi + s * angle)) for s in (-1, 1)}
            smaller = min(errors, key=lambda s: errors[s])
            assert smaller == (-1 if psi > 0.0 else 1) or psi == 0.0


@pytest.mark.parametrize("alpha", [1e-6, 0.1, 0.9, pi / 2, 2.5, pi])
def test_equal_players_follow_the_closed_form(alpha: float) -> None:
    v, k = 0.7, 0.3
    circle = find_circle(v, v, k, k, alpha)
    assert circle.radius_evader_m == pytest.approx(2 * v / (k * alpha))
    assert circle.distance_m == pytest.approx(
        4 * v * sin(alpha / 2) / (k * alpha), rel=1e-10
    )
    assert circle.motions_apart_rad == pytest.approx(alpha)
    assert circle.headings_apart_rad == pytest.approx(pi - alpha)
    root = np.emath.sqrt(1 - alpha**2)
    expected = [-k, k / 2 * (-1 + root), k / 2 * (-1 - root)]
    np.testing.assert_allclose(
        np.poly(np.array(circle.eigenvalues)),  # coefficients: no order
        np.poly(np.array(expected)),
        atol=1e-9,
    )
    assert circle.stable


def test_saturated_circle_at_full_rate() -> None:
    circle = find_circle(1, 1, 1, 1, pi / 2, SATURATED)
    assert circle.radius_pursuer_m == pytest.approx(1.0)
    assert circle.distance_m == pytest.approx(2 * sin(1.0))
    assert circle.headings_apart_rad == pytest.approx(pi - 2.0)
    np.testing.assert_allclose(
        circle.eigenvalues,
        [-0.2668 + 1.0005j, -0.2668 - 1.0005j, -0.4663],
        atol=1e-4,
    )
    assert not circle.sliding


@pytest.mark.parametrize("alpha", [0.05, 0.3, 0.99])
def test_saturated_circle_slides_below_one_radian(alpha: float) -> None:
    v, k = 0.4, 0.6
    circle = find_circle(v, v, k, k, alpha, "saturated")
    assert circle.sliding and circle.stable
    assert circle.radius_pursuer_m == pytest.approx(v / (k * alpha))
    assert circle.distance_m == pytest.approx(2 * v * sin(alpha) / (k * alpha))


def test_closed_forms_of_equal_speeds_and_of_equal_gains() -> None:
    for vp, ve, kp, ke, alpha in random_games(200):
        circle = find_circle(vp, vp, kp, ke, alpha)
        rate = alpha / (1.0 / kp + 1.0 / ke)
        if rate < pi * min(kp, ke):
            assert circle.turning_rate_rad_s == pytest.approx(rate)
        circle = find_circle(vp, ve, kp, kp, alpha)
        rate = kp * float(np.arctan2(vp - ve * cos(alpha), ve * sin(alpha)))
        assert circle.exists == (0.0 < rate < kp * alpha)
        if circle.exists:
            assert circle.turning_rate_rad_s == pytest.approx(rate)


def test_every_circle_balances() -> None:
    """Closing speed is zero, the line of sight turns with the players."""
    found = 0
    for vp, ve, kp, ke, alpha in random_games(300):
        for law in LAWS:
            circle = find_circle(vp, ve, kp, ke, alpha, law)
            if not circle.exists:
                continue
            found += 1
            a, b = circle.pursuer_error_rad, circle.evader_error_rad
            u = alpha - b
            omega = circle.turning_rate_rad_s
            assert ve * cos(u) == pytest.approx(vp * cos(a), abs=1e-12)
            sight = (ve * sin(u) + vp * sin(a)) / circle.distance_m
            assert sight == pytest.approx(omega)
            assert omega == pytest.approx(kp * a)
            assert 0 <= b < alpha + 1e-12
            if law == "proportional":
                assert omega == pytest.approx(ke * b)
            else:
                assert omega <= ke * (1 + 1e-12)
                # Equal to rounding is the full rate, not sliding.
                assert circle.sliding == (omega < ke * (1 - 1e-12))
    assert found > 300


@pytest.mark.parametrize("value", [0.0, -1.0, nan, inf])
@pytest.mark.parametrize("place", range(4))
def test_bad_values_are_refused(place: int, value: float) -> None:
    values = [1.0, 1.0, 1.0, 1.0]
    values[place] = value
    with pytest.raises(PlanError, match=f"must be finite and > 0 .*{value}"):
        find_circle(values[0], values[1], values[2], values[3])
