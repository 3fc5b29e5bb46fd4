"""Test the live page and the replay on a fake page."""

from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from math import degrees, inf, pi, radians
from threading import Event, RLock, Thread
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from fake_page import Client, Gui, open_fake
from match_callbacks import observe_ticks
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.errors import ConfigurationError, StepAsideError
from stepaside.core.poses import Pose, wrap_angle
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.match import Match
from stepaside.games.outcome import Outcome
from stepaside.games.walker import SimulatedPlayer
from stepaside.locomotion.zmp.control_settings import OPEN_LOOP, STABILISED
from stepaside.perception.images import ColourImage, DepthImage
from stepaside.perception.percept_stages import FrameReport
from stepaside.planning import GaitSettings
from stepaside.report.figure_style import EVADER, PURSUER
from stepaside.report.palette import ON_BOTH_FLOORS
from stepaside.report.viewer import live_page as pages
from stepaside.report.viewer import plot_history as trails
from stepaside.report.viewer.drive_panel import DrivePanel, add_push
from stepaside.report.viewer.live_page import Page
from stepaside.report.viewer.live_session import LiveSession
from stepaside.report.viewer.plot_history import PlotHistory
from stepaside.report.viewer.plots import Plots
from stepaside.report.viewer.true_odometry import true_odometry
from stepaside.sim.body_settings import BODIES
from stepaside.strategies import (
    Evasion,
    EvasionMemory,
    Pursuit,
    TeleoperatedPursuit,
)

START = StartSettings(distance=1.0, pursuer_offset=0.3, evader_offset=-0.2)
SETTINGS = DuelSettings(start=START)


@pytest.fixture
def session() -> Iterator[LiveSession]:
    made = LiveSession(SETTINGS)
    yield made
    made.close()


def settings_of(session: LiveSession) -> DuelSettings:
    """Settings of a session with a duel."""
    assert isinstance(session.settings, DuelSettings)
    return session.settings


def played(session: LiveSession, ticks: int) -> None:
    """Let the loop play, and wait until it has."""
    if ticks:
        session.step(ticks * session.match.world.physics.tick)
    done = Event()
    session.change(lambda duel: done.set())
    assert done.wait(60.0), session.error


def walker(session: LiveSession, number: int) -> SimulatedPlayer:
    """Player who is a robot."""
    player = session.match.players[number]
    assert isinstance(player, SimulatedPlayer)
    return player


def test_a_session_notes_every_tenth_of_a_second(session: LiveSession) -> None:
    """Of each, what is true then; the tick that begins then notes it."""
    duel, trail = session.match, session.trail
    played(session, 125)
    times = [row[0] for row in trail.history]
    np.testing.assert_allclose(times, [0.1, 0.2, 0.3, 0.4])
    assert duel.world.time == pytest.approx(0.5)
    robots = [walker(session, number).robot for number in (0, 1)]
    pursuer, evader = (robot.truth for robot in robots)
    apart = abs(wrap_angle(evader.heading_in_world - pursuer.heading_in_world))
    distance = duel.distance
    coms = [tuple(robot.truth.position_com_in_world[:2]) for robot in robots]
    zmps = [robot.measured_zmp() for robot in robots]
    played(session, 1)
    assert len(trail.history) == 5
    assert trail.history[-1] == pytest.approx((0.5, distance, degrees(apart)))
    assert degrees(2.5) < trail.history[-1][2] < degrees(pi)
    for robot, com, zmp in zip(robots, coms, zmps, strict=True):
        trace = trail.traces[f"{robot.name}/CoM"]
        assert len(trace) == 5 and trace[-1] == com
        assert trail.traces[f"{robot.name}/ZMP"][-1] == pytest.approx(zmp)


def test_a_zmp_in_flight_is_left_out(session: LiveSession) -> None:
    nowhere: Any = lambda: (np.nan, np.nan)  # noqa: E731
    for number in (0, 1):
        walker(session, number).robot.measured_zmp = nowhere  # type: ignore[method-assign]
    played(session, 26)
    assert len(session.trail.traces["pursuer/CoM"]) == 1
    assert "pursuer/ZMP" not in session.trail.traces


