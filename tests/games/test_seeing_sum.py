"""Test the evaluation of perception in duels with camera sensing."""

from dataclasses import replace
from math import atan2, hypot
from types import SimpleNamespace
from typing import Any

import cv2
import mujoco
import numpy as np
import pytest

from stepaside.arena import Room, RoomRecipe, generate_room
from stepaside.control.clearance.map_settings import MapSettings
from stepaside.control.sight_sources import CameraSight
from stepaside.core.poses import Pose, wrap_angle
from stepaside.games import camera_senses as seeing
from stepaside.games.camera_senses import CameraSenses, SightObserver
from stepaside.games.duel import Duel
from stepaside.games.duel_as_game import game_of_duel
from stepaside.games.duel_furnishing import scenery_of_duel
from stepaside.games.duel_settings import PLAYERS, DuelSettings, StartSettings
from stepaside.games.floor_player import FloorPlayer
from stepaside.games.initial_poses import (
    initial_poses,
    wall_distance,
    with_initial_poses,
)
from stepaside.games.outcome import Outcome
from stepaside.games.sight_evaluation import FrameCounts, SightEvaluator
from stepaside.games.sight_summary import ErrorSpread, SightSummary
from stepaside.games.walker import SimulatedPlayer
from stepaside.planning import Direction
from stepaside.robots.description import load_robot
from stepaside.robots.head import load_head
from stepaside.sim.camera_settings import (
    CameraSettings,
    ColourSettings,
    RoomObject,
    SceneSettings,
)
from stepaside.sim.ground_truth import GroundTruth
from stepaside.sim.person_settings import PersonSettings

RAYS = CameraSettings(colour=ColourSettings(renderer="raycast"))
SETTINGS = DuelSettings(
    seed=5,
    duration=20.0,
    sensing="cameras",
    cameras=RAYS,
    room=SceneSettings(things=[RoomObject("red box", 1.0, 2.0)]),
)


def saw(lost: float) -> SightSummary:
    """Return the summary of a robot that was lost for a time, in [s]."""
    none = ErrorSpread(None, None)
    return SightSummary(none, none, None, 0, 0.0, lost)


def evaluated(colour: FrameCounts, depth: FrameCounts, lost: float) -> Any:
    """Return the evaluator of a robot that was lost for a time."""
    return SimpleNamespace(
        colour=colour,
        depth=depth,
        stills={"colour": []},
        summary=lambda: saw(lost),
        array=lambda: np.full((2, 6), lost),
    )


def prepared(*names: str, **changes: Any) -> CameraSenses:
    settings = SETTINGS if not changes else DuelSettings(**changes)
    return CameraSenses(
        game_of_duel(with_initial_poses(settings)),
        load_robot("nao"),
        dict.fromkeys(names or PLAYERS, Direction.FORWARD),
        tick=0.004,
    )


def at(ticks: int) -> Any:
    """Return a match at one of its ticks."""
    return SimpleNamespace(
        world=SimpleNamespace(ticks=ticks, time=0.004 * ticks)
    )


def test_the_report_combines_both_robots_and_both_cameras() -> None:
    evaluators = {
        "pursuer": evaluated(FrameCounts(10, 9, 1), FrameCounts(), 0.5),
        "evader": evaluated(
            FrameCounts(20, 12, 3), FrameCounts(10, 3, 5), 1.25
        ),
    }
    both = SightObserver(evaluators, "raycast", every=5)
    together, each = both.report()
    assert together.camera == "raycast"
    assert together.detection_rate == pytest.approx(24 / 40)
    assert together.false_detections == 9
    assert together.lost_s == 1.75
    assert each["evader"] == saw(1.25)
    assert set(both.sight()) == {"pursuer", "evader"}
    assert both.sight()["evader"][0, 0] == 1.25
    assert both.stills()["pursuer"] is evaluators["pursuer"].stills
    blind = {"evader": evaluated(FrameCounts(), FrameCounts(), 0.0)}
    nothing, each = SightObserver(blind, "raycast", every=5).report()
    assert nothing.detection_rate is None and list(each) == ["evader"]


def test_perception_uses_one_core() -> None:
    cv2.setNumThreads(2)
    prepared()
    assert cv2.getNumThreads() == 1


