"""Test the forecast of a duel against an independent integrator."""

from dataclasses import replace
from math import atan2, cos, hypot, pi, radians, sin
from typing import Any

import pytest

from stepaside.core.poses import wrap_angle
from stepaside.games.forecast import circle_of_theory, forecast, time_scale
from stepaside.games.game_settings import GameSettings, StartSettings, duel
from stepaside.games.game_starts import with_starts
from stepaside.games.summary import TheorySummary
from stepaside.strategies import Evasion

pytestmark = pytest.mark.usefixtures("blank_figures")

START = StartSettings(1.2, 0.4, -0.3)
BASE = duel(duration=80.0, start=START)


def told(settings: GameSettings) -> TheorySummary:
    """Return the forecast of a duel that has one."""
    return forecast(with_starts(settings))


def playing(**strategy: Any) -> GameSettings:
    return BASE.changed(evasion=Evasion(**strategy))


def turning(gain: float) -> GameSettings:
    return BASE.changed(gait=replace(BASE.gait, gain=gain))


def closest(settings: GameSettings, step: float = 0.005) -> float:
    """Return the closest approach of the unicycles by the laws (1)-(4)."""
    gait, start = settings.gait, settings.start
    assert start.distance is not None
    assert start.pursuer_offset is not None
    assert start.evader_offset is not None
    v, k = (time_scale(gait) * one for one in (gait.speed, gait.gain))
    x, y, p = 0.0, 0.0, start.pursuer_offset
    u, w, e = start.distance, 0.0, pi + start.evader_offset
    side, least = 0, start.distance
    for _ in range(round(settings.duration / step)):
        sight = atan2(w - y, u - x)
        away = hypot(u - x, w - y)
        least = min(least, away)
        psi = wrap_angle(sight + pi - e)
        p += step * k * wrap_angle(sight - p)
        x, y = x + step * v * cos(p), y + step * v * sin(p)
        if side == 0 and away < settings.evader.evasion.safety_radius:
            side = -1 if psi > 0.0 else 1
        if side:
            error = wrap_angle(psi + side * settings.evader.evasion.angle)
            e += step * k * error
            u, w = u - step * v * cos(e), w - step * v * sin(e)
    return least


@pytest.mark.parametrize("seed", range(3))
def test_a_default_duel_is_expected_on_the_circle(seed: int) -> None:
    found = told(duel(seed=seed, duration=90.0))
    assert found.expected == "circle"
    assert found.circle_since_s is not None
    assert 0.0 < found.circle_since_s < 60.0
    assert found.min_distance_m is not None and found.min_distance_m > 0.4
    soon = told(duel(seed=seed, duration=8.0))
    assert soon.expected == "later" and soon.circle_since_s is None
    assert soon.words == "the circle, not within 8 s"


@pytest.mark.parametrize(
    "settings",
    [
        *(turning(gain) for gain in (0.15, 0.2, 0.6, 1.2)),
        *(playing(angle=radians(angle)) for angle in (60.0, 110.0, 135.0)),
        *(
            replace(BASE, start=replace(START, evader_offset=offset))
            for offset in (1.5, 2.4, 3.0)
        ),
    ],
)
def test_the_closest_approach_is_that_of_the_unicycles(
    settings: GameSettings,
) -> None:
    """Except for the first double support and decisions once per step."""
    assert told(settings).min_distance_m == pytest.approx(
        closest(settings), abs=0.08
    )


def test_a_mirrored_duel_has_the_same_forecast() -> None:
    for offsets in ((0.9, 0.5), (-0.3, 2.8)):
        one, other = (
            told(replace(BASE, start=StartSettings(0.9, s * a, s * b)))
            for s, (a, b) in ((1.0, offsets), (-1.0, offsets))
        )
        assert one.min_distance_m == pytest.approx(
            other.min_distance_m, abs=1e-9
        )
        assert one.expected == other.expected


@pytest.mark.parametrize("gain", [0.6, 0.8, 1.2])
def test_a_circle_too_small_for_two_bodies_is_contact(gain: float) -> None:
    settings = turning(gain)
    circle = circle_of_theory(settings)
    assert circle.distance_m < settings.start.least
    found = told(settings)
    assert found.expected == "contact"


@pytest.mark.parametrize("offset", [pi, -3.0, 2.8])
def test_contact_is_expected_with_an_evader_that_faces_away(
    offset: float,
) -> None:
    settings = replace(BASE, start=replace(START, evader_offset=offset))
    assert told(settings).expected == "contact"
