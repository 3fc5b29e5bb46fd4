"""Parts of the page: bodies, lines, words, pictures, without a browser."""

from contextlib import nullcontext
from math import inf, sqrt
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from stepaside.report.viewer.live_drawing import ZMP_COLOURS, draw_session
from stepaside.report.viewer.plot_history import PlotHistory
from stepaside.report.viewer.scene_layers import (
    HEIGHTS,
    LAYERS,
    MAX_FOOTPRINTS,
    SceneLayers,
    footprints_of,
    path_of,
    polyline,
    rgb,
    ring,
    safety_ring,
    support_outline,
)
from stepaside.report.viewer.true_odometry import true_odometry

from fake_page import Scene
from stepaside.core.poses import Array, Pose
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.initial_poses import initial_poses
from stepaside.games.recorded_game import RecordedGame
from stepaside.locomotion.walk_snapshots import Phase, WalkState
from stepaside.planning import Foot, SoleRectangle
from stepaside.planning.support_polygon import sole_corners
from stepaside.report.figure_style import COLOURS, EVADER, THEORY
from stepaside.report.palette import ON_BOTH_FLOORS
from stepaside.report.viewer import live_drawing as drawing
from stepaside.report.viewer.scene_bodies import (
    SceneBodies,
    join_meshes,
    shape_of,
)
from stepaside.report.visual_geoms import colour_of, visual_geoms_of

SHAPES = """
<mujoco>
<asset><material name="grass" rgba="0 0.5 2 1"/></asset>
<worldbody><geom type="plane" size="1 1 1"/>
<body pos="1 2 3">
<geom type="capsule" size="0.02 0.1" pos="0.5 0 0" rgba="1 0 0 1"
quat="0.7071067811865476 0 0.7071067811865476 0"/>
<geom type="sphere" size="0.3" pos="0 1 0" material="grass"/>
<geom type="box" size="0.1 0.4 0.025" pos="0 0 1" rgba="1 0 0 1"/>
<geom type="cylinder" size="0.05 0.2" rgba="0 0 0 1"/>
<geom type="ellipsoid" size="0.1 0.2 0.3"/>
<geom type="sphere" size="0.4" group="3"/>
</body></worldbody></mujoco>
"""


def test_meshes_are_as_large_as_their_shapes_and_in_their_place() -> None:
    parts = visual_geoms_of(mujoco.MjModel.from_xml_string(SHAPES))
    for part, (middle, half, close) in zip(
        parts,
        (
            ((0.5, 0, 0), (0.12, 0.02, 0.02), 1e-3),
            ((0, 1, 0), (0.3, 0.3, 0.3), 2e-2),
            ((0, 0, 1), (0.1, 0.4, 0.025), 1e-9),
            ((0, 0, 0), (0.05, 0.05, 0.2), 2e-3),
            ((0, 0, 0), (0.1, 0.2, 0.3), 2e-2),
        ),
        strict=True,
    ):
        mesh = shape_of(part)
        low, high = mesh.bounds
        np.testing.assert_allclose(0.5 * (low + high), middle, atol=close)
        np.testing.assert_allclose(0.5 * (high - low), half, atol=close)


def test_colours_are_those_of_the_material_or_the_geom() -> None:
    model = mujoco.MjModel.from_xml_string(SHAPES)
    assert colour_of(model, 1) == (255, 0, 0)
    assert colour_of(model, 2) == (0, 127, 255)


