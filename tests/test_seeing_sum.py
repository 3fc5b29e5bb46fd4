"""Test what a duel with cameras says of both who see."""

from types import SimpleNamespace
from typing import Any

import cv2
import numpy as np
import pytest

from stepaside.games import seeing
from stepaside.games.judge import Tally
from stepaside.games.seeing import Seeing
from stepaside.games.settings import DuelSettings
from stepaside.robots.description import load_robot
from stepaside.world.camera_settings import (
    CameraSettings,
    ColourSettings,
    RoomSettings,
    Thing,
)

RAYS = CameraSettings(colour=ColourSettings(renderer="raycast"))
SETTINGS = DuelSettings(
    seed=5,
    duration=20.0,
    sensing="cameras",
    cameras=RAYS,
    room=RoomSettings(things=[Thing("red box", 1.0, 2.0)]),
)


def judged(colour: Tally, depth: Tally, lost: float) -> Any:
    """A judge of a robot that was lost for a time."""
    return SimpleNamespace(
        colour=colour,
        depth=depth,
        stills={"colour": []},
        figures=lambda: {"lost_s": lost},
        array=lambda: np.full((2, 6), lost),
    )


def prepared(**changes: Any) -> Seeing:
    settings = SETTINGS if not changes else DuelSettings(**changes)
    return Seeing(settings, load_robot("nao"))


def test_figures_are_of_both_robots_and_both_cameras() -> None:
    both = prepared()
    both.judges = {
        "pursuer": judged(Tally(10, 9, 1), Tally(), 0.5),
        "evader": judged(Tally(20, 12, 3), Tally(10, 3, 5), 1.25),
    }
    figures = both.figures()
    assert figures["camera"] == "raycast"
    assert figures["detection_rate"] == pytest.approx(24 / 40)
    assert figures["false_detections"] == 9
    assert figures["lost_s"] == 1.75
    assert figures["evader"] == {"lost_s": 1.25}
    assert set(both.arrays()) == {"pursuer_sight", "evader_sight"}
    assert both.arrays()["evader_sight"][0, 0] == 1.25
    assert both.stills()["pursuer"] is both.judges["pursuer"].stills
    both.judges = {"evader": judged(Tally(), Tally(), 0.0)}
    assert both.figures()["detection_rate"] is None


def test_seeing_takes_one_core() -> None:
    cv2.setNumThreads(2)
    prepared()
    assert cv2.getNumThreads() == 1


def test_a_person_sees_without_cameras() -> None:
    cameras = {"sensing": "cameras", "cameras": RAYS}
    assert list(prepared(**cameras).perceptions) == ["pursuer", "evader"]
    alone = prepared(**cameras, pursuer="person")
    assert list(alone.perceptions) == ["evader"]


def test_each_looks_for_the_trim_of_the_other() -> None:
    minds = prepared().perceptions
    hues = {
        name: mind._detector.appearance.hue for name, mind in minds.items()
    }
    assert 100 < hues["pursuer"] < 120  # blue, of the evader
    assert hues["evader"] == 0  # red, of the pursuer


def test_who_opens_eyes_is_judged_and_only_the_evader_feels_depth(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    opened: list[tuple[Any, ...]] = []
    judged: list[tuple[Any, ...]] = []

    def open_eyes(*arguments: Any, with_depth: bool) -> Any:
        opened.append((*arguments, with_depth))
        return SimpleNamespace(on_exposure=None)

    def judge(*arguments: Any) -> Any:
        judged.append(arguments)
        return SimpleNamespace(still_times=(), note=arguments[0].name)

    monkeypatch.setattr(seeing, "Eyes", open_eyes)
    monkeypatch.setattr(seeing, "Judge", judge)
    pursuer: Any = SimpleNamespace(name="pursuer", world="world", eyes=None)
    evader: Any = SimpleNamespace(name="evader", world="world", eyes=None)
    both = prepared()
    both.open([pursuer, evader])
    assert [(a[1], a[-1]) for a in opened] == [
        ("pursuer", False),
        ("evader", True),
    ]
    assert all(a[2] == "torso" and a[5:7] == ("raycast", 5) for a in opened)
    assert [(a[0].name, a[1].name) for a in judged] == [
        ("pursuer", "evader"),
        ("evader", "pursuer"),
    ]
    assert judged[0][2] is both.perceptions["pursuer"]
    assert judged[0][4] == [(1.0, 2.0)]
    assert pursuer.eyes.on_exposure == "pursuer"
    # Five stills within the duel, at square times from near its begin.
    times = both.judges["evader"].still_times
    assert len(times) == 5
    assert times[0] == pytest.approx(0.98 * 20.0 / 81)
    assert times[-1] == pytest.approx(0.98 * 20.0)
    roots = np.sqrt(times)
    np.testing.assert_allclose(np.diff(roots), np.diff(roots)[0])
    assert roots[0] == pytest.approx(0.5 * np.diff(roots)[0])


def test_a_person_opens_no_eyes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        seeing, "Eyes", lambda *a, **k: SimpleNamespace(on_exposure=None)
    )
    monkeypatch.setattr(seeing, "Judge", lambda *a: SimpleNamespace(note=None))
    alone = prepared(sensing="cameras", cameras=RAYS, pursuer="person")
    person: Any = SimpleNamespace(name="pursuer", world=None)
    evader: Any = SimpleNamespace(name="evader", world=None)
    alone.open([person, evader])
    assert list(alone.judges) == ["evader"]
    assert not hasattr(person, "eyes")


def test_both_judges_sample_at_one_instant() -> None:
    both = prepared()
    times: list[float] = []
    one: Any = SimpleNamespace(sample=times.append)
    both.judges = {"pursuer": one, "evader": one}
    both.sample(1.5)
    assert times == [1.5, 1.5]
