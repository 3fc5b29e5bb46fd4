"""Layers of a live game."""

import numpy as np

from ...core.poses import Array, Pose
from ...games.duel_settings import PLAYERS, DuelSettings
from ...games.physics_world import PhysicsWorld
from ...locomotion.walk_snapshots import WalkState
from ..figure_style import EVADER, PURSUER, PUSHED, THEORY
from .live_match import safety_radii
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
ZMP_COLOURS = {PURSUER: "#e8a598", EVADER: "#9bb8e8"}


def draw_session(layers: SceneLayers, session: LiveSession) -> None:
    """Draw all layers of a game as it is now.

    Args:
        layers: Layers of the page.
        session: The session; the caller must not hold its lock.
    """
    with session.lock:
        colours = session.colours
        now = session.match.world.time
        lines: list[Lines] = []
        positions = {}
        for player in session.match.in_physics.players:
            snapshot, name = player.snapshot(), player.name
            colour = colours[name]
            positions[name] = np.array(snapshot.torso[:2])
            walk, frame = snapshot.walk, true_odometry(player)
            if walk is not None and frame is not None:
                steps = list(session.trail.steps.get(name, ()))
                steps = steps[-MAX_FOOTPRINTS:]
                lines += _walk_lines(walk, steps, frame, now, (name, colour))
            lines += _trace_lines(session, name, colour)
            pushes = np.array(snapshot.pushes[-MAX_PUSHES:]).reshape(-1, 6)
            lines.append(("pushes", name, push_arrows(pushes, now), PUSHED))
        for name, radius in safety_radii(session.settings).items():
            area = safety_ring(positions[name], radius)
            lines.append(("safety radius", name, area, colours[name]))
        for one, other in session.opponents:
            ends = positions[one], positions[other]
            sight = np.array([[[*end, 0.25] for end in ends]])
            lines.append(("line of sight", f"{one}-{other}", sight, THEORY))
        if isinstance(session.settings, DuelSettings):
            circle = circle_lines(
                session.match.in_physics,
                session.theory_radius,
                [*positions.values()],
            )
            lines.append(("theoretical circle", "both", circle, THEORY))
    for layer, owner, segments, colour in lines:
        layers.draw(layer, owner, segments, colour)


def _walk_lines(
    walk: WalkState,
    steps: list[Footprint],
    frame: Pose,
    now: float,
    owner: tuple[str, str],
) -> list[Lines]:
    """Return plan, footsteps and support polygon of a walking robot.

    Args:
        walk: State of the walk.
        steps: Last steps.
        frame: Pose of its odometry in the world.
        now: Simulated time, in [s].
        owner: Name and colour of the robot.
    """
    name, colour = owner
    path = polyline(path_of(walk, frame), HEIGHTS["planned path"])
    return [
        ("planned path", name, path, colour),
        ("footsteps", name, footprints_of(walk, steps, frame), colour),
        ("support polygon", name, support_outline(walk, frame, now), SUPPORT),
    ]


def _trace_lines(session: LiveSession, name: str, colour: str) -> list[Lines]:
    """Return the recent paths of a player's CoM and, paler, ZMP."""
    lines = []
    for point, shade in (("CoM", colour), ("ZMP", paler(colour))):
        layer = f"{point} trace"
        trace = np.array(session.trail.traces.get(f"{name}/{point}", ()))
        segments = polyline(trace.reshape(-1, 2), HEIGHTS[layer])
        lines.append((layer, name, segments, shade))
    return lines


def paler(colour: str) -> str:
    """Return the colour of a ZMP for that of its player."""
    mixed = (round(0.5 * (part + 255)) for part in bytes.fromhex(colour[1:]))
    return ZMP_COLOURS.get(colour) or "#" + "".join(f"{p:02x}" for p in mixed)


def circle_lines(
    world: PhysicsWorld, radius: float | None, positions: list[Array]
) -> Array:
    """Return the theoretical circle through both players. Shape (n, 2, 3).

    Its center is on the side to which the pursuer turns. Empty without a
    circle, before the evader is triggered, and if the players are farther
    apart than the diameter.

    Args:
        world: World of the duel.
        radius: Radius of the evader's circle, in [m]; None without one.
        positions: Of pursuer and evader in the world, in [m].
    """
    if radius is None or PLAYERS[1] not in world.first_moves:
        return np.zeros((0, 2, 3))
    midpoint = 0.5 * (positions[0] + positions[1])
    sight = positions[1] - positions[0]
    half = 0.5 * float(np.hypot(*sight))
    if half >= radius or half < 1e-6:
        return np.zeros((0, 2, 3))
    walk = world.player(PLAYERS[0]).snapshot().walk
    plan = None if walk is None else walk.plan
    side = 1.0 if plan is None or plan.bearing >= 0.0 else -1.0
    normal = side * np.array([-sight[1], sight[0]]) / (2.0 * half)
    x, y = (midpoint + normal * np.sqrt(radius**2 - half**2)).tolist()
    return ring(x, y, radius, HEIGHTS["theoretical circle"])
