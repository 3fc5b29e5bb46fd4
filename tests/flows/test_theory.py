"""Unicycles, their circles and maps, optimal evasion, and the claims."""

from math import asin, atan2, cos, hypot, pi, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

import stepaside as sa
from flows.calls import recorded_claims, stepaside, summary
from flows.circles import circle, closest_of_unicycles

FIGURE_2 = circle(speed=1.0, gain=0.5)


def test_fig_2_of_the_paper(tmp_path: Path) -> None:
    seen = summary(
        *("run", "unicycles", "--speed", 1, "--gain", 0.5, "--angle", "90deg"),
        *("--figure", tmp_path / "fig2.svg"),
    )
    assert FIGURE_2.radius == pytest.approx(2.546, abs=1e-3)
    assert not seen["captured"]
    assert seen["radius_pursuer_m"] == pytest.approx(FIGURE_2.radius, rel=1e-6)
    assert seen["radius_evader_m"] == pytest.approx(FIGURE_2.radius, rel=1e-6)
    assert seen["distance_m"] == pytest.approx(FIGURE_2.distance, rel=1e-6)
    assert seen["headings_apart_rad"] == pytest.approx(pi / 2, abs=1e-6)
    start = seen["start"]
    closest = closest_of_unicycles(
        (start["distance"], start["pursuer_error"], start["bearing"]),
        40.0,
        speed=1.0,
        gain=0.5,
    )
    assert seen["closest_distance_m"] == pytest.approx(closest, abs=1e-4)
    assert "<svg" in (tmp_path / "fig2.svg").read_text()[:1000]


@pytest.mark.parametrize("angle", [45, 90])
def test_unicycles_of_the_saturated_law(angle: int) -> None:
    game = sa.Unicycles(1.0, 1.0, 0.5, 0.5, radians(angle), "saturated")
    goal = circle(radians(angle), saturated=True, speed=1.0, gain=0.5)
    found = sa.find_circle(1.0, 1.0, 0.5, 0.5, radians(angle), "saturated")
    assert found.distance_m == pytest.approx(goal.distance)
    start = sa.RelativeStart(goal.distance * 1.2, 0.3, -0.2)
    played = sa.simulate(game, start, 80.0)
    assert played.states(80.0)[0, 0] == pytest.approx(goal.distance, rel=1e-3)


def test_a_certificate_bounds_what_is_played() -> None:
    """By the formula of unicycles.md: the plain bound is no better."""
    speed, gain = 0.1, 0.2
    goal = circle()
    start = sa.RelativeStart(1.0, 0.3, -0.4)
    game = sa.Unicycles(speed, speed, gain, gain)
    closest = closest_of_unicycles(
        (1.0, 0.3, -0.4), 150.0, speed=speed, gain=gain
    )
    half, lead = (0.3 - 0.4) / 2, 0.3 + 0.4 - pi / 2
    off = hypot(1.0 * cos(half) - goal.distance, 1.0 * sin(half))
    plain = goal.distance - off - speed / gain * abs(lead)
    found = sa.certify(game, start)
    assert found is not None
    assert plain < found <= closest
    played = sa.simulate(game, start, 150.0)
    assert played.closest_distance == pytest.approx(closest, abs=1e-5)
    many = sa.play_games(game, [(1.0, 0.3, -0.4)], 150.0)
    assert many.closest_distance[0] == pytest.approx(closest, abs=1e-5)


def test_circles_and_basins_of_a_faster_pursuer() -> None:
    """A close reversed circle draws a fifth of all starts."""
    fast, slow, one, four = 2.0, 1.0, 1.0, 4.0
    seen = summary(
        *("theory", "circle", "--set", f"pursuer_speed={fast}"),
        *("--set", f"evader_speed={slow}", "--set", f"pursuer_gain={one}"),
        *("--set", f"evader_gain={four}"),
        *("--angle", "90deg", "--starts", 150),
    )
    main, reversed_one = seen["circles"]
    for each in (main, reversed_one):
        turn = each["turning_rate_rad_s"]
        # v_e cos(α - ω/k_e) = v_p cos(ω/k_p), and then r.
        aim, lag = turn / one, pi / 2 - turn / four
        assert slow * cos(lag) == pytest.approx(fast * cos(aim), abs=1e-9)
        assert each["distance_m"] == pytest.approx(
            (slow * sin(lag) + fast * sin(aim)) / turn
        )
        assert each["radius_pursuer_m"] == pytest.approx(fast / abs(turn))
        assert each["radius_evader_m"] == pytest.approx(slow / abs(turn))
        assert each["stable"]
    assert main["direction"] == 1 and reversed_one["direction"] == -1
    # 20.8 % of 400 other starts; three standard deviations of 150.
    assert reversed_one["share"] == pytest.approx(0.208, abs=0.10)
    assert main["share"] + reversed_one["share"] == pytest.approx(1.0)


