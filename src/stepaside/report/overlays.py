"""What lies over a scene: paths, footsteps, circle, rings, sight, pushes.

Films, pages, bags and top views draw the same lines, each in its own way.
"""

from collections.abc import Mapping
from math import atan2, inf, isfinite
from typing import NamedTuple

import mujoco
import numpy as np

from ..core.poses import Array
from ..games.game_settings import GameSettings
from ..games.player_settings import EVADER
from ..games.run import Run
from ..planning import Foot, SoleRectangle
from ..planning.plan import sole_corners
from ..robots.description import load_robot
from ..strategies.registry import OF_EVASION
from .palette import PALETTES


class Layer(NamedTuple):
    """Kind of overlays that is switched on and off as one."""

    meaning: str  # for a legend
    height: float  # over the floor at which it is drawn, in [m]
    colour: str = ""  # field of Palette; empty for that of the player


LAYERS = {
    "planned path": Layer("path of the current plan of each robot", 0.002),
    "footsteps": Layer("outlines of the soles, past and planned", 0.003),
    "CoM trace": Layer("path of the center of mass, on the floor", 0.004),
    "ZMP trace": Layer("path of the zero-moment point, violet", 0.005, "mean"),
    "line of sight": Layer("grey line between the players", 0.25, "theory"),
    "safety radius": Layer("ring; inside it, its player evades", 0.007),
    "theoretical circle": Layer(
        "grey ring, on which the paper's game ends", 0.008, "theory"
    ),
    "support polygon": Layer(
        "green outline of the feet in contact", 0.009, "support"
    ),
    "pushes": Layer("magenta arrow, for 1 s after each push", 0.3, "pushed"),
}
PUSH_LENGTH = 0.25  # of an arrow, in [m] per [N s]
PUSH_SHOWN = 1.0  # time for which an arrow is shown, in [s]
NO_SEGMENTS = np.zeros((0, 2, 2))
NO_FOOTSTEPS = np.zeros((0, 5))
LANDED = 0.02  # after its landing time a foot is on the floor, in [s]