def test_every_visible_body_is_on_the_page_once_for_each_colour() -> None:
    model = mujoco.MjModel.from_xml_string(SHAPES)
    scene: Any = Scene()
    bodies = SceneBodies(scene, model)
    assert set(scene.items) == {"/bodies/1"} | {
        f"/bodies/1/{number}" for number in range(4)
    }
    meshes = {
        item.color: item for n, item in scene.items.items() if len(n) > 9
    }
    assert set(meshes) >= {(255, 0, 0), (0, 127, 255), (0, 0, 0)}
    red = meshes[255, 0, 0]
    # Capsule and box are one mesh; every triangle has its own corners.
    parts = visual_geoms_of(model)
    alone = [shape_of(parts[i]) for i in (0, 2)]
    assert len(red.corners) == sum(len(m.vertices) for m in alone)
    assert red.faces.max() == len(red.corners) - 1
    sizes = red.corners.max(axis=0)
    np.testing.assert_allclose(sizes, [0.62, 0.4, 1.025], atol=1e-3)
    positions = np.arange(6.0).reshape(2, 3)
    quaternions = np.arange(8.0).reshape(2, 4)
    bodies.move(positions, quaternions)
    frame = scene.items["/bodies/1"]
    np.testing.assert_array_equal(frame.position, [3, 4, 5])
    np.testing.assert_array_equal(frame.wxyz, [4, 5, 6, 7])


def test_joined_meshes_keep_their_triangles() -> None:
    parts = visual_geoms_of(mujoco.MjModel.from_xml_string(SHAPES))
    meshes = [shape_of(part) for part in parts[2:4]]
    corners, faces = join_meshes(meshes)
    triangles = np.concatenate([m.vertices[m.faces] for m in meshes])
    np.testing.assert_allclose(corners[faces], triangles, atol=1e-6)


def test_a_chain_joins_neighbours_at_its_height() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    segments = polyline(points, 0.3)
    np.testing.assert_array_equal(
        segments,
        [[[0, 0, 0.3], [1, 0, 0.3]], [[1, 0, 0.3], [1, 1, 0.3]]],
    )
    closed = polyline(points, 0.3, closed=True)
    np.testing.assert_array_equal(closed[:2], segments)
    np.testing.assert_array_equal(closed[2], [[1, 1, 0.3], [0, 0, 0.3]])
    assert polyline(points[:1], 0.3).shape == (0, 2, 3)
    assert polyline(points[:0], 0.3, closed=True).shape == (0, 2, 3)
    assert polyline(points[:2], 0.3).shape == (1, 2, 3)


def test_a_ring_is_round_and_closed() -> None:
    lines = ring(1.0, -2.0, 0.5, 0.1)
    away = np.hypot(lines[..., 0] - 1.0, lines[..., 1] + 2.0)
    np.testing.assert_allclose(away, 0.5)
    np.testing.assert_array_equal(lines[..., 2], 0.1)
    np.testing.assert_allclose(lines[1:, 0], lines[:-1, 1])
    np.testing.assert_allclose(lines[0, 0], lines[-1, 1])
    assert len(lines) == 72
    steps = np.hypot(*(lines[:, 1] - lines[:, 0])[:, :2].T)
    np.testing.assert_allclose(steps, steps[0])


def test_the_safety_area_is_a_ring_or_nothing() -> None:
    lines = safety_ring(np.array([1.0, 2.0, 9.0]), 0.8)
    away = np.hypot(lines[..., 0] - 1.0, lines[..., 1] - 2.0)
    np.testing.assert_allclose(away, 0.8)
    assert safety_ring(np.zeros(2), inf).shape == (0, 2, 3)


def test_lines_are_drawn_when_they_change_and_go_when_hidden() -> None:
    scene: Any = Scene()
    layers = SceneLayers(scene)
    name = "/layers/footsteps/evader"
    lines = ring(0.0, 0.0, 1.0, 0.0)
    layers.draw("footsteps", "evader", lines, "#1f5fbf")
    layers.draw("footsteps", "evader", lines, "#1f5fbf")
    assert scene.drawn == 1 and set(scene.items) == {name}
    np.testing.assert_allclose(scene.items[name].points, lines, atol=1e-6)
    # A blue that is seen on the dark floor, too.
    assert scene.items[name].colors == rgb(ON_BOTH_FLOORS["#1f5fbf"])
    layers.draw("footsteps", "evader", 2.0 * lines, "#1f5fbf")
    assert scene.drawn == 2
    layers.shown["footsteps"] = False
    layers.draw("footsteps", "evader", 2.0 * lines, "#1f5fbf")
    assert scene.items == {}
    layers.draw("footsteps", "evader", lines, "#1f5fbf")
    layers.shown["footsteps"] = True
    layers.draw("footsteps", "evader", 2.0 * lines, "#1f5fbf")
    assert set(scene.items) == {name}
    layers.draw("footsteps", "evader", lines[:0], "#1f5fbf")
    assert scene.items == {}
    layers.draw("CoM trace", "evader", lines, "#1f5fbf")
    layers.clear()
    assert scene.items == {}
    layers.draw("CoM trace", "evader", lines, "#1f5fbf")
    assert len(scene.items) == 1