def test_stability_of_the_main_circle() -> None:
    """Eigenvalues -k and (k/2)(-1 ± sqrt(1 - α²))."""
    angle, gain = 0.6, 0.5
    seen = summary("theory", "circle", "--angle", angle, "--starts", 0)
    rates = sorted(real for real, _ in seen["eigenvalues_per_s"])
    slow, quick = (
        gain / 2 * (-1 + sign * sqrt(1 - angle**2)) for sign in (1, -1)
    )
    assert rates == pytest.approx(sorted([-gain, slow, quick]))
    goal = circle(angle, speed=1.0, gain=gain)
    assert seen["distance_m"] == pytest.approx(goal.distance)
    assert seen["radius_pursuer_m"] == pytest.approx(goal.radius)


def test_a_map_finds_the_worst_start() -> None:
    """That of a pursuer that looks past the evader is within the grid."""
    seen = summary(
        *("theory", "map", "--speed", 0.1, "--gain", 0.2, "--grid", 5),
        *("--nearest", 0.8, "--farthest", 1.2, "--set", "distances=3"),
        *("--set", "facing=30.5deg", "--set", "aim=120deg"),
    )
    assert seen["games"] == 3 * 5 * 5
    worst = seen["worst_start"]
    start = (
        worst["distance_m"],
        worst["pursuer_error_rad"],
        worst["bearing_rad"],
    )
    assert start[0] == pytest.approx(0.8)
    assert abs(start[2]) == pytest.approx(radians(30.5))
    beside, closest, other = (
        closest_of_unicycles(
            (start[0], start[1] + off, start[2]), 60.0, speed=0.1, gain=0.2
        )
        for off in (-0.1, 0.0, 0.1)
    )
    assert closest < min(beside, other) - 1e-4
    assert seen["min_distance_m"] == pytest.approx(closest, abs=1e-3)
    assert seen["captured_share"] == 0.0 and seen["settled_share"] == 1.0
    (found,) = seen["circles"]
    assert found["distance_m"] == pytest.approx(circle().distance)


def grazing_starts() -> list[tuple[float, float, float]]:
    """States of two identical cars from which capture just grazes.

    Back from a grazed circle of radius 1 (turning radii), with the pursuer
    turning left and the evader right: Merz's barrier, its first piece.
    Distance, bearing of the evader, bearing of the pursuer from the evader.
    """
    found = []
    for side in np.linspace(0.3, 1.2, 7):
        for time in (0.5, 1.0):
            x, y, theta = cos(side), sin(side), 2 * side
            for _ in range(400):
                step = -time / 400
                dx, dy = cos(theta) - 1 + y, sin(theta) - x
                mx, my = x + dx * step / 2, y + dy * step / 2
                mid = theta - step
                x += (cos(mid) - 1 + my) * step
                y += (sin(mid) - mx) * step
                theta -= 2 * step
            aim = atan2(y, x)
            bearing = (aim - theta + pi) % (2 * pi) - pi
            found.append((hypot(x, y), aim, bearing))
    return found


def test_optimal_evasion_of_a_car_has_merzs_barrier(tmp_path: Path) -> None:
    from stepaside.theory.value import load_table
    from stepaside.theory.value.two_cars import car_poses

    table = tmp_path / "cars.npz"
    stepaside(
        *(
            "theory",
            "bound",
            "--against",
            "any",
            "--set",
            "pursuer_turn=1",
            "--capture",
            1,
        ),
        *("--grid", 16),
        *("--set", "horizon=1.6"),
        *("--output", table),
    )
    starts = np.array(grazing_starts())
    poses = car_poses(*starts.T)
    values = load_table(table).value(poses)
    assert abs(values - 1.0).max() < 0.04
    mirrored = load_table(table).value(poses * [1, -1, -1])
    np.testing.assert_allclose(mirrored, values, atol=1e-9)


def test_a_person_is_escaped_as_isaacs_says() -> None:
    """The homicidal chauffeur: c*/R = sqrt(1 - γ²) + γ asin γ - 1."""
    person, robot, radius = 1.4, 0.9, 4.0
    ratio = robot / person
    closed = radius * (sqrt(1 - ratio**2) + ratio * asin(ratio) - 1)
    seen = summary(
        *("theory", "bound", "--against", "person", "--pursuer-speed", person),
        *("--evader-speed", robot),
        *("--set", f"person_turning_radius={radius}"),
        *("--grid", 30),
    )
    assert seen["closed_form_m"] == pytest.approx(closed)
    assert seen["guaranteed_m"] == pytest.approx(closed, rel=0.05)
    assert seen["avoidable"] is (seen["capture_m"] < closed)


def test_reproduce_measures_claims_of_the_paper(tmp_path: Path) -> None:
    """One share of thirteen: the circle of the unicycles."""
    claims = recorded_claims(tmp_path, "1/13")
    assert list(claims) == ["circle"]
    seen = claims["circle"]
    assert seen["pursuer_radius"] == pytest.approx(FIGURE_2.radius)
    assert seen["evader_radius"] == pytest.approx(FIGURE_2.radius)
    assert seen["distance"] == pytest.approx(FIGURE_2.distance)
    assert seen["orientation"] == pytest.approx(pi / 2)
    assert seen["one_circle"] == pytest.approx(0.0, abs=1e-6)
