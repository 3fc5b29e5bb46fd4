"""Report on why a duel did not reach its circle."""

from ..games.duel_circle import circle_of_theory
from ..games.duel_settings import DuelSettings
from ..games.outcome import Outcome
from ..games.run import DuelRun


def settling_time(settings: DuelSettings) -> float | None:
    """Return the time constant of the approach to the circle, in [s].

    It is that of the slowest mode of the unicycles, near 4 / (k alpha^2) for
    small evasion angles alpha, in time of the game.

    Args:
        settings: Settings of the duel.

    Returns:
        The time constant; None without a stable circle.
    """
    circle = circle_of_theory(settings)
    if not (circle.exists and circle.stable):
        return None
    gait = settings.gait
    # The unicycles of two robots run in path time, those of a person and a
    # robot in time of the game.
    if settings.pursuer == "person":
        return circle.time_constant_s
    return circle.time_constant_s * (gait.step_duration / gait.path_interval)


def explain_missing_circle(run: DuelRun) -> str:
    """Return why a run did not end on its circle, as text.

    Args:
        run: Run that was not on the circle when it ended.
    """
    summary = run.summary
    theory = summary.theory
    if theory.expected in ("contact", "no circle"):
        return "not expected"
    settling = settling_time(run.settings)
    if settling is None:
        return "not expected: the theory has no stable circle"
    since = summary.triggered_at_s
    if since is None:
        return "not reached: the evader was never triggered"
    end = float(run.times[-1])
    if theory.circle_since_s is not None:
        when = f"the template reaches it at {theory.circle_since_s:.0f} s"
        if run.outcome is not Outcome.COMPLETED:
            return f"not reached by {end:.0f} s: {when}"
        return f"not reached, unlike in theory: {when}"
    return (
        f"not reached: {end - since:.0f} s of evasion; time constant of the "
        f"theory's slowest mode {settling:.0f} s"
    )