def test_what_grows_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps, plots and traces: the newest stay, of each player its own."""
    trail, origin = PlotHistory(), Pose(0.0, 0.0, 0.0)
    monkeypatch.setattr(trails, "true_odometry", lambda player: origin)
    assert trail.history.maxlen == trails.MAX_SAMPLES
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    now = SimpleNamespace(
        time=0.0,
        ticks=0,
        physics=SimpleNamespace(tick=0.1),
        model=model,
        data=mujoco.MjData(model),
    )
    for number in range(130):
        players = [
            SimpleNamespace(
                name=name,
                begun=SimpleNamespace(foot=name, landing=Pose(number, 0, 0)),
                reports=(),
                snapshot=seen,
            )
            for name, seen in (("pursuer", _seen), ("evader", _seen))
        ]
        match: Any = SimpleNamespace(players=players, world=now, distance=1.0)
        now.ticks = number
        trail.before(match)
        trail.acted(match)
    for name in ("pursuer", "evader"):
        kept: list[Any] = [(name, Pose(n, 0, 0)) for n in range(30, 130)]
        assert list(trail.steps[name]) == kept
    assert len(trail.steps) == 2 and trails.MAX_STEPS == 100
    assert {t.maxlen for t in trail.traces.values()} == {trails.MAX_TRACE}
    assert len(trail.history) == 129


def _seen() -> Any:
    """Snapshot of a standing player."""
    return SimpleNamespace(
        name="any",
        place=Pose(0.0, 0.0, 0.0),
        com=(0.0, 0.0, 0.3),
        zmp=(0.0, 0.0),
    )


def test_a_step_is_kept_only_when_it_begins(session: LiveSession) -> None:
    """With its foot, and its landing where the robot stood at that tick."""
    begun: list[Any] = []

    def note(duel: Duel) -> None:
        step, odometry = duel.players[0].begun, true_odometry(duel.players[0])
        if step is not None and odometry is not None:
            begun.append((step.foot, odometry.compose(step.landing)))

    observe_ticks(session.match, note)
    played(session, 600)
    kept = list(session.trail.steps["pursuer"])
    assert [foot for foot, _ in kept] == [foot for foot, _ in begun]
    for (_, pose), (_, wanted) in zip(kept, begun, strict=True):
        np.testing.assert_allclose(pose, wanted, atol=1e-3)
    assert 2 <= len(kept) <= 5


def test_the_newest_image_of_each_camera_is_handed_out_once(
    session: LiveSession,
) -> None:
    trail = session.trail

    nothing: Any = None

    def report(kind: type[ColourImage] | type[DepthImage]) -> Any:
        values = [nothing] * len(fields(kind))
        return FrameReport(kind(*values), ())

    def act(**reports: Any) -> None:
        players = [
            SimpleNamespace(name=name, begun=None, reports=each)
            for name, each in reports.items()
        ]
        match: Any = SimpleNamespace(players=players)
        trail.acted(match)

    old, new, other, deep = (
        report(kind)
        for kind in (ColourImage, ColourImage, ColourImage, DepthImage)
    )
    act(pursuer=[old], evader=[])
    act(pursuer=[new], evader=[other, deep])
    act(pursuer=[], evader=[])
    assert session.new_frames() == {
        "pursuer, colour": new,
        "evader, colour": other,
        "evader, depth": deep,
    }
    assert session.new_frames() == {}
    act(pursuer=[old], evader=[])
    assert session.new_frames() == {"pursuer, colour": old}


def test_a_session_knows_its_theory(session: LiveSession) -> None:
    radius = 2.0 / pi
    assert session.theory is not None
    assert session.theory[0] == pytest.approx(2**0.5 * radius)
    assert session.theory[1] == pytest.approx(90.0)
    assert session.theory_radius == pytest.approx(radius)
    back = replace(SETTINGS, strategy=Evasion(angle=0.0))
    generation = session.generation
    session.reset(back)
    assert session.theory is None and session.theory_radius is None
    assert session.generation == generation + 1
    assert session.settings is back


def test_a_step_has_whole_ticks_and_at_least_one(session: LiveSession) -> None:
    for duration, ticks in ((0.1, 25), (0.001, 1), (0.0099, 2)):
        before = session.match.world.ticks
        session.step(duration)
        played(session, 0)
        assert session.match.world.ticks == before + ticks


def test_a_duel_that_is_over_stays_over(session: LiveSession) -> None:
    duel = session.match
    ticked: list[Match] = []

    def tick() -> Outcome:
        ticked.append(duel)
        return Outcome.FALL

    duel.tick = tick  # type: ignore[method-assign]
    played(session, 5)
    assert session.outcome is Outcome.FALL and len(ticked) == 1
    played(session, 5)
    assert len(ticked) == 1
    session.reset()
    assert session.outcome is None and session.error is None


def test_a_push_acts_now_on_the_robot_that_is_meant(
    session: LiveSession,
) -> None:
    played(session, 30)
    session.push("evader", 0.4, pi / 2)
    played(session, 40)
    pursuer, evader = (walker(session, number).robot for number in (0, 1))
    assert pursuer.pusher is None and evader.pusher is not None
    heading = evader.truth.heading_in_world + pi / 2
    np.testing.assert_allclose(
        evader.pusher.impulse,
        [0.4 * np.cos(heading), 0.4 * np.sin(heading)],
        atol=0.02,
    )


def test_a_change_and_a_moment_are_of_the_duel(session: LiveSession) -> None:
    changed: list[Match] = []
    session.change(changed.append)
    played(session, 10)
    assert changed == [session.match]
    moment = session.snapshot()
    data = session.match.world.data
    assert moment.time == pytest.approx(0.04)
    np.testing.assert_array_equal(moment.positions, data.xpos)
    np.testing.assert_array_equal(moment.quaternions, data.xquat)
    played(session, 25)
    assert moment.time == pytest.approx(0.04)
    assert np.abs(moment.positions - data.xpos).max() > 0.0


def test_settings_that_cannot_be_end_the_session_at_once() -> None:
    with pytest.raises(StepAsideError):
        LiveSession(replace(SETTINGS, robot="table"))


class FakeSession:
    """Keeps what panels ask for."""

    def __init__(self) -> None:
        """Begin with a duel of which only the time is known."""
        decisions = StrategyRunner(Pursuit(), GaitSettings(), 0.004)
        self.lock = RLock()
        self.scheme: Any = SimpleNamespace(decisions=decisions)
        pursuer: Any = SimulatedPlayer.__new__(SimulatedPlayer)
        pursuer.scheme = self.scheme
        self.match: Any = SimpleNamespace(
            world=SimpleNamespace(time=5.0),
            player={"pursuer": pursuer, "evader": None}.__getitem__,
        )
        self.names = ("pursuer", "evader")
        self.pushes: list[tuple[str, float, float]] = []
        self.commands: list[dict[str, Any]] = []
        self.trail: Any = SimpleNamespace(history=[])
        self.theory: tuple[float, float] | None = (0.9, 90.0)
        self.driven = ""
        self.settings = DuelSettings()
        self.outcome: Outcome | None = None
        self.slow_motion = 1.0

    def change(self, request: Any) -> None:
        """Change at once."""
        request(self.match)

    def record_command(self, **asked: Any) -> None:
        """Keep what a hand asks."""
        self.commands.append(asked)

    def push(self, robot: str, impulse: float, direction: float) -> None:
        """Note a push, or refuse it."""
        if impulse < 0.0:
            raise ConfigurationError("push impulse must be >= 0")
        self.pushes.append((robot, impulse, direction))


def panels() -> tuple[Any, Any]:
    return Gui(), FakeSession()


@pytest.mark.parametrize(
    ("where", "angle"),
    [("left", 90), ("right", -90), ("forward", 0), ("backward", 180)],
)
@pytest.mark.parametrize("who", ["pursuer", "evader"])
def test_the_push_button_pushes_who_and_where_it_says(
    where: str, angle: float, who: str
) -> None:
    gui, session = panels()
    said: list[str] = []
    add_push(gui, session, said.append)
    gui["Robot"].value, gui["Direction"].value = who, where
    gui["Impulse [N s]"].value = 0.7
    gui["Push"].press()
    assert session.pushes == [(who, 0.7, pytest.approx(radians(angle)))]
    assert said == [f"pushed the {who} {where} by 0.7 N s"]
    gui["Impulse [N s]"].value = -1.0
    gui["Push"].press()
    assert len(session.pushes) == 1 and "must be >= 0" in said[-1]


def test_a_hand_takes_the_pursuer_over_and_gives_it_back() -> None:
    gui, session = panels()
    panel = DrivePanel(gui, session)
    score = gui.texts[-1]
    panel.show(6.0, 0.4)
    assert score.content == ""
    gui["Turn"].press("right")

    def hand() -> Any:
        return session.scheme.decisions.strategy

    assert hand() == TeleoperatedPursuit(turn=-1.0, going=True)
    for label, turn in (
        ("Drive left", 1.0),
        ("Drive right", -1.0),
        ("Drive straight", 0.0),
    ):
        gui[label].press()
        assert hand() == TeleoperatedPursuit(turn, going=True)
    for label, going in (("Drive: halt", False), ("Drive: go", True)):
        gui[label].press()
        assert hand() == TeleoperatedPursuit(0.0, going)
    gui["Walk"].press("halt")
    assert hand() == TeleoperatedPursuit(0.0, going=False)
    gui["Walk"].press("go")
    assert hand() == TeleoperatedPursuit(0.0, going=True)
    gui["Turn"].press("left")
    assert hand() == TeleoperatedPursuit(1.0, going=True)
    for time, distance, closest in ((6.0, 0.9, 0.9), (7.5, 0.5, 0.5)):
        panel.show(time, distance)
        assert score.content == (
            f"round 1: the evader survived {time - 5.0:.1f} s; closest "
            f"approach {closest:.2f} m\n\n"
        )
        assert session.slow_motion == (0.25 if closest < 0.6 else 1.0)
    panel.show(8.0, 0.8)
    assert "0.50 m" in score.content and session.slow_motion == 1.0
    gui["Slow motion at the closest approach"].press(False)
    panel.show(8.1, 0.4)
    assert session.slow_motion == 1.0
    gui["Stop driving"].press()
    assert hand() == Pursuit()
    session.match.world.time = 20.0
    gui["Drive straight"].press()
    panel.show(21.0, 0.7)
    assert "survived 1.0 s; closest approach 0.70 m" in score.content
    assert session.commands[0] == {"turn": -1.0, "going": True}
    assert {"released": True} in session.commands
    panel.reset()
    panel.show(30.0, 0.1)
    assert score.content.splitlines()[2:] == [
        "| 1 | 3.1 s | **0.40 m** | released |",
        "| 2 | 1.0 s | 0.70 m | reset |",
    ]


def test_a_stick_is_held_to_any_side_and_a_fall_ends_the_round() -> None:
    gui, session = panels()
    panel = DrivePanel(gui, session)
    panel.steer(0.3, True)
    assert session.scheme.decisions.strategy == TeleoperatedPursuit(0.3, True)
    panel.show(7.0, 0.9)
    session.outcome = Outcome.FALL
    panel.show(9.0, 0.8)
    panel.show(11.0, 0.7)
    assert gui.texts[-1].content.splitlines()[2:] == [
        "| 1 | 4.0 s | **0.80 m** | fall |"
    ]


def test_plots_show_the_history_beside_theory() -> None:
    gui, session = panels()
    plots = Plots(gui)
    distance, angle = gui.plots
    assert distance.label == "Distance [m]"
    assert angle.label == "Angle between the headings [deg]"
    colours = [plot.series[1]["stroke"] for plot in gui.plots]
    assert colours == [PURSUER, ON_BOTH_FLOORS[EVADER]]
    for plot in gui.plots:  # seconds, and no date
        assert plot.options["scales"]["x"]["time"] is False
    session.trail.labels, session.trail.signals = (), []
    session.trail.history = [(0.1, 1.0, 170.0)]
    before = distance.data
    plots.show(session)
    assert distance.data is before
    session.trail.history += [(0.2, 0.9, 160.0)]
    plots.show(session)
    assert distance.removed and angle.removed
    distance, angle = gui.plots[2:]
    np.testing.assert_allclose(
        distance.data, [[0.1, 0.2], [1.0, 0.9], [0.9, 0.9]]
    )
    np.testing.assert_allclose(
        angle.data, [[0.1, 0.2], [170.0, 160.0], [90.0, 90.0]]
    )
    session.theory = None
    plots.show(session)
    for old, new, values in zip(
        (distance, angle),
        gui.plots[4:],
        ([1.0, 0.9], [170.0, 160.0]),
        strict=True,
    ):
        assert old.removed and not new.removed
        assert new.label == old.label
        assert new.options["order"] == old.options["order"]
        np.testing.assert_allclose(new.data, [[0.1, 0.2], values])
        assert len(new.series) == 2
    session.trail.history += [(0.3, np.nan, 150.0)]
    plots.show(session)
    assert len(gui.plots) == 6
    np.testing.assert_allclose(gui.plots[4].data, [[0.1, 0.2], [1.0, 0.9]])
    assert np.isfinite(gui.plots[5].data).all()
    session.theory = (0.9, 90.0)
    plots.show(session)
    assert [len(plot.data) for plot in gui.plots[6:]] == [3, 3]


@pytest.fixture
def live(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Page, Any]]:
    monkeypatch.setattr(pages, "open_server", open_fake)
    made = Page(SETTINGS, host="there", port=1234)
    server: Any = made.server
    yield made, server
    made.session.close()


def test_the_page_shows_the_duel_as_it_is(live: tuple[Page, Any]) -> None:
    page, server = live
    assert server.options["host"] == "there"
    assert server.options["port"] == 1234
    assert server.scene.up == "+z"
    session, gui = page.session, server.gui
    played(session, 250)
    page.refresh()
    data = session.match.world.data
    moved = [
        (int(name.split("/")[-1]), item)
        for name, item in server.scene.items.items()
        if name.startswith("/bodies/") and name.count("/") == 2
    ]
    assert len(moved) > 20
    for body, frame in moved:
        np.testing.assert_array_equal(frame.position, data.xpos[body])
        np.testing.assert_array_equal(frame.wxyz, data.xquat[body])
    assert "/layers/line of sight/pursuer-evader" in server.scene.items
    ring = server.scene.items["/rings/safety radius"]
    assert ring.text == "safety radius 0.80 m"
    status = gui.texts[0].content
    assert "the pursuer walks" in status and "x real time" not in status
    assert "1.0 s simulated" in status
    assert f"distance {session.match.distance:.2f} m" in status
    duel = session.match
    assert isinstance(duel, Duel)
    assert f"closest approach {duel.min_distance:.2f} m" in status
    assert "over" not in status and "stopped" not in status
    assert gui["Start"].label == "Start"
    session.outcome, session.error = Outcome.CONTACT, "a bolt"
    session.match.message = "evader and pursuer touched at 1.00 s"
    page.refresh()
    status = gui.texts[0].content
    assert session.match.message in status
    assert "**over: contact**" in status and "**stopped: a bolt**" in status


def is_locked(session: LiveSession) -> bool:
    """Return whether another thread would wait for the lock now."""
    acquired: list[bool] = []

    def try_lock() -> None:
        acquired.append(session.lock.acquire(blocking=False))
        if acquired[0]:
            session.lock.release()

    thread = Thread(target=try_lock)
    thread.start()
    thread.join()
    return not acquired[0]


def test_the_page_reads_the_physics_only_under_the_lock(
    live: tuple[Page, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Snapshots compute on the world's data: two at once end the process."""
    page, _ = live
    held: list[bool] = []

    def watched(what: Callable[[Any], Any]) -> Callable[[Any], Any]:
        def look(of: Any) -> Any:
            held.append(is_locked(page.session))
            return what(of)

        return look

    played(page.session, 60)
    monkeypatch.setattr(
        SimulatedPlayer, "snapshot", watched(SimulatedPlayer.snapshot)
    )
    distance: Any = Duel.distance
    seen = property(watched(distance.fget))
    monkeypatch.setattr(Duel, "distance", seen)
    page.refresh()
    page.plots.show(page.session)
    assert len(held) > 2 and all(held)


