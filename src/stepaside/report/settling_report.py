"""Why a duel has not come to its circle yet, in words."""

from ..games.duel_circle import theory_of
from ..games.duel_run import DuelRun
from ..games.duel_settings import DuelSettings
from ..games.outcome import Outcome


def settling_time(settings: DuelSettings) -> float | None:
    """Time in which what is off the circle shrinks by e, in [s].

    That of the slowest mode of the unicycles, near 4 / (k alpha^2) for small
    strategy angles, on the clock of the game.

    Args:
        settings: Of the duel.

    Returns:
        The time; None where there is no circle that holds.
    """
    circle = theory_of(settings)
    if not (circle.exists and circle.stable):
        return None
    gait = settings.gait
    # The unicycles of two robots live in path time, all others in the game's.
    paced = settings.pursuer != "person"
    pace = gait.step_duration / gait.path_interval if paced else 1.0
    return circle.time_constant_s * pace


def settling_words(run: DuelRun) -> str:
    """Say why a run did not end on its circle.

    Args:
        run: Which was not on the circle when it ended.
    """
    summary = run.summary
    theory = summary.theory
    if theory.expected in ("contact", "no circle"):
        return "not expected"
    settling = settling_time(run.settings)
    if settling is None:
        return "not expected: theory has none that holds"
    since = summary.triggered_at_s
    if since is None:
        return "not reached: the evader was never triggered"
    end = float(run.times[-1])
    if theory.circle_since_s is not None:
        when = f"the template is on it from {theory.circle_since_s:.0f} s on"
        if run.outcome is not Outcome.COMPLETED:
            return f"not reached by {end:.0f} s: {when}"
        return f"not reached, unlike theory: {when}"
    return (
        f"not reached: {end - since:.0f} s of evasion; theory's slowest mode "
        f"takes {settling:.0f} s to shrink by e"
    )
