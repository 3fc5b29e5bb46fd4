"""Draws a live duel into the layers of a page."""

import numpy as np

from ...control.walk_snapshots import StepStarted, WalkState
from ...core.poses import Array, Pose
from ..figure_style import COLOURS, EVADER, PUSHED, THEORY
from .live_session import LiveSession
from .scene_layers import (
    HEIGHTS,
    PRINTS,
    SceneLayers,
    chain,
    path_of,
    prints_of,
    pushes_at,
    ring,
    safety_of,
    support_of,
)

Drawn = tuple[str, str, Array, str]  # layer, owner, segments, colour
PUSHES = 20  # the last that are looked at
SUPPORT = "#2a9d55"
ZMP_COLOURS = {"pursuer": "#e8a598", "evader": "#9bb8e8"}


def draw_session(layers: SceneLayers, session: LiveSession) -> None:
    """Draw every layer of the present moment.

    Args:
        layers: Of the page.
        session: Whose lock the caller does not hold.
    """
    with session.lock:
        duel = session.duel
        now = duel.world.time
        drawn: list[Drawn] = []
        places = []
        for player in duel.players:
            seen = player.snapshot()
            name = player.name
            places.append(np.array(seen.torso[:2]))
            if seen.walk is not None and seen.frame is not None:
                steps = list(session.trail.steps.get(name, ()))[-PRINTS:]
                drawn += _walk_of(seen.walk, steps, seen.frame, now, name)
            drawn += _traces(session, name)
            pushes = np.array(seen.pushes[-PUSHES:]).reshape(-1, 6)
            drawn.append(("pushes", name, pushes_at(pushes, now), PUSHED))
        radius = session.settings.strategy.area
        drawn.append(
            ("safety area", "evader", safety_of(places[1], radius), EVADER)
        )
        sight = np.array([[[*places[0], 0.25], [*places[1], 0.25]]])
        drawn.append(("line of sight", "both", sight, THEORY))
        drawn.append(
            (
                "circle of theory",
                "both",
                _circle(session, places),
                THEORY,
            )
        )
    for layer, owner, segments, colour in drawn:
        layers.draw(layer, owner, segments, colour)


def _walk_of(
    walk: WalkState,
    steps: list[StepStarted],
    frame: Pose,
    now: float,
    name: str,
) -> list[Drawn]:
    """Plan, footsteps and support of a robot that walks."""
    colour = COLOURS[name]
    path = chain(path_of(walk, frame), HEIGHTS["planned path"])
    return [
        ("planned path", name, path, colour),
        ("footsteps", name, prints_of(walk, steps, frame), colour),
        ("support polygon", name, support_of(walk, frame, now), SUPPORT),
    ]


def _traces(session: LiveSession, name: str) -> list[Drawn]:
    """Where CoM and ZMP of a player have been lately."""
    drawn = []
    for what, shade in (("CoM", COLOURS[name]), ("ZMP", ZMP_COLOURS[name])):
        layer = f"{what} trace"
        trace = np.array(session.trail.traces.get(f"{name}/{what}", ()))
        lines = chain(trace.reshape(-1, 2), HEIGHTS[layer])
        drawn.append((layer, name, lines, shade))
    return drawn


def _circle(session: LiveSession, places: list[Array]) -> Array:
    """Circle of theory, laid through where the robots are.

    Its middle is the one from which both robots, a known distance apart,
    are a radius away, on the side to which the pursuer turns.
    """
    radius = session.theory_radius
    if radius is None or session.duel.triggered_at is None:
        return np.zeros((0, 2, 3))
    middle = 0.5 * (places[0] + places[1])
    apart = places[1] - places[0]
    half = 0.5 * float(np.hypot(*apart))
    if half >= radius or half < 1e-6:
        return np.zeros((0, 2, 3))
    walk = session.duel.players[0].snapshot().walk
    plan = None if walk is None else walk.plan
    side = 1.0 if plan is None or plan.bearing >= 0.0 else -1.0
    normal = side * np.array([-apart[1], apart[0]]) / (2.0 * half)
    x, y = (middle + normal * np.sqrt(radius**2 - half**2)).tolist()
    return ring(x, y, radius, HEIGHTS["circle of theory"])