def test_the_page_draws_a_new_duel_anew(live: tuple[Page, Any]) -> None:
    page, server = live
    page.refresh()
    before = server.scene.items["/layers/line of sight/pursuer-evader"]
    page.refresh()
    assert server.scene.items["/layers/line of sight/pursuer-evader"] is before
    page.session.reset()
    page.refresh()
    assert (
        server.scene.items["/layers/line of sight/pursuer-evader"]
        is not before
    )


def test_buttons_start_step_and_set_the_speed(
    live: tuple[Page, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    page, server = live
    session, gui = page.session, server.gui
    gui["Duel"].press("step")
    played(session, 0)
    assert session.match.world.ticks == 25
    monkeypatch.setattr(session.match, "tick", lambda: None)
    gui["Start"].press()
    assert session.running
    page.refresh()
    assert gui["Start"].label == "Pause"
    asked: list[float] = []
    session.step = asked.append  # type: ignore
    gui["Step 0.1 s"].press()
    assert asked == []
    gui["Play or pause"].press()
    assert not session.running
    gui["Play or pause"].press()
    gui["Start"].press()
    assert not session.running
    for value, speed in (("0.25", 0.25), ("4", 4.0)):
        gui["Speed"].press(value)
        assert session.speed == speed
    gui["Speed"].press("as fast as possible")
    assert session.speed == inf
    gui["Footsteps"].press(False)
    assert page.layers.shown["footsteps"] is False
    assert page.layers.shown["CoM trace"] is True


def test_controls_begin_with_the_duels_own_values(
    live: tuple[Page, Any],
) -> None:
    gui = live[1].gui
    expected = {
        "Evasion angle [deg]": 90.0,
        "Law": "proportional (4)",
        "Seed": 1,
        "Distance [m]": 1.0,
        "Pursuer's heading offset [deg]": round(degrees(0.3), 1),
        "Evader's heading offset [deg]": round(degrees(-0.2), 1),
        "Template speed [m/s]": 0.1,
        "Gain k [1/s]": 0.2,
        "Sensing": "ideal",
        "Body": "ideal",
        "Speed": "1",
    }
    found = {label: gui[label].value for label in expected}
    assert found == {k: pytest.approx(v) for k, v in expected.items()}


def test_a_strategy_reaches_the_evader_while_it_evades(
    live: tuple[Page, Any],
) -> None:
    page, server = live
    session, gui = page.session, server.gui
    decisions = walker(session, 1).scheme.decisions
    decisions.memory = EvasionMemory(True, -1)
    gui["Evasion angle [deg]"].press(60.0)
    gui["Law"].press("saturated (6)")
    played(session, 0)
    strategy: Any = decisions.strategy
    assert strategy.angle == pytest.approx(radians(60.0))
    assert strategy.saturated
    assert decisions.memory == EvasionMemory(True, -1)
    assert settings_of(session).strategy.angle == pytest.approx(radians(60.0))
    viewer = Client(1)
    server.welcome(viewer)
    before = len(gui.texts)
    gui["Evasion angle [deg]"].press(1e6)
    (message,) = viewer.notices
    assert "angle" in message.body and not message.removed
    assert decisions.strategy is strategy
    gui["Evasion angle [deg]"].press(80.0)
    assert message.removed and len(viewer.notices) == 1
    assert len(gui.texts) == before
    assert session.theory is not None
    assert session.theory[1] != pytest.approx(90.0, abs=5.0)


def test_a_message_goes_by_itself_and_moves_nothing(
    live: tuple[Page, Any],
) -> None:
    """One at a time, to all who look; the panels keep what they have."""
    page, server = live
    viewers = [Client(1), Client(2)]
    for viewer in viewers:
        server.welcome(viewer)
    parts = len(server.gui.texts), list(server.gui.items)
    server.gui["Push"].press()
    server.gui["Push"].press()
    for viewer in viewers:
        first, last = viewer.notices
        assert first.removed and not last.removed
        assert last.body == "pushed the pursuer left by 0.5 N s"
        assert 0.0 < last.seconds <= 30.0
    assert (len(server.gui.texts), list(server.gui.items)) == parts


def test_the_page_says_that_a_hand_drives_and_no_theory_then(
    live: tuple[Page, Any],
) -> None:
    page, server = live
    session, gui = page.session, server.gui
    played(session, 30)
    release = gui["Stop driving"]

    def said() -> str:
        page.refresh()
        return "\n".join(text.content for text in gui.texts)

    assert release.disabled and "Not driven" in said()
    assert session.theory is not None
    gui["Turn"].press("left")
    assert not release.disabled
    assert "**Driven by hand**: the pursuer walks to the left" in said()
    status = gui.texts[0].content
    assert "**driven by hand**" in status
    assert "Theory:" not in status and "m apart" not in status
    assert session.theory is None and session.theory_radius is None
    gui["Walk"].press("halt")
    assert "the pursuer halts" in said()
    release.press()
    assert release.disabled and "Driven by hand" not in said()
    assert session.theory is not None
    gui["Drive left"].press()
    gui["Duel"].press("reset")
    assert release.disabled and session.theory is not None


def test_the_pace_is_shown_only_while_time_passes(
    live: tuple[Page, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    page, server = live
    page.session.real_time_factor = 0.0
    page.refresh()
    assert "real time" not in server.gui.texts[0].content
    page.session.real_time_factor = 1.04
    page.refresh()
    assert "real time" not in server.gui.texts[0].content
    monkeypatch.setattr(page.session.match, "tick", lambda: None)
    page.session.running = True
    page.refresh()
    page.session.running = False
    assert "1.0 x real time" in server.gui.texts[0].content


def test_a_reset_takes_what_the_controls_say(live: tuple[Page, Any]) -> None:
    page, server = live
    session, gui = page.session, server.gui
    for label, value in (
        ("Seed", 9),
        ("Distance [m]", 1.4),
        ("Pursuer's heading offset [deg]", 45.0),
        ("Evader's heading offset [deg]", -10.0),
        ("Template speed [m/s]", 0.08),
        ("Gain k [1/s]", 0.25),
        ("Body", "hardware"),
    ):
        gui[label].value = value
    gui["Drive straight"].press()
    gui["Duel"].press("reset")
    settings = settings_of(session)
    assert settings.seed == 9
    start = settings.start
    assert start.distance == 1.4
    assert start.pursuer_offset == pytest.approx(radians(45.0))
    assert start.evader_offset == pytest.approx(radians(-10.0))
    assert settings.gait.speed == 0.08 and settings.gait.gain == 0.25
    assert settings.body == BODIES["hardware"]
    assert settings.control == STABILISED
    decisions = walker(session, 0).scheme.decisions
    assert decisions.strategy == Pursuit()
    assert not session.driven
    gui["Body"].value = "ideal"
    gui["Duel"].press("reset")
    assert settings_of(session).control == OPEN_LOOP
    viewer = Client(1)
    server.welcome(viewer)
    gui["Distance [m]"].value = 0.1
    gui["Duel"].press("reset")
    assert "distance must lie in" in viewer.notices[-1].body
    assert settings_of(session).start.distance == 1.4
