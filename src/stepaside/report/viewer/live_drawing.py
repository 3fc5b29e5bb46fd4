"""Layers of a live duel."""

import numpy as np

from ...core.poses import Array, Pose
from ...locomotion.walk_snapshots import WalkState
from ..figure_style import COLOURS, EVADER, PUSHED, THEORY
from .live_session import LiveSession
from .plot_history import Footprint
from .scene_layers import (
    HEIGHTS,
    MAX_FOOTPRINTS,
    SceneLayers,
    footprints_of,
    path_of,
    polyline,
    push_arrows,
    ring,
    safety_ring,
    support_outline,
)
from .true_odometry import true_odometry

Lines = tuple[str, str, Array, str]  # layer, owner, segments, colour
MAX_PUSHES = 20  # last pushes that may be drawn
SUPPORT = "#2a9d55"
ZMP_COLOURS = {"pursuer": "#e8a598", "evader": "#9bb8e8"}


def draw_session(layers: SceneLayers, session: LiveSession) -> None:
    """Draw all layers of a duel as it is now.

    Args:
        layers: Layers of the page.
        session: The session; the caller must not hold its lock.
    """
    with session.lock:
        duel = session.duel
        now = duel.world.time
        lines: list[Lines] = []
        positions = []
        for player in duel.players:
            snapshot = player.snapshot()
            name = player.name
            positions.append(np.array(snapshot.torso[:2]))
            walk, frame = snapshot.walk, true_odometry(player)
            if walk is not None and frame is not None:
                steps = list(session.trail.steps.get(name, ()))
                lines += _walk_lines(
                    walk, steps[-MAX_FOOTPRINTS:], frame, now, name
                )
            lines += _trace_lines(session, name)
            pushes = np.array(snapshot.pushes[-MAX_PUSHES:]).reshape(-1, 6)
            lines.append(("pushes", name, push_arrows(pushes, now), PUSHED))
        area = safety_ring(positions[1], session.settings.strategy.area)
        lines.append(("safety radius", "evader", area, EVADER))
        pursuer, evader = positions
        sight = np.array([[[*pursuer, 0.25], [*evader, 0.25]]])
        lines.append(("line of sight", "both", sight, THEORY))
        circle = circle_lines(session, positions)
        lines.append(("theoretical circle", "both", circle, THEORY))
    for layer, owner, segments, colour in lines:
        layers.draw(layer, owner, segments, colour)


def _walk_lines(
    walk: WalkState,
    steps: list[Footprint],
    frame: Pose,
    now: float,
    name: str,
) -> list[Lines]:
    """Return plan, footsteps and support polygon of a walking robot."""
    colour = COLOURS[name]
    path = polyline(path_of(walk, frame), HEIGHTS["planned path"])
    return [
        ("planned path", name, path, colour),
        ("footsteps", name, footprints_of(walk, steps, frame), colour),
        ("support polygon", name, support_outline(walk, frame, now), SUPPORT),
    ]


def _trace_lines(session: LiveSession, name: str) -> list[Lines]:
    """Return the recent paths of a player's CoM and ZMP."""
    lines = []
    for point, colour in (("CoM", COLOURS[name]), ("ZMP", ZMP_COLOURS[name])):
        layer = f"{point} trace"
        trace = np.array(session.trail.traces.get(f"{name}/{point}", ()))
        segments = polyline(trace.reshape(-1, 2), HEIGHTS[layer])
        lines.append((layer, name, segments, colour))
    return lines


def circle_lines(session: LiveSession, positions: list[Array]) -> Array:
    """Return the theoretical circle through both players. Shape (n, 2, 3).

    Its center is on the side to which the pursuer turns. Empty before the
    evader is triggered, and if the players are farther apart than the
    diameter.
    """
    radius = session.theory_radius
    if radius is None or session.duel.triggered_at is None:
        return np.zeros((0, 2, 3))
    midpoint = 0.5 * (positions[0] + positions[1])
    sight = positions[1] - positions[0]
    half = 0.5 * float(np.hypot(*sight))
    if half >= radius or half < 1e-6:
        return np.zeros((0, 2, 3))
    walk = session.duel.players[0].snapshot().walk
    plan = None if walk is None else walk.plan
    side = 1.0 if plan is None or plan.bearing >= 0.0 else -1.0
    normal = side * np.array([-sight[1], sight[0]]) / (2.0 * half)
    x, y = (midpoint + normal * np.sqrt(radius**2 - half**2)).tolist()
    return ring(x, y, radius, HEIGHTS["theoretical circle"])