def test_layers_lie_above_each_other() -> None:
    heights = [HEIGHTS[layer] for layer in LAYERS]
    assert heights == sorted(heights) and len(set(heights)) == len(LAYERS)
    assert 0.0 < heights[0] and heights[-1] < 0.02
    assert rgb("#0a141e") == (10, 20, 30)


def playing(time: float, **changes: Any) -> tuple[RecordedGame, PlotHistory]:
    start, trail = StartSettings(0.75, 0.3, -0.2), PlotHistory()
    duel = RecordedGame(DuelSettings(start=start, **changes), (trail,))
    while duel.world.time < time:
        assert duel.tick() is None
    return duel, trail


@pytest.fixture(scope="module")
def played() -> tuple[RecordedGame, PlotHistory]:
    return playing(2.0)


def walks(duel: RecordedGame) -> list[tuple[str, WalkState, Pose]]:
    """Name, state and true odometry of both robots."""
    found = []
    for player in duel.in_physics.players:
        walk, odometry = player.snapshot().walk, true_odometry(player)
        assert walk is not None and odometry is not None
        found.append((player.name, walk, odometry))
    return found


def test_a_plan_is_drawn_in_the_world(
    played: tuple[RecordedGame, PlotHistory],
) -> None:
    """Its path runs midway between the footsteps, on the floor's frame."""
    duel, trail = played
    for (name, walk, frame), wanted_frame in zip(
        walks(duel), initial_poses(duel.settings), strict=True
    ):
        # Two seconds of a walk in open loop: millimetres from its start.
        np.testing.assert_allclose(frame, wanted_frame, atol=5e-3)
        plan = walk.plan
        assert plan is not None
        path = path_of(walk, frame)
        at = frame.compose(walk.plan_frame)
        placed = at.transform_points(plan.placements[:, :2])
        np.testing.assert_allclose(path, 0.5 * (placed[1:-1] + placed[2:]))
        begun = trail.steps[name]
        assert len(begun) >= 2
        prints = footprints_of(walk, begun, frame)
        wanted = [
            (step.foot, at.compose(Pose(step.x, step.y, step.theta)))
            for step in plan.footsteps
        ]
        corners = [
            sole_corners(np.array(pose), foot, walk.gait.sole)
            for foot, pose in (*begun, *wanted)
        ]
        np.testing.assert_allclose(prints[:, 0, :2], np.concatenate(corners))
        np.testing.assert_array_equal(prints[..., 2], HEIGHTS["footsteps"])


def test_nothing_is_planned_before_a_robot_walks() -> None:
    duel, trail = playing(0.0)
    for name, walk, frame in walks(duel):
        assert path_of(walk, frame).shape == (0, 2)
        assert footprints_of(walk, (), frame).shape == (0, 2, 3)
        assert name not in trail.steps


