"""Layers of lines in the scene of a page: plans, footsteps, traces, rings."""

from collections.abc import Iterable
from math import inf

import numpy as np
import viser

from ...core.convex import convex_hull
from ...core.poses import Array, Pose
from ...locomotion.walk_snapshots import WalkState
from ...planning import Foot
from ...planning.support_polygon import sole_corners
from ..palette import on_both_floors

LAYERS = (
    "planned path",
    "footsteps",
    "CoM trace",
    "ZMP trace",
    "line of sight",
    "safety radius",
    "theoretical circle",
    "support polygon",
    "pushes",
)
MEANINGS = {
    "planned path": "path of the current plan of each robot",
    "footsteps": "outlines of the soles, past and planned",
    "CoM trace": "path of the center of mass, on the floor",
    "ZMP trace": "path of the zero-moment point, paler",
    "line of sight": "grey line between the players",
    "safety radius": "blue ring; the evader is triggered inside it",
    "theoretical circle": "grey ring, on which the paper's game ends",
    "support polygon": "green outline of the feet in contact",
    "pushes": "magenta arrow, for 1 s after each push",
}
# Layers whose rings have a label, and the segment that carries it.
RINGS = {"safety radius": 63, "theoretical circle": 27}
RING_LABEL_SCALE = 0.85  # relative to the players' labels
HEIGHTS = {name: 0.002 + 0.001 * i for i, name in enumerate(LAYERS)}
MAX_FOOTPRINTS = 60  # past footsteps that are drawn
PUSH_HEIGHT = 0.3  # of an arrow over the floor, in [m]
PUSH_LENGTH = 0.25  # of an arrow, in [m] per [N s]
PUSH_SHOWN = 1.0  # time for which an arrow is shown, in [s]


def rgb(colour: str) -> tuple[int, int, int]:
    """Return red, green and blue, 0 to 255, of a colour ``#rrggbb``."""
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


def legend(layers: Iterable[str]) -> str:
    """Return a legend of layers in Markdown.

    Args:
        layers: Those of ``LAYERS`` that a page has.
    """
    lines = [f"- **{layer}**: {MEANINGS[layer]}" for layer in layers]
    colours = "Pursuers: red. Evaders: blue. Bystanders: grey."
    return "\n".join([colours, "", *lines])


def polyline(points: Array, height: float, *, closed: bool = False) -> Array:
    """Return the segments of a horizontal polyline, in [m].

    Args:
        points: (x, y) in the world, in [m]. Shape (m, 2).
        height: Height over the floor, in [m].
        closed: Whether the last point is connected to the first.

    Returns:
        Start and end of each segment. Shape (n, 2, 3).
    """
    if closed and len(points):
        points = np.concatenate([points, points[:1]])
    if len(points) < 2:
        return np.zeros((0, 2, 3))
    raised = np.column_stack([points, np.full(len(points), height)])
    return np.stack([raised[:-1], raised[1:]], axis=1)


def ring(x: float, y: float, radius: float, height: float) -> Array:
    """Return the segments of a circle, in [m]. Shape (n, 2, 3).

    Args:
        x: Coordinate of its center in the world, in [m].
        y: Coordinate of its center in the world, in [m].
        radius: In [m].
        height: Height over the floor, in [m].
    """
    angle = np.linspace(0.0, 2.0 * np.pi, 73)[:-1]
    points = np.column_stack(
        [x + radius * np.cos(angle), y + radius * np.sin(angle)]
    )
    return polyline(points, height, closed=True)