class SceneLines(NamedTuple):
    """Lines of one layer and one owner.

    Attributes:
        layer: One of ``LAYERS``.
        owner: Name of its player; empty without one.
        segments: Start and end (x, y) of each segment, in the world, in [m];
            relative to the player that it follows. Shape (n, 2, 2).
        times: Time at which each segment appears, ascending, in [s]; None if
            all are always there. Shape (n,).
        lasting: Time for which a segment remains, in [s].
        follows: A player that it moves with, or two that it connects.
        label: Name with its radius; empty without one.
    """

    layer: str
    owner: str
    segments: Array
    times: Array | None = None
    lasting: float = inf
    follows: tuple[str, ...] = ()
    label: str = ""

    def colour(self, theme: str, colours: Mapping[str, str]) -> str:
        """Return its colour in a theme, given those of the players."""
        name = LAYERS[self.layer].colour
        if not name:
            return colours[self.owner]
        found: str = getattr(PALETTES[theme], name)
        return found

    def shown(
        self, now: float, places: Mapping[str, Array], trail: float = inf
    ) -> Array:
        """Return the segments of a time, in the world, in [m].

        Places are the positions (x, y) of the players then, in [m], by name;
        segments remain no longer than a trail, in [s]. Shape (n, 2, 3).
        """
        flat = self.segments
        if self.times is not None:
            since = now - min(self.lasting, trail)
            first, end = np.searchsorted(self.times, [since, now], "right")
            flat = flat[first:end]
        if len(self.follows) == 2:
            flat = np.array([[places[name][:2] for name in self.follows]])
        elif self.follows:
            flat = flat + places[self.follows[0]][:2]
        height = np.full((len(flat), 2, 1), LAYERS[self.layer].height)
        return np.concatenate([flat, height], axis=2)

    def label_place(self, segments: Array) -> Array:
        """Return where its label stands beside its ring. Shape (3,)."""
        eighths = 7 if self.follows else 3
        place: Array = segments[eighths * len(segments) // 8, 0]
        return place


def polyline(points: Array, *, closed: bool = False) -> Array:
    """Return the segments of a polyline of points (m, 2). Shape (n, 2, 2)."""
    if closed:
        points = np.concatenate([points, points[:1]])
    return np.stack([points[:-1], points[1:]], axis=1)


def ring(x: float, y: float, radius: float) -> Array:
    """Return the segments of a circle, all in [m]. Shape (72, 2, 2)."""
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    return polyline(
        np.column_stack(
            [x + radius * np.cos(angle), y + radius * np.sin(angle)]
        )
    )


def safety_ring(player: str, radius: float) -> SceneLines:
    """Return the ring of a safety radius, in [m], around a player."""
    return SceneLines(
        "safety radius",
        player,
        ring(0.0, 0.0, radius),
        follows=(player,),
        label=f"safety radius {radius:.2f} m",
    )


def theory_ring(x: float, y: float, radius: float) -> SceneLines:
    """Return the circle of theory, all in [m]."""
    label = f"theoretical circle {radius:.2f} m"
    segments = ring(x, y, radius)
    return SceneLines("theoretical circle", "", segments, label=label)


def line_of_sight(one: str, other: str) -> SceneLines:
    """Return the line between two players."""
    name, both = f"{one}-{other}", (one, other)
    return SceneLines("line of sight", name, NO_SEGMENTS, follows=both)


def soles(rows: Array, sole: SoleRectangle) -> Array:
    """Return the outlines of soles, four segments each. Shape (4 m, 2, 2).

    Rows are side (1 left, -1 right), x [m], y [m], heading [rad].
    """
    outlines = [
        polyline(sole_corners(row[1:], Foot(int(row[0])), sole), closed=True)
        for row in rows
    ]
    return np.concatenate([NO_SEGMENTS, *outlines])


def push_arrows(player: str, pushes: Array) -> SceneLines:
    """Return arrows that end where pushes act.

    Rows are time [s], duration [s], x [m], y [m], impulse x and y [N s].
    """
    arrows = [NO_SEGMENTS]
    for x, y, *impulse in pushes[:, 2:].tolist():
        tip, shaft = np.array([x, y]), PUSH_LENGTH * np.array(impulse)
        aside = 0.25 * np.array([-shaft[1], shaft[0]])
        barbs = tip - 0.3 * shaft + aside, tip - 0.3 * shaft - aside
        arrows.append(
            np.array([[tip - shaft, tip], [barbs[0], tip], [tip, barbs[1]]])
        )
    times = np.repeat(pushes[:, 0], 3)
    segments = np.concatenate(arrows)
    return SceneLines("pushes", player, segments, times, PUSH_SHOWN)


def circle_of(run: Run) -> tuple[float, float, float] | None:
    """Return center (x, y) and radius of the circle of a run, in [m].

    It is that of theory, centered where the players walked in the end;
    None if they did not converge to it.
    """
    theory, since = run.theory, run.summary.converged_at_s
    if theory is None or since is None:
        return None
    tail = run.times >= since
    paths = [t.unicycle[tail, :2].mean(axis=0) for t in run.tracks.values()]
    x, y = np.mean(paths, axis=0).tolist()
    return x, y, theory[0]


def safety_areas(run: Run) -> dict[str, float]:
    """Return the radius of each player's safety area, in [m], by name."""
    settings = run.settings
    if isinstance(settings, GameSettings):
        return safety_radii(settings)
    if getattr(settings, "role", "") != EVADER:
        return {}
    radius = settings.evasion.area
    return {EVADER: radius} if isfinite(radius) else {}


def safety_radii(settings: GameSettings) -> dict[str, float]:
    """Return finite safety radii of the paper's evaders, in [m], by name."""
    return {
        p.name: p.evasion.area
        for p in settings.resolved().players
        if p.decides and p.strategy in OF_EVASION and isfinite(p.evasion.area)
    }


def overlays_of(run: Run, every: int = 1) -> list[SceneLines]:
    """Return all that lies over the scene of a run.

    ``every`` is the number of samples from one point of a path to the next.
    """
    found = []
    for name, track in run.tracks.items():
        times = run.times[::every]
        for layer, points in {
            "CoM trace": track.com,
            "ZMP trace": track.zmp,
        }.items():
            if points is None:
                continue
            segments = polyline(points[::every, :2])
            known = np.isfinite(segments).all(axis=(1, 2))
            found.append(
                SceneLines(layer, name, segments[known], times[1:][known])
            )
        steps = footsteps_in(run, name)
        if len(steps):
            sole = run.settings.player(name).gait.sole
            outlines = soles(steps[:, 1:], sole)
            landed_at = np.repeat(steps[:, 0], 4)
            found.append(SceneLines("footsteps", name, outlines, landed_at))
        if track.pushes is not None:
            found.append(push_arrows(name, track.pushes))
    found += [safety_ring(*area) for area in safety_areas(run).items()]
    pairs = run.facing or (run.opponents if len(run.players) == 2 else ())
    found += [line_of_sight(*pair) for pair in pairs]
    if (circle := circle_of(run)) is not None:
        found.append(theory_ring(*circle))
    return found


def footsteps_in(run: Run, name: str) -> Array:
    """Return where the soles of a player landed in the world. Shape (m, 5).

    Rows are time [s], side (1 left, -1 right), x [m], y [m], heading [rad].
    Footsteps that land after the end of the run are left out. Recorded
    landings are those of the plans, in odometry, which drifts: they are
    returned where no joint angles were recorded.
    """
    track = run.tracks[name]
    landings = NO_FOOTSTEPS if track.landings is None else track.landings
    if track.qpos is None or not len(landings):
        return landings
    robot = load_robot(run.settings.player(name).robot)
    model = robot.compile()
    feet = robot.left_foot, robot.right_foot
    left, right = (model.site(foot).id for foot in feet)
    data = mujoco.MjData(model)
    rows = []
    for time, side, *_ in landings.tolist():
        index = int(np.searchsorted(run.times, time + LANDED))
        if index >= len(run.times):
            continue
        data.qpos[:] = track.qpos[index]
        mujoco.mj_kinematics(model, data)
        sole = left if side > 0.0 else right
        axes = data.site_xmat[sole]
        heading = atan2(axes[3], axes[0])
        rows.append((time, side, *data.site_xpos[sole, :2], heading))
    return np.array(rows, dtype=np.float64).reshape(-1, 5)
