"""Lines on the floor: plans, footsteps, traces, circles."""

from collections.abc import Iterable
from math import inf

import numpy as np
import viser

from ...control.walk_snapshots import StepStarted, WalkState
from ...core.convex import convex_hull
from ...core.poses import Array, Pose
from ...planning import Foot, SoleRectangle
from ...planning.support_polygon import sole_corners
from ..figure_style import COLOURS, EVADER, THEORY
from ..palette import seen_by_all

LAYERS = (
    "planned path",
    "footsteps",
    "CoM trace",
    "ZMP trace",
    "line of sight",
    "safety area",
    "circle of theory",
    "support polygon",
    "pushes",
)
MEANINGS = {
    "planned path": "where each robot plans to walk",
    "footsteps": "outlines of the soles, made and planned",
    "CoM trace": "path of the center of mass over the floor",
    "ZMP trace": "path of the zero-moment point, paler",
    "line of sight": "grey line from one player to the other",
    "safety area": "blue ring; inside it the pursuer is too near",
    "circle of theory": "grey ring, on which the paper's game ends",
    "support polygon": "green outline of the feet that bear",
    "pushes": "magenta arrow, for a second after each push",
}
# Rings are named where they lie: the direction of the name from the middle.
RINGS = {  # its name there, and the number of the segment
    "safety area": ("safety radius", 52),
    "circle of theory": ("circle of theory", 44),
}
SMALL = 0.85  # size of these names, of that of the players' names
HEIGHTS = {name: 0.002 + 0.001 * i for i, name in enumerate(LAYERS)}
PRINTS = 60  # footsteps kept
COMING = 0.5  # how long before it lands a footstep is shown, in [s]
PUSH_HEIGHT = 0.3  # of an arrow over the floor, in [m]
PUSH_LENGTH = 0.25  # in [m] per [N s]
PUSH_SHOWN = 1.0  # how long it is seen, in [s]


def rgb(colour: str) -> tuple[int, int, int]:
    """Colour from ``#rrggbb``, 0 to 255."""
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


def legend(layers: Iterable[str]) -> str:
    """Say in Markdown what each layer shows.

    Args:
        layers: Those of ``LAYERS`` that a page has.
    """
    lines = [f"- **{layer}**: {MEANINGS[layer]}" for layer in layers]
    return "\n".join(["Pursuer red, evader blue.", "", *lines])


def chain(points: Array, height: float, *, closed: bool = False) -> Array:
    """Segments through points of the floor. Shape (n, 2, 3)."""
    if closed and len(points):
        points = np.concatenate([points, points[:1]])
    if len(points) < 2:
        return np.zeros((0, 2, 3))
    raised = np.column_stack([points, np.full(len(points), height)])
    return np.stack([raised[:-1], raised[1:]], axis=1)


def ring(x: float, y: float, radius: float, height: float) -> Array:
    """Segments of a circle. Shape (n, 2, 3)."""
    angle = np.linspace(0.0, 2.0 * np.pi, 73)[:-1]
    points = np.column_stack(
        [x + radius * np.cos(angle), y + radius * np.sin(angle)]
    )
    return chain(points, height, closed=True)


class SceneLayers:
    """The lines of one page; each layer can be switched.

    Attributes:
        shown: Whether each layer is shown.
    """

    def __init__(self, scene: viser.SceneApi) -> None:
        """Begin with empty lines."""
        self._scene = scene
        self.shown = dict.fromkeys(LAYERS, True)
        self._drawn: dict[str, bytes] = {}
        self._named: dict[str, tuple[str, viser.LabelHandle]] = {}

    def draw(
        self, layer: str, owner: str, segments: Array, colour: str
    ) -> None:
        """Replace the lines of one layer and owner, if they changed.

        Args:
            layer: One of ``LAYERS``.
            owner: "pursuer", "evader" or "both".
            segments: In the world, in [m]. Shape (n, 2, 3).
            colour: As ``#rrggbb``.
        """
        name = f"/layers/{layer}/{owner}"
        if layer in RINGS:
            self._name_ring(layer, segments if self.shown[layer] else None)
        if not self.shown[layer] or len(segments) == 0:
            if self._drawn.pop(name, None) is not None:
                self._scene.remove_by_name(name)
            return
        points = np.ascontiguousarray(segments, dtype=np.float32)
        content = points.tobytes()
        if self._drawn.get(name) == content:
            return
        self._drawn[name] = content
        seen = rgb(seen_by_all(colour))
        self._scene.add_line_segments(
            name, points, colors=seen, thickness=0.008
        )

    def _name_ring(self, layer: str, segments: Array | None) -> None:
        """Write its name and radius beside a ring; no ring, no name."""
        known = self._named.get(layer)
        if segments is None or len(segments) == 0:
            if known is not None:
                self._named.pop(layer)[1].remove()
            return
        points = np.asarray(segments)[:, 0]
        name, number = RINGS[layer]
        text = f"{name} {0.5 * float(np.ptp(points[:, 0])):.2f} m"
        if known is None or known[0] != text:
            if known is not None:
                known[1].remove()
            made = self._scene.add_label(
                f"/rings/{layer}",
                text,
                anchor="center-center",
                font_screen_scale=SMALL,
            )
            known = self._named[layer] = text, made
        x, y, z = points[number % len(points)].tolist()
        known[1].position = (x, y, z + 0.02)

    def clear(self) -> None:
        """Take every line off the page."""
        for layer in RINGS:
            self._name_ring(layer, None)
        for name in list(self._drawn):
            self._scene.remove_by_name(name)
        self._drawn.clear()