def test_old_footsteps_are_left_out(
    played: tuple[RecordedGame, PlotHistory],
) -> None:
    """The last ones are drawn, however many are kept."""
    duel, trail = played
    name, walk, frame = walks(duel)[0]
    foot, _ = trail.steps[name][-1]
    many = [(foot, Pose(100.0 + i, 0.0, 0.0)) for i in range(80)]
    session = told(duel, trail)
    session.trail.steps = {name: many}
    lines, _ = drawn(session)["footsteps", name]
    plan = walk.plan
    assert plan is not None
    assert len(lines) == 4 * (MAX_FOOTPRINTS + len(plan.footsteps))
    wanted = footprints_of(walk, many[-MAX_FOOTPRINTS:], frame)
    np.testing.assert_array_equal(lines, wanted)


@pytest.mark.parametrize(
    ("remaining", "walking", "swing", "others"),
    [
        (0.1, True, Foot.LEFT, None),
        (0.0, True, Foot.LEFT, "landing"),
        (-0.1, True, Foot.RIGHT, "landing"),
        (0.0, False, Foot.LEFT, "left_foot"),
        (0.0, False, Foot.RIGHT, "right_foot"),
    ],
)
def test_the_support_polygon_is_of_the_feet_that_stand(
    remaining: float, walking: bool, swing: Foot, others: str | None
) -> None:
    feet = {
        "support": Pose(0.0, -0.05 * swing.value, 0.1),
        "landing": Pose(0.04, 0.06 * swing.value, 0.2),
        "left_foot": Pose(0.01, 0.07, 0.0),
        "right_foot": Pose(0.01, -0.07, 0.0),
    }
    step = SimpleNamespace(
        support=feet["support"],
        landing=feet["landing"],
        swing=swing,
        remaining=remaining,
        walking=walking,
    )
    sole = SoleRectangle()
    walk: Any = SimpleNamespace(
        step=lambda now: step,
        gait=SimpleNamespace(sole=sole),
        left_foot=feet["left_foot"],
        right_foot=feet["right_foot"],
    )
    frame = Pose(1.0, 2.0, 0.7)
    outline = support_outline(walk, frame, 0.0)
    stand = [(feet["support"], swing.other)]
    if others is not None:
        stand.append((feet[others], swing))
    corners = np.concatenate(
        [
            sole_corners(np.array(frame.compose(pose)), foot, sole)
            for pose, foot in stand
        ]
    )
    points = outline[:, 0, :2]
    # Each corner of the outline is one of a sole, and nothing sticks out.
    for point in points:
        assert np.hypot(*(corners - point).T).min() < 1e-9
    ways = np.roll(points, -1, axis=0) - points
    for corner in corners:
        off = corner - points
        side = ways[:, 0] * off[:, 1] - ways[:, 1] * off[:, 0]
        assert side.min() > -1e-9 or side.max() < 1e-9
    assert len(points) == (4 if others is None else len(points)) >= 4
    assert outline[0, 0, 2] == HEIGHTS["support polygon"]


def told(duel: RecordedGame, trail: PlotHistory, **changes: Any) -> Any:
    """A session as the layers need it."""
    traces = {
        f"{player.name}/{what}": [(0.1 * i, 0.2) for i in range(4)]
        for player in duel.in_physics.players
        for what in ("CoM", "ZMP")
    }
    values = {
        "lock": nullcontext(),
        "match": duel,
        "colours": COLOURS,
        "opponents": (("pursuer", "evader"),),
        "trail": SimpleNamespace(traces=traces, steps=trail.steps),
        "settings": duel.settings,
        "theory_radius": 0.6,
        **changes,
    }
    return SimpleNamespace(**values)


def drawn(session: Any) -> dict[tuple[str, str], tuple[Array, str]]:
    found: dict[tuple[str, str], tuple[Array, str]] = {}

    def draw(layer: str, owner: str, lines: Array, colour: str) -> None:
        assert layer in LAYERS and (layer, owner) not in found
        found[layer, owner] = lines, colour

    layers: Any = SimpleNamespace(draw=draw)
    draw_session(layers, session)
    return found


