"""What lies over the scene of a live game, drawn on its page."""

from collections.abc import Iterable, Mapping

import numpy as np
import viser

from ...core.convex import convex_hull
from ...core.poses import Array, Pose
from ...games.player_settings import EVADER, PURSUER
from ...games.players import RobotPlayer
from ...locomotion.maneuver_walk import ManeuverWalk
from ...planning import Foot
from ...planning.plan import sole_corners
from ..overlays import (
    LAYERS,
    SceneLines,
    line_of_sight,
    polyline,
    push_arrows,
    safety_radii,
    safety_ring,
    soles,
    theory_ring,
)
from ..palette import rgb
from .live_history import true_odometry
from .live_session import LiveSession

LABEL_SCALE = 0.85  # of a ring's label, relative to the players' labels
MAX_PUSHES = 20  # last pushes that may be drawn


def live_overlays(session: LiveSession) -> list[SceneLines]:
    """Return all that lies over the scene now; the caller holds the lock."""
    found = []
    places = places_of(session)
    for player in session.world.players:
        walk, name = player.maneuvers, player.name
        frame = true_odometry(player)
        if walk is not None and frame is not None:
            steps = session.history.steps.get(name, ())
            now = session.world.time
            found += _walk_lines(name, walk, [*steps], frame, now)
        if isinstance(player, RobotPlayer):
            pushes = np.array(player.robot.pushes[-MAX_PUSHES:])
            found.append(push_arrows(name, pushes.reshape(-1, 6)))
    for (layer, name), points in session.history.traces.items():
        found.append(SceneLines(layer, name, polyline(np.array(points))))
    for name, radius in safety_radii(session.played).items():
        found.append(safety_ring(name, radius))
    found += [line_of_sight(*pair) for pair in session.opponents]
    return found + circle_through(session, places)


def places_of(session: LiveSession) -> dict[str, Array]:
    """Return the positions of all players, in [m], by name."""
    return {
        player.name: np.array(player.truth.position_torso_in_world)
        for player in session.world.players
    }


def _walk_lines(
    name: str, walk: ManeuverWalk, steps: list[Array], frame: Pose, now: float
) -> list[SceneLines]:
    """Return plan, footsteps and support polygon of a walking robot.

    Steps are its last ones in the world, rows (side, x, y, heading); the
    frame is the pose of its odometry in the world.
    """
    sole, found = walk.gait.sole, []
    if walk.plan is not None:
        plan_in_world = frame.compose(walk.plan_frame)
        # Midway between successive footsteps.
        middle = 0.5 * (walk.plan.placements[2:] + walk.plan.placements[1:-1])
        path = plan_in_world.transform_points(middle[:, :2])
        found.append(SceneLines("planned path", name, polyline(path)))
        steps = steps + [
            np.array(
                [
                    step.foot.value,
                    *plan_in_world.compose(Pose(step.x, step.y, step.theta)),
                ]
            )
            for step in walk.plan.footsteps
        ]
    rows = np.array(steps).reshape(-1, 4)
    found.append(SceneLines("footsteps", name, soles(rows, sole)))
    step = walk.step(now)
    feet = [(step.support, step.swing.other)]
    if step.remaining <= 0.0:
        left = step.swing is Foot.LEFT
        stood = walk.left_foot if left else walk.right_foot
        feet.append((step.landing if step.walking else stood, step.swing))
    corners = [
        sole_corners(np.array(frame.compose(pose)), foot, sole)
        for pose, foot in feet
    ]
    hull = polyline(convex_hull(np.concatenate(corners)), closed=True)
    return [*found, SceneLines("support polygon", name, hull)]


def circle_through(
    session: LiveSession, places: Mapping[str, Array]
) -> list[SceneLines]:
    """Return the theoretical circle through both players of a duel.

    Its center is on the side to which the pursuer turns. Empty without a
    circle, before the evader moves, and if the players are farther apart
    than the diameter.
    """
    theory = session.theory
    if theory is None or EVADER not in session.world.first_moves:
        return []
    sight = places[EVADER] - places[PURSUER]
    half, radius = 0.5 * float(np.hypot(*sight)), theory[0]
    if half >= radius or half < 1e-6:
        return []
    walk = session.world.player(PURSUER).maneuvers
    plan = None if walk is None else walk.plan
    side = 1.0 if plan is None or plan.bearing >= 0.0 else -1.0
    normal = side * np.array([-sight[1], sight[0]]) / (2.0 * half)
    middle = 0.5 * (places[PURSUER] + places[EVADER])
    x, y = (middle + normal * np.sqrt(radius**2 - half**2)).tolist()
    return [theory_ring(x, y, radius)]


class SceneLayers:
    """Lines of one page, by layer and player.

    Attributes:
        shown: Whether each layer is shown.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        """Start without lines."""
        self._scene = scene
        self.shown = {layer: layer != "ZMP trace" for layer in LAYERS}
        self._drawn: dict[str, bytes] = {}

    def draw(
        self,
        overlays: Iterable[SceneLines],
        now: float,
        places: Mapping[str, Array],
        colours: Mapping[str, str],
    ) -> None:
        """Replace lines and labels that changed; remove those that are gone.

        Places of the players are in [m], by name; ``now`` is in [s].
        """
        kept = set()
        for own in overlays:
            segments = own.shown(now, places)
            if not self.shown[own.layer] or not len(segments):
                continue
            name = f"/layers/{own.layer}/{own.owner}"
            kept.add(name)
            points = np.ascontiguousarray(segments, dtype=np.float32)
            if self._drawn.get(name) != points.tobytes():
                self._drawn[name] = points.tobytes()
                colour = rgb(own.colour("light", colours))
                self._scene.add_line_segments(
                    name, points, colors=colour, thickness=0.008
                )
            if own.label:
                kept.add(f"{name} label")
                self._label(f"{name} label", own, segments)
        for name in self._drawn.keys() - kept:
            del self._drawn[name]
            self._scene.remove_by_name(name)

    def _label(self, name: str, own: SceneLines, segments: Array) -> None:
        """Write name and radius beside a ring."""
        place = own.label_place(segments)
        content = own.label.encode() + place.tobytes()
        if self._drawn.get(name) == content:
            return
        self._drawn[name] = content
        self._scene.add_label(
            name,
            own.label,
            anchor="center-center",
            font_screen_scale=LABEL_SCALE,
            position=place,
        )
