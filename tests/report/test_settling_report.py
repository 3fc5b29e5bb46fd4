"""Why a duel is not on its circle yet."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from stepaside.games.duel_settings import DuelSettings
from stepaside.games.outcome import Outcome
from stepaside.games.run import DuelRun
from stepaside.games.trajectory import Trajectory
from stepaside.report.settling_report import (
    explain_missing_circle,
    settling_time,
)
from synthetic_run import changed, run_of

TIMES = np.linspace(0.0, 60.0, 601)
STANDING = Trajectory(np.zeros((601, 3)), np.zeros((601, 3)))


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
        (
            pi / 2,
            20.0,
            "not reached: 40 s of evasion; time constant of the "
            "theory's slowest mode 14 s",
        ),
        (pi / 2, None, "not reached: the evader was never triggered"),
        (0.0, 20.0, "not expected: the theory has no stable circle"),
    ],
)
def test_it_is_said_why_the_circle_was_not_reached(
    angle: float, since: float | None, words: str
) -> None:
    told = explain_missing_circle(made(angle, since))
    assert told.startswith(words)


@pytest.mark.parametrize("expected", ["contact", "no circle"])
def test_time_is_not_missing_where_no_circle_was_expected(
    expected: str,
) -> None:
    assert (
        explain_missing_circle(made(pi / 2, 20.0, expected)) == "not expected"
    )


@pytest.mark.parametrize(
    ("outcome", "words"),
    [
        (Outcome.COMPLETED, "not reached, unlike in theory: "),
        (Outcome.FALL, "not reached by 60 s: "),
    ],
)
def test_it_is_said_when_theory_is_on_the_circle(
    outcome: Outcome, words: str
) -> None:
    run = made(pi / 2, 20.0, "circle", 34.0, outcome)
    told = explain_missing_circle(run)
    assert told == f"{words}the template reaches it at 34 s"


def made(
    angle: float,
    since: float | None,
    expected: str | None = None,
    circle: float | None = None,
    outcome: Outcome = Outcome.COMPLETED,
) -> DuelRun:
    """Run of 60 s that did not come to its circle."""
    tracks = {"pursuer": STANDING, "evader": STANDING}
    settings = with_angle(angle)
    run = run_of(TIMES, tracks, settings=settings, outcome=outcome)
    theory = replace(
        run.summary.theory, expected=expected, circle_since_s=circle
    )
    return changed(run, triggered_at_s=since, theory=theory)