class SceneLayers:
    """Lines of one page, by layer and player.

    Attributes:
        shown: Whether each layer is shown.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        """Start without lines."""
        self._scene = scene
        self.shown = dict.fromkeys(LAYERS, True)
        self._drawn: dict[str, bytes] = {}
        self._labels: dict[str, tuple[str, viser.LabelHandle]] = {}

    def draw(
        self, layer: str, owner: str, segments: Array, colour: str
    ) -> None:
        """Replace the lines of one layer and owner, if they changed.

        Args:
            layer: One of ``LAYERS``.
            owner: Name of a player, or "both".
            segments: In the world, in [m]. Shape (n, 2, 3).
            colour: As ``#rrggbb``.
        """
        name = f"/layers/{layer}/{owner}"
        if layer in RINGS:
            self._label_ring(layer, segments if self.shown[layer] else None)
        if not self.shown[layer] or len(segments) == 0:
            if self._drawn.pop(name, None) is not None:
                self._scene.remove_by_name(name)
            return
        points = np.ascontiguousarray(segments, dtype=np.float32)
        content = points.tobytes()
        if self._drawn.get(name) == content:
            return
        self._drawn[name] = content
        self._scene.add_line_segments(
            name, points, colors=rgb(on_both_floors(colour)), thickness=0.008
        )

    def _label_ring(self, layer: str, segments: Array | None) -> None:
        """Write name and radius beside a ring; remove them without a ring."""
        label = self._labels.get(layer)
        if segments is None or len(segments) == 0:
            if label is not None:
                self._labels.pop(layer)[1].remove()
            return
        points = np.asarray(segments)[:, 0]
        text = f"{layer} {0.5 * float(np.ptp(points[:, 0])):.2f} m"
        if label is None or label[0] != text:
            if label is not None:
                label[1].remove()
            handle = self._scene.add_label(
                f"/rings/{layer}",
                text,
                anchor="center-center",
                font_screen_scale=RING_LABEL_SCALE,
            )
            label = self._labels[layer] = text, handle
        x, y, z = points[RINGS[layer] % len(points)].tolist()
        label[1].position = (x, y, z + 0.02)

    def clear(self) -> None:
        """Remove all lines and their labels."""
        for layer in RINGS:
            self._label_ring(layer, None)
        for name in list(self._drawn):
            self._scene.remove_by_name(name)
        self._drawn.clear()


def path_of(walk: WalkState, frame: Pose) -> Array:
    """Return the planned path in the world, in [m]. Shape (n, 2).

    It runs midway between successive footsteps.

    Args:
        walk: State of the walk.
        frame: Pose of the odometry frame in the world.
    """
    plan = walk.plan
    if plan is None:
        return np.zeros((0, 2))
    x, y = plan.placements[1:, 0], plan.placements[1:, 1]
    middle = np.column_stack([0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])])
    return frame.compose(walk.plan_frame).transform_points(middle)


def footprints_of(
    walk: WalkState, steps: Iterable[tuple[Foot, Pose]], frame: Pose
) -> Array:
    """Return outlines of past and planned footsteps. Shape (n, 2, 3).

    Args:
        walk: State of the walk.
        steps: Past footsteps and their poses in the world.
        frame: Pose of the odometry frame in the world.
    """
    sole = walk.gait.sole
    height = HEIGHTS["footsteps"]
    outlines = []
    for foot, landed in steps:
        corners = sole_corners(np.array(landed), foot, sole)
        outlines.append(polyline(corners, height, closed=True))
    plan = walk.plan
    if plan is not None:
        pose_plan_in_world = frame.compose(walk.plan_frame)
        for planned in plan.footsteps:
            pose_in_plan = Pose(planned.x, planned.y, planned.theta)
            pose = np.array(pose_plan_in_world.compose(pose_in_plan))
            corners = sole_corners(pose, planned.foot, sole)
            outlines.append(polyline(corners, height, closed=True))
    return np.concatenate(outlines) if outlines else np.zeros((0, 2, 3))


def push_arrows(pushes: Array | None, now: float) -> Array:
    """Return arrows of the pushes of the last second. Shape (n, 2, 3).

    Args:
        pushes: Rows (time [s], duration [s], x [m], y [m], impulse x and y
            [N s]); None for none. Shape (j, 6).
        now: Time, in [s].
    """
    arrows = [np.zeros((0, 2, 3))]
    for time, _, x, y, *impulse in () if pushes is None else pushes.tolist():
        if not 0.0 <= now - time < PUSH_SHOWN:
            continue
        shaft = PUSH_LENGTH * np.array(impulse)
        tip = np.array([x, y])
        aside = 0.25 * np.array([-shaft[1], shaft[0]])
        arrow = [tip - shaft, tip, tip - 0.3 * shaft + aside, tip]
        arrow += [tip, tip - 0.3 * shaft - aside]
        ends = np.array(arrow).reshape(3, 2, 2)
        heights = np.full((3, 2, 1), PUSH_HEIGHT)
        arrows.append(np.concatenate([ends, heights], axis=2))
    return np.concatenate(arrows)


def support_outline(walk: WalkState, frame: Pose, now: float) -> Array:
    """Return the outline of the support polygon. Shape (n, 2, 3).

    Args:
        walk: State of the walk.
        frame: Pose of the odometry frame in the world.
        now: Time, in [s].
    """
    step = walk.step(now)
    sole = walk.gait.sole
    feet = [(step.support, step.swing.other)]
    if step.remaining <= 0.0:
        stood = walk.left_foot if step.swing.value > 0 else walk.right_foot
        feet.append((step.landing if step.walking else stood, step.swing))
    corners = [
        sole_corners(np.array(frame.compose(pose)), foot, sole)
        for pose, foot in feet
    ]
    hull = convex_hull(np.concatenate(corners))
    return polyline(hull, HEIGHTS["support polygon"], closed=True)


def safety_ring(position: Array, radius: float) -> Array:
    """Return a ring around a player; empty for an infinite radius.

    Args:
        position: Of the player, in the world, in [m]. Shape (2,).
        radius: Safety radius, in [m].

    Returns:
        Segments. Shape (n, 2, 3).
    """
    if radius == inf:
        return np.zeros((0, 2, 3))
    x, y = position[:2].tolist()
    return ring(x, y, radius, HEIGHTS["safety radius"])