def test_each_robot_has_its_own_perception() -> None:
    both = prepared().perceptions
    assert list(both) == ["pursuer", "evader"]
    assert both["pursuer"] is not both["evader"]
    assert list(prepared("evader").perceptions) == ["evader"]


def test_each_robot_detects_the_trim_of_its_opponent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def detector_of(*parts: Any, **others: Any) -> Any:
        return parts[2]

    monkeypatch.setattr(seeing, "build_perception", detector_of)
    detectors: dict[str, Any] = dict(prepared().perceptions)
    hues = {name: each.appearance.hue for name, each in detectors.items()}
    assert 100 < hues["pursuer"] < 120  # blue, of the evader
    assert hues["evader"] == 0  # red, of the pursuer


def test_only_the_evader_has_a_depth_camera(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    opened: list[tuple[Any, ...]] = []

    def open_eyes(*arguments: Any, with_depth: bool, looks_low: Any) -> Any:
        assert looks_low is None  # where no person comes
        opened.append((*arguments, with_depth))
        return f"eyes {len(opened)}"

    monkeypatch.setattr(seeing, "SensorSuite", open_eyes)
    both, world = prepared(), object()
    eyes: list[Any] = [both.eyes_of(world, name) for name in PLAYERS]  # type: ignore[arg-type]
    assert eyes == ["eyes 1", "eyes 2"]
    assert [(a[0], a[1], a[-1]) for a in opened] == [
        (world, "pursuer", False),
        (world, "evader", True),
    ]
    assert all(a[4:6] == (None, 5) for a in opened)


def test_each_robot_is_evaluated_by_the_true_state_of_its_opponent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Five stills within the duel, at quadratic times."""
    made: list[tuple[Any, ...]] = []

    def evaluate(*a: Any, wears_trim: bool) -> None:
        made.append((*a, wears_trim))

    monkeypatch.setattr(seeing, "SightEvaluator", evaluate)
    both = prepared()
    robot: Any = SimpleNamespace(name="pursuer")
    truth: Any = object()
    objects = SETTINGS.room.things
    both.evaluator_of(robot, truth, objects, wears_trim=False)
    ((own, other, mind, _, things, times, wears_trim),) = made
    assert wears_trim is False
    assert own is robot and other is truth
    assert mind is both.perceptions["pursuer"]
    assert things == [(1.0, 2.0)]
    assert len(times) == 5
    assert times[0] == pytest.approx(0.98 * 20.0 / 81)
    assert times[-1] == pytest.approx(0.98 * 20.0)
    roots = np.sqrt(times)
    np.testing.assert_allclose(np.diff(roots), np.diff(roots)[0])
    assert roots[0] == pytest.approx(0.5 * np.diff(roots)[0])


def check_truth(
    evaluator: SightEvaluator, own: GroundTruth, other: GroundTruth
) -> None:
    """Compare the true bearing and distance that an evaluator records."""
    evaluator.sample(0.0)
    bearing, distance = evaluator.array()[-1, 3:5].tolist()
    x, y = own.position_torso_in_world
    u, v = other.position_torso_in_world
    assert distance == pytest.approx(hypot(u - x, v - y))
    expected = atan2(v - y, u - x) - own.heading_in_world
    assert wrap_angle(bearing - expected) == pytest.approx(0.0, abs=1e-9)


def test_each_robot_with_cameras_is_evaluated() -> None:
    duel = Duel(replace(SETTINGS, duration=1.0))
    observer = duel.sight_observer
    assert observer is not None and list(observer.evaluators) == list(PLAYERS)
    assert duel.observers == (duel.recorder, observer)
    for own, other in (duel.players, duel.players[::-1]):
        assert isinstance(own, SimulatedPlayer)
        assert own.robot.eyes is not None and not own.robot.sees_exactly
        assert isinstance(own.scheme.senses, CameraSight)
        check_truth(observer.evaluators[own.name], own.truth, other.truth)
    duel.close()


def test_a_person_has_no_cameras() -> None:
    duel = Duel(replace(SETTINGS, duration=1.0, pursuer="person"))
    observer = duel.sight_observer
    assert observer is not None and list(observer.evaluators) == ["evader"]
    person, robot = duel.players
    assert isinstance(person, FloorPlayer)
    check_truth(observer.evaluators["evader"], robot.truth, person.truth)
    assert duel.tick() is None
    run = duel.run(Outcome.COMPLETED, 1.0)
    assert run.evader.sight is not None and run.pursuer.sight is None
    assert run.summary.pursuer.sight is None
    assert run.summary.evader.sight is not None
    assert run.summary.evader.sight.lost_s >= 0.0
    duel.close()


def test_a_duel_with_ideal_sight_has_no_sight_observer() -> None:
    duel = Duel(DuelSettings(seed=5))
    assert duel.sight_observer is None and duel.observers == (duel.recorder,)


def test_both_evaluators_sample_at_the_same_instants() -> None:
    times: list[float] = []
    one: Any = SimpleNamespace(sample=times.append)
    both = SightObserver({"pursuer": one, "evader": one}, "raycast", every=5)
    for ticks in range(11):
        both.before(at(ticks))
    assert times == pytest.approx([0.0, 0.0, 0.02, 0.02, 0.04, 0.04])


def test_both_evaluators_observe_every_tick() -> None:
    looked: list[str] = []
    evaluators: dict[str, Any] = {
        name: SimpleNamespace(
            evaluate_tick=lambda name=name: looked.append(name)
        )
        for name in PLAYERS
    }
    both = SightObserver(evaluators, "raycast", every=5)
    for ticks in range(3):
        both.acted(at(ticks))
    both.ended(at(3), Outcome.COMPLETED)
    assert looked == 3 * ["pursuer", "evader"]


@pytest.mark.parametrize(
    ("asked", "distance", "there"),
    [
        (5.0, 1.5, 5.0),
        (2.0, 0.8, 2.0),
        (5.0, 4.0, 5.0),
        (5.0, 4.5, 8.0),
        (5.0, 8.0, 11.5),
        (20.0, 8.0, 20.0),
        (0.0, 8.0, 0.0),
    ],
)
def test_players_begin_well_inside_the_walls(
    asked: float, distance: float, there: float
) -> None:
    settings = DuelSettings(
        room=SceneSettings(walls=asked),
        start=StartSettings(distance, 0.0, 0.0),
    )
    assert wall_distance(settings) == pytest.approx(there)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("who", [0, 1])
def test_the_walls_of_a_room_are_beyond_every_start(
    who: int, axis: int, side: float
) -> None:
    """For either player far out, on any side."""
    starts = [Pose(0.5, 0.0, 0.0), Pose(-0.5, 0.0, 0.0)]
    far = side * 4.5
    starts[who] = Pose(far, 0.0, 0.0) if axis == 0 else Pose(0.0, far, 0.0)
    plan = Room(10.0, 10.0, starts=(starts[0], starts[1]))
    settings = with_initial_poses(DuelSettings(room=SceneSettings(plan=plan)))
    assert wall_distance(settings) == pytest.approx(8.0)


def test_no_wall_is_between_a_robot_and_a_fast_person() -> None:
    settings = with_initial_poses(
        DuelSettings(
            pursuer="person",
            person=PersonSettings("straight", 1.0),
            sensing="cameras",
            cameras=CameraSettings(colour=ColourSettings(renderer="raycast")),
        )
    )
    spec = mujoco.MjSpec()
    head = load_head(load_robot("nao")).body
    spec.worldbody.add_body(name=f"evader/{head}")
    scenery_of_duel(settings).furnish(spec)
    evader = initial_poses(settings)[1]
    assert evader.x > 5.0
    assert spec.geom("wall 1 0").pos[0] - evader.x == pytest.approx(3.5)


def test_robots_that_map_a_room_wait_for_the_start_of_the_game() -> None:
    room = SceneSettings(plan=generate_room(RoomRecipe(discs=1), 3))
    mapping = prepared(
        seed=3,
        sensing="cameras",
        cameras=RAYS,
        room=room,
        map=MapSettings(source="seen"),
    ).perceptions
    for each in mapping.values():
        assert not each.head.is_ready and each.head.scans
    for each in prepared().perceptions.values():
        assert each.head.is_ready and not each.head.scans