def test_every_layer_of_the_present_moment_is_drawn(
    played: tuple[RecordedGame, PlotHistory],
) -> None:
    duel, trail = played
    found = drawn(told(duel, trail))
    places = [
        player.truth.position_torso_in_world
        for player in duel.in_physics.players
    ]
    assert [name for name, _, _ in walks(duel)] == list(COLOURS)
    for name, walk, frame in walks(duel):
        for layer, wanted, colour in (
            (
                "planned path",
                polyline(path_of(walk, frame), HEIGHTS["planned path"]),
                COLOURS[name],
            ),
            (
                "footsteps",
                footprints_of(walk, trail.steps[name], frame),
                COLOURS[name],
            ),
            (
                "support polygon",
                support_outline(walk, frame, duel.world.time),
                "#2a9d55",
            ),
        ):
            lines, shade = found[layer, name]
            np.testing.assert_array_equal(lines, wanted)
            assert shade == colour
        trace, shade = found["CoM trace", name]
        assert trace.shape == (3, 2, 3) and shade == COLOURS[name]
        np.testing.assert_allclose(trace[:, 0, 0], [0.0, 0.1, 0.2])
        trace, shade = found["ZMP trace", name]
        assert trace.shape == (3, 2, 3) and shade == ZMP_COLOURS[COLOURS[name]]
    safety, shade = found["safety radius", "evader"]
    away = np.hypot(*(safety[:, 0, :2] - places[1]).T)
    np.testing.assert_allclose(away, 0.8)
    assert shade == EVADER
    circle, shade = found["theoretical circle", "both"]
    assert circle.shape == (72, 2, 3) and shade == THEORY
    assert "evader" in duel.in_physics.first_moves and len(found) == 15
    sight, shade = found["line of sight", "pursuer-evader"]
    np.testing.assert_allclose(sight[0, :, :2], places)
    np.testing.assert_allclose(sight[0, :, 2], 0.25)
    assert shade == THEORY


def walking(plan: Any, moves: tuple[str, ...] = ("evader",)) -> Any:
    """A world whose pursuer has a plan, or none."""
    walk = SimpleNamespace(plan=plan)
    player = SimpleNamespace(snapshot=lambda: SimpleNamespace(walk=walk))
    return SimpleNamespace(first_moves=moves, player=lambda name: player)


@pytest.mark.parametrize("bearing", [0.5, -0.5, 0.0, None])
def test_the_circle_passes_both_robots_on_the_pursuers_side(
    bearing: float | None,
) -> None:
    plan = None if bearing is None else SimpleNamespace(bearing=bearing)
    duel = walking(plan)
    places = [np.array([1.0, 1.0]), np.array([1.6, 1.6])]
    lines = drawing.circle_lines(duel, 0.6, places)
    middle = lines[:, 0, :2].mean(axis=0)
    for place in places:
        assert np.hypot(*(place - middle)) == pytest.approx(0.6)
    away = np.hypot(*(lines[:, 0, :2] - middle).T)
    np.testing.assert_allclose(away, 0.6)
    left = (middle - 1.3) @ np.array([-1.0, 1.0])
    assert left == pytest.approx(
        (-1.0 if bearing == -0.5 else 1.0) * sqrt(2.0 * (0.36 - 0.18))
    )
    np.testing.assert_array_equal(lines[..., 2], HEIGHTS["theoretical circle"])


def test_a_circle_that_cannot_be_is_not_drawn() -> None:
    def lines(radius: float | None, apart: float, *moves: str) -> int:
        duel = walking(None, moves)
        places = [np.zeros(2), np.array([apart, 0.0])]
        return len(drawing.circle_lines(duel, radius, places))

    assert lines(0.6, 1.1, "evader") == 72
    assert lines(None, 1.1, "evader") == 0 == lines(0.6, 1.1, "pursuer")
    assert lines(0.6, 1.3, "evader") == 0 == lines(0.6, 0.0, "evader")


STAND, WALK, HALT, FELL = (
    Phase.STANDING,
    Phase.WALKING,
    Phase.HALTING,
    Phase.FALLEN,
)
