"""Status texts of a live game: current state and outlook."""

from math import inf, isfinite, log

from ...games.approach_forecast import LEAST, describe_motion
from ...games.duel_settings import DuelSettings
from ...games.player import Player
from ...locomotion.walk_snapshots import Phase
from ...strategies.approach import Approach
from ..text_escaping import for_markdown
from .live_session import LiveSession

NEAR_DISTANCE = 0.05  # relative tolerance of the distance on the circle
NEAR_ANGLE = 5.0  # tolerance of the angle on the circle, in [deg]
MAX_FORECAST = 600.0  # of an approach on a straight course, in [s]


def status_text(
    phases: tuple[Phase, Phase],
    distance: float,
    orientation: float,
    safety_radius: float,
    theory: tuple[float, float] | None,
    *,
    approach: Approach | None = None,
) -> str:
    """Return the state of a duel as text.

    Args:
        phases: Phases of pursuer and evader.
        distance: Between the torsos, in [m].
        orientation: Angle between the headings, in [deg].
        safety_radius: Of the evader, in [m].
        theory: Distance [m] and angle [deg] on the circle; None without one.
        approach: Of the pursuer to the evader; None if it is unknown.
    """
    pursuer, evader = phases
    if Phase.FALLEN in phases:
        names = [
            name
            for name, phase in zip(("pursuer", "evader"), phases, strict=True)
            if phase is Phase.FALLEN
        ]
        return f"**{' and '.join(names)} fell**"
    if evader is Phase.STANDING:
        if pursuer is Phase.STANDING:
            return "both robots are **standing**"
        if safety_radius < inf and distance < safety_radius:
            return (
                "the evader is **triggered**: the pursuer is within the "
                "safety radius"
            )
        motion = describe_motion(approach)
        return f"the pursuer {motion}; the evader is **standing**"
    if evader is Phase.HALTING:
        return "the evader is **halting**"
    if theory is not None:
        circle_distance, angle = theory
        if (
            abs(distance - circle_distance) < NEAR_DISTANCE * circle_distance
            and abs(orientation - angle) < NEAR_ANGLE
        ):
            return "both robots are **on the circle**"
    return "the evader is **evading**"


def outlook(
    distance: float,
    phase: Phase,
    *,
    safety: float,
    approach: Approach | None,
    theory: tuple[float, float] | None,
    settling: float | None,
) -> str:
    """Return what is expected next, and when, as text.

    Args:
        distance: Between the torsos, in [m].
        phase: Phase of the evader.
        safety: Distance at which the evader begins to move, in [m].
        approach: Of the pursuer to the evader; None if it is unknown.
        theory: Distance [m] and angle [deg] on the circle; None without one.
        settling: Time constant of the approach to the circle, in [s]; None
            if it is not stable.
    """
    if phase is Phase.STANDING:
        if not isfinite(safety):
            return ""
        text = f"The evader starts when the pursuer is within {safety:.2f} m"
        if approach is None or approach.closing_speed <= LEAST:
            return f"{text}."
        left = approach.contact_time(safety)
        if left == inf:
            closest = approach.miss
            return (
                f"{text}; on its present course the pursuer passes at "
                f"{closest:.2f} m."
            )
        if left >= MAX_FORECAST:
            return f"{text}."
        return f"{text}: in about {left:.0f} s."
    if theory is None or settling is None:
        return "The theory predicts no circle for this game."
    circle_distance, angle = theory
    text = (
        f"Theory: a circle with distance {circle_distance:.2f} m and "
        f"{angle:.0f}\u00b0 between the headings"
    )
    error = abs(distance - circle_distance) / circle_distance
    if error <= NEAR_DISTANCE:
        return f"{text}; the distance is within 5 % of it."
    return f"{text}, in about {settling * log(error / NEAR_DISTANCE):.0f} s."


def phase_of(player: Player) -> Phase:
    """Return the phase of a player; a player without phases is walking."""
    if player.has_fallen:
        return Phase.FALLEN
    walk = player.snapshot().walk
    return Phase.WALKING if walk is None else walk.phase


def page_text(session: LiveSession) -> str:
    """Return state and outlook of a game, in Markdown.

    Args:
        session: The session; the caller holds its lock.
    """
    history, players = session.history.history, session.world.players
    phases = [phase_of(player) for player in players]
    distance = session.game.distance
    _, _, angle = history[-1] if history else (0.0, 0.0, 0.0)
    closest = session.history.closest
    if isinstance(session.settings, DuelSettings):
        assert distance is not None
        approach = session.history.approach(session.settings.cycle)
        theory, trigger = session.theory, session.trigger_distance
        lines = [
            status_text(
                (phases[0], phases[1]),
                distance,
                angle,
                trigger,
                theory and theory[1:],
                approach=approach,
            ),
            outlook(
                distance,
                phases[1],
                safety=trigger,
                approach=approach,
                theory=theory and theory[1:],
                settling=session.settling,
            ),
        ]
    else:
        lines = []
        for phase in dict.fromkeys(phases):
            inside = [
                player.name
                for player, now in zip(players, phases, strict=True)
                if now is phase
            ]
            lines.append(f"**{phase.value}**: {', '.join(inside)}")
    if session.driven:
        lines[1:] = [
            f"**{session.driven} driven by hand**: no theory applies."
        ]
    speed = ""
    if session.running and session.real_time_factor > 0.0:
        speed = f", {session.real_time_factor:.1f} x real time"
    lines.append(f"{session.world.time:.1f} s simulated{speed}")
    if distance is not None:
        least = "least " if len(players) > 2 else ""
        nearest = min(closest, distance)
        lines.append(
            f"{least}distance {distance:.2f} m, closest approach "
            f"{nearest:.2f} m"
        )
    if session.outcome is not None:
        lines.append(f"**over: {session.outcome.value}**; reset to restart")
        lines.append(session.game.message)
    if session.error is not None:
        lines.append(f"**stopped: {for_markdown(session.error)}**")
    return "\n\n".join(filter(None, lines))
