"""A live duel with a person, who is not pushed, driven or planned for."""

from collections.abc import Iterator
from math import pi
from threading import Event
from typing import Any

import numpy as np
import pytest
from stepaside.report.viewer.live_drawing import draw_session
from stepaside.report.viewer.scene_layers import SceneLayers

from fake_page import Gui
from stepaside.core.errors import ConfigurationError
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.floor_player import FloorPlayer
from stepaside.games.walker import SimulatedPlayer
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.report.viewer.drive_panel import DrivePanel, add_push
from stepaside.report.viewer.live_session import LiveSession
from stepaside.report.viewer.status_text import phases_of

START = StartSettings(distance=2.0, pursuer_offset=0.3, evader_offset=0.0)
LONG = 60.0  # [s]; no event of a loop that runs comes as late as this


@pytest.fixture
def session() -> Iterator[LiveSession]:
    made = LiveSession(DuelSettings(pursuer="person", start=START))
    yield made
    made.close()


def stepped(session: LiveSession, duration: float) -> None:
    """Let a while pass, and wait until it has."""
    done = Event()
    session.step(duration)
    session.change(lambda duel: done.set())
    assert done.wait(LONG) and session.error is None, session.error


def test_a_person_walks_on_in_a_step(session: LiveSession) -> None:
    person, evader = session.match.in_physics.players
    assert isinstance(person, FloorPlayer) and isinstance(
        evader, SimulatedPlayer
    )
    began = np.array(person.truth.position_torso_in_world)
    stepped(session, 1.0)
    assert session.match.world.time == pytest.approx(1.0)
    way = float(
        np.hypot(*(np.array(person.truth.position_torso_in_world) - began))
    )
    assert way == pytest.approx(0.15, rel=0.01)  # a second at its pace
    assert phases_of(session.match.in_physics.players) == (
        Phase.WALKING,
        Phase.STANDING,
    )
    assert len(session.trail.history) == 9
    assert set(session.trail.traces) == {
        *("pursuer/CoM", "evader/CoM", "evader/ZMP")
    }


def test_the_robot_is_pushed_and_the_person_is_not(
    session: LiveSession,
) -> None:
    """After the refusal the duel continues, and accepts other pushes."""
    before = session.match
    with pytest.raises(
        ConfigurationError, match="only a robot can be pushed, got pursuer"
    ):
        session.push("pursuer", 0.4, pi / 2)
    assert session.error is None and session.match is before
    stepped(session, 0.1)
    assert session.match.world.time == pytest.approx(0.1)
    session.push("evader", 0.4, pi / 2)
    stepped(session, 0.2)
    evader = session.match.in_physics.players[1]
    assert (
        isinstance(evader, SimulatedPlayer) and evader.robot.pusher is not None
    )
    assert np.hypot(*evader.robot.pusher.impulse[:2]) == pytest.approx(0.4)
    assert session.outcome is None


def test_the_push_button_says_that_a_person_is_not_pushed(
    session: LiveSession,
) -> None:
    gui: Any = Gui()
    said: list[str] = []
    add_push(gui, session, said.append)
    gui["Robot"].value = "pursuer"
    gui["Push"].press()
    assert said == ["only a robot can be pushed, got pursuer"]
    gui["Robot"].value = "evader"
    gui["Push"].press()
    assert said[1:] == ["pushed the evader left by 0.5 N s"]


def test_a_person_cannot_be_driven(session: LiveSession) -> None:
    """It walks as it would have."""
    gui: Any = Gui()
    panel = DrivePanel(gui, session)
    ways = []
    for driven in (False, True):
        session.reset()
        if driven:
            gui["Turn"].press("right")
            gui["Walk"].press("halt")
            gui["Drive left"].press()
        stepped(session, 0.5)
        panel.show()
        assert session.error is None
        ways.append(
            session.match.in_physics.players[0].truth.position_torso_in_world
        )
        gui["Stop driving"].press()
        stepped(session, 0.01)
    assert ways[0] == ways[1]


def test_of_a_person_only_its_way_is_drawn(session: LiveSession) -> None:
    """Plans, footsteps and a ZMP are the robot's."""
    stepped(session, 0.5)
    drawn: dict[tuple[str, str], Any] = {}

    def draw(layer: str, owner: str, lines: Any, colour: str) -> None:
        drawn[layer, owner] = lines

    layers: Any = SceneLayers.__new__(SceneLayers)
    layers.draw = draw
    draw_session(layers, session)
    of_person = {layer for layer, owner in drawn if owner == "pursuer"}
    assert of_person == {"CoM trace", "ZMP trace", "pushes"}
    assert len(drawn["CoM trace", "pursuer"]) == 3
    assert len(drawn["ZMP trace", "pursuer"]) == 0
    assert len(drawn["pushes", "pursuer"]) == 0
    of_robot = {layer for layer, owner in drawn if owner == "evader"}
    assert of_robot == {
        *("CoM trace", "ZMP trace", "pushes", "safety radius"),
        *("planned path", "footsteps", "support polygon"),
    }
    places = [
        player.truth.position_torso_in_world
        for player in session.match.in_physics.players
    ]
    (sight,) = drawn["line of sight", "pursuer-evader"]
    np.testing.assert_allclose(sight[:, :2], places)
    assert len(drawn["theoretical circle", "both"]) == 0
