"""State of a live game as text."""

from ...games.player import Player
from ...locomotion.locomotion import Phase
from ..text_escaping import for_markdown
from .live_session import LiveSession


def phase_of(player: Player) -> Phase:
    """Return the phase of a player; a player without phases is walking."""
    if player.has_fallen:
        return Phase.FALLEN
    walk = player.maneuvers
    return Phase.WALKING if walk is None else walk.phase


def page_text(session: LiveSession) -> str:
    """Return the state of a game, in Markdown; the caller holds its lock."""
    players, theory = session.world.players, session.theory
    phases: dict[Phase, list[str]] = {}
    for player in players:
        phases.setdefault(phase_of(player), []).append(player.name)
    lines = [
        f"**{phase.value}**: {', '.join(names)}"
        for phase, names in phases.items()
    ]
    if session.driven:
        lines.append(
            f"**{session.driven} driven by hand**: no theory applies."
        )
    elif theory is not None:
        lines.append(
            f"theory: a circle with distance {theory[1]:.2f} m and "
            f"{theory[2]:.0f}\u00b0 between the headings"
        )
    speed = ""
    if session.running and session.real_time_factor > 0.0:
        speed = f", {session.real_time_factor:.1f} x real time"
    lines.append(f"{session.world.time:.1f} s simulated{speed}")
    distance, closest = session.game.distance, session.history.closest
    if distance is not None:
        least = "least " if len(players) > 2 else ""
        closest = min(closest, distance)
        lines.append(
            f"{least}distance {distance:.2f} m, closest approach "
            f"{closest:.2f} m"
        )
    if session.outcome is not None:
        lines.append(f"**over: {session.outcome.value}**; reset to restart")
        lines.append(session.game.message)
    if session.error is not None:
        lines.append(f"**stopped: {for_markdown(session.error)}**")
    return "\n\n".join(lines)
