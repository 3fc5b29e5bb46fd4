"""``stepaside duel``: a duel of two humanoids in physics."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..core.constants import CAPTURE_DISTANCE
from ..games.duel_settings import DuelSettings
from .options import folder_option, json_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import takes_settings
from .tables import print_table
from .terminal import echo

if TYPE_CHECKING:
    from ..games.duel_summary import DuelSummary
    from ..games.run import DuelRun
    from ..games.sight_summary import PerceptionSummary

NAMED = (
    *("seed", "duration", "robot", "gait", "body"),
    *("sensing", "room.plan", "start.distance", "evader_strategy", "pursuer"),
)
"""Settings of a duel with an option of their own."""


@click.command("duel")
@takes_settings(NAMED, settings=DuelSettings)
@folder_option()
@json_option
def duel(settings: DuelSettings, output: Path | None, as_json: bool) -> None:
    """Simulate a duel of two humanoids in physics.

    Prints values measured over the last third of the duel beside those of
    theory, and writes a run folder with the configuration, the trajectories
    and a figure.
    """
    from ..games.recorded_game import run_duel

    folder = run_folder(output, as_json, f"duel-seed{settings.seed}")
    _warn_of_expected_end(settings)
    run = play_with_bar(settings, run_duel)
    finish_run(run, folder, as_json, lambda: print_duel(run))


def _warn_of_expected_end(settings: DuelSettings) -> None:
    """Print a warning if two robots are not expected to reach a circle."""
    from ..games.forecast import ExpectedEnd, forecast
    from ..games.initial_poses import with_initial_poses

    end = forecast(with_initial_poses(settings))
    if end and end.expected in (ExpectedEnd.CONTACT, ExpectedEnd.NO_CIRCLE):
        echo(f"stepaside: expected outcome: {end.words}", err=True)


def print_duel(run: "DuelRun") -> None:
    """Print the summary of a duel beside theory."""
    summary = run.summary
    converged = summary.converged_at_s
    plans = summary.plan_time_us
    rows = [
        ("outcome", f"{run.outcome.value}: {run.message}"),
        ("start distance", f"{summary.start.distance_m:.3f} m"),
        ("expected", summary.theory.words or "-"),
        *_circle_rows(summary, 2.0 / 3.0 * run.duration),
        ("captured", _capture_text(summary.captured_at_s)),
        (
            "on the circle",
            missing_circle(summary)
            if converged is None
            else f"since {converged:.1f} s",
        ),
        ("maneuvers planned", str(summary.replans)),
        (
            "planning time",
            "-"
            if plans.median is None
            else f"{plans.median:.0f} us median, {plans.p99:.0f} us p99",
        ),
        ("simulation speed", f"{summary.real_time_factor:.1f} x real time"),
        *(("note", note) for note in summary.notes),
    ]
    if summary.sight is not None:
        rows += _sight_rows(summary, summary.sight)
    print_table(rows)


def missing_circle(summary: "DuelSummary") -> str:
    """Return why a duel did not end on its circle."""
    theory = summary.theory
    if theory.expected in ("contact", "no circle"):
        return "not expected"
    if summary.triggered_at_s is None:
        return "not reached: the evader was never triggered"
    if theory.circle_since_s is not None:
        since = f"{theory.circle_since_s:.0f} s"
        return f"not reached: the template reaches it at {since}"
    return "not reached"


def _circle_rows(
    summary: "DuelSummary", begin: float
) -> list[tuple[str, str]]:
    """Return values beside theory, marked where there was no circle yet.

    Args:
        summary: Summary of the duel.
        begin: Time from which the values are measured, in [s].
    """
    theory, since = summary.theory, summary.converged_at_s
    rows = []
    for name, value, expected, unit in (
        (
            "pursuer radius",
            summary.pursuer.radius_m,
            theory.pursuer_radius_m,
            "m",
        ),
        ("evader radius", summary.evader.radius_m, theory.radius_m, "m"),
        ("distance", summary.distance_m, theory.distance_m, "m"),
        (
            "angle between headings",
            summary.relative_orientation_deg,
            theory.relative_orientation_deg,
            "deg",
        ),
    ):
        text = _compared(value, expected, unit)
        if expected is not None and since is None:
            text += ", not converged"
        elif expected is not None and since is not None and since > begin:
            text += f", measured from {begin:.1f} s"
        rows.append((name, text))
    closest = _compared(summary.min_distance_m, theory.closest_approach_m, "m")
    return [*rows, ("closest approach", closest)]


def _compared(value: float | None, expected: float | None, unit: str) -> str:
    text = "-" if value is None else f"{value:.3f} {unit}"
    return text if expected is None else f"{text:<12} theory {expected:.3f}"


def _capture_text(time: float | None) -> str:
    """Return when the distance first fell to the capture distance."""
    text = "no" if time is None else f"at {time:.1f} s"
    return f"{text:<12} distance <= {CAPTURE_DISTANCE:.2f} m"


def _sight_rows(
    summary: "DuelSummary", sight: "PerceptionSummary"
) -> list[tuple[str, str]]:
    """Return the quality of camera sensing, as rows of the table."""
    rows = [("camera", sight.camera)]
    for name, player in (
        ("pursuer", summary.pursuer),
        ("evader", summary.evader),
    ):
        if player.sight and player.sight.bearing_error_deg.median is not None:
            error = player.sight.bearing_error_deg
            text = f"{error.median:.2f} deg median, {error.p95:.2f} p95"
            rows.append((f"{name}'s bearing error", text))
    own = summary.evader.sight
    if own is not None and own.distance_error_m.median is not None:
        text = f"{own.distance_error_m.median:.3f} m median"
        rows.append(("evader's distance error", text))
    triggered, rate = summary.triggered_at_distance_m, sight.detection_rate
    return [
        *rows,
        (
            "evasion triggered at",
            "never" if triggered is None else f"{triggered:.3f} m",
        ),
        ("detection rate", "-" if rate is None else f"{100.0 * rate:.1f} %"),
        ("false detections", str(sight.false_detections)),
        ("opponent lost for", f"{sight.lost_s:.1f} s"),
    ]