def path_of(walk: WalkState, frame: Pose) -> Array:
    """Points of the template's path under the plan. Shape (n, 2)."""
    plan = walk.plan
    if plan is None:
        return np.zeros((0, 2))
    x, y = plan.placements[1:, 0], plan.placements[1:, 1]
    middle = np.column_stack([0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])])
    return frame.compose(walk.plan_frame).transform_points(middle)


def prints_of(
    walk: WalkState, steps: Iterable[StepStarted], frame: Pose
) -> Array:
    """Outlines of the last footsteps and the planned ones."""
    sole = walk.gait.sole
    height = HEIGHTS["footsteps"]
    outlines = []
    for step in steps:
        place = np.array(frame.compose(step.landing))
        corners = sole_corners(place, step.foot, sole)
        outlines.append(chain(corners, height, closed=True))
    plan = walk.plan
    if plan is not None:
        at = frame.compose(walk.plan_frame)
        for planned in plan.footsteps:
            pose = Pose(planned.x, planned.y, planned.theta)
            place = np.array(at.compose(pose))
            corners = sole_corners(place, planned.foot, sole)
            outlines.append(chain(corners, height, closed=True))
    return np.concatenate(outlines) if outlines else np.zeros((0, 2, 3))


def prints_at(
    landings: Array | None, sole: SoleRectangle, now: float
) -> Array:
    """Outlines of the last footsteps of a track. Shape (n, 2, 3).

    Args:
        landings: Of the track, if it has any. Shape (m, 5).
        sole: Shape of a left sole.
        now: Time, in [s]; the footstep that comes next is shown, too.
    """
    if landings is None:
        return np.zeros((0, 2, 3))
    begun = landings[landings[:, 0] <= now + COMING][-PRINTS:]
    outlines = [
        chain(
            sole_corners(np.array(pose), Foot(int(side)), sole),
            HEIGHTS["footsteps"],
            closed=True,
        )
        for _, side, *pose in begun.tolist()
    ]
    return np.concatenate([np.zeros((0, 2, 3)), *outlines])


def pushes_at(pushes: Array | None, now: float) -> Array:
    """Arrows of the pushes of the last second. Shape (n, 2, 3).

    Args:
        pushes: Of a track, if it has any. Shape (j, 6).
        now: Time, in [s].
    """
    arrows = [np.zeros((0, 2, 3))]
    for time, _, x, y, *impulse in () if pushes is None else pushes.tolist():
        if not 0.0 <= now - time < PUSH_SHOWN:
            continue
        way = PUSH_LENGTH * np.array(impulse)
        tip = np.array([x, y])
        back = 0.25 * np.array([-way[1], way[0]])
        arrow = [tip - way, tip, tip - 0.3 * way + back, tip]
        arrow += [tip, tip - 0.3 * way - back]
        ends = np.array(arrow).reshape(3, 2, 2)
        high = np.full((3, 2, 1), PUSH_HEIGHT)
        arrows.append(np.concatenate([ends, high], axis=2))
    return np.concatenate(arrows)


def support_of(walk: WalkState, frame: Pose, now: float) -> Array:
    """Outline of the support polygon."""
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
    return chain(hull, HEIGHTS["support polygon"], closed=True)


def safety_of(place: Array, radius: float) -> Array:
    """Ring of the safety area round the evader."""
    if radius == inf:
        return np.zeros((0, 2, 3))
    x, y = place[:2].tolist()
    return ring(x, y, radius, HEIGHTS["safety area"])


__all__ = [
    "COLOURS",
    "EVADER",
    "HEIGHTS",
    "LAYERS",
    "MEANINGS",
    "THEORY",
    "SceneLayers",
    "chain",
    "legend",
    "path_of",
    "prints_at",
    "prints_of",
    "pushes_at",
    "ring",
    "safety_of",
    "support_of",
]
