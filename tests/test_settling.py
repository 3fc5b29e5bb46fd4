"""Why a duel is not on its circle yet."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest

from invented_run import changed, run_of
from stepaside.games.settings import DuelSettings
from stepaside.games.track import Track
from stepaside.report.settling import settling_time, settling_words

TIMES = np.linspace(0.0, 60.0, 601)
STANDING = Track(np.zeros((601, 3)), np.zeros((601, 3)))


def with_angle(angle: float) -> DuelSettings:
    settings = DuelSettings()
    return replace(settings, strategy=replace(settings.strategy, angle=angle))


@pytest.mark.parametrize("angle", [0.05, 0.1, 0.2])
def test_small_angles_settle_as_slowly_as_theory_says(angle: float) -> None:
    """The slowest mode has the time 4 / (k alpha^2), in path time."""
    settings = with_angle(angle)
    found = settling_time(settings)
    gait = settings.gait
    path_time = 4.0 / (gait.gain * angle**2)
    expected = path_time * gait.step_duration / gait.path_interval
    assert found == pytest.approx(expected, rel=0.2 * angle)


def test_a_game_without_a_circle_settles_nowhere() -> None:
    assert settling_time(with_angle(0.0)) is None


@pytest.mark.parametrize(
    ("angle", "since", "words"),
    [
        (pi / 2, 20.0, "40 s of evasion; theory's slowest mode takes 14 s"),
        (pi / 2, None, "never triggered"),
        (0.0, 20.0, "theory has none"),
    ],
)
def test_it_is_said_why_the_circle_was_not_reached(
    angle: float, since: float | None, words: str
) -> None:
    tracks = {"pursuer": STANDING, "evader": STANDING}
    run = run_of(TIMES, tracks, settings=with_angle(angle))
    told = settling_words(changed(run, triggered_at_s=since))
    assert told.startswith("not reached: ") and words in told
    assert inf not in (settling_time(run.settings), 0.0)
