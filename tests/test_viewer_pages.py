"""The live page and the replay behind a page that is none."""

from collections.abc import Iterator
from dataclasses import replace
from math import degrees, inf, pi, radians
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fake_page import Gui, Server
from stepaside.control.balance.settings import OPEN_LOOP, STABILISED
from stepaside.errors import ConfigurationError, StepAsideError
from stepaside.games.duel import Duel, Outcome, run_duel
from stepaside.games.settings import (
    DuelSettings,
    StartSettings,
    StrategySettings,
)
from stepaside.games.summary import summarise
from stepaside.poses import Array, wrap_angle
from stepaside.report.replay import Run, Stage
from stepaside.report.style import EVADER, PURSUER
from stepaside.report.viewer import replaying
from stepaside.report.viewer import session as session_module
from stepaside.report.viewer.drive_panel import DrivePanel
from stepaside.report.viewer.page import Page
from stepaside.report.viewer.plots import Plots
from stepaside.report.viewer.push_panel import add_push
from stepaside.report.viewer.replaying import ReplayPage
from stepaside.report.viewer.session import Session
from stepaside.strategies.driving import Driven
from stepaside.strategies.roles import Pursuit
from stepaside.world.body_settings import BODIES

START = StartSettings(distance=1.0, pursuer_offset=0.3, evader_offset=-0.2)
SETTINGS = DuelSettings(start=START)


@pytest.fixture
def session() -> Iterator[Session]:
    made = Session(SETTINGS)
    yield made
    made.close()


def played(session: Session, ticks: int) -> None:
    """Let the loop play, and wait until it has."""
    session._in_loop(lambda: session._advance(ticks))


def test_a_session_notes_every_tenth_of_a_second(session: Session) -> None:
    played(session, 124)
    duel = session.duel
    times = [row[0] for row in session.history]
    np.testing.assert_allclose(times, [0.1, 0.2, 0.3, 0.4])
    played(session, 1)
    time, distance, angle = session.history[-1]
    pursuer, evader = (robot.truth for robot in duel.robots)
    assert time == pytest.approx(0.5) == duel.world.time
    assert distance == duel.distance
    apart = abs(wrap_angle(evader.heading - pursuer.heading))
    assert angle == pytest.approx(degrees(apart))
    assert degrees(2.5) < angle < degrees(pi)
    for robot in duel.robots:
        com = session.traces[f"{robot.name}/CoM"]
        assert len(com) == 5
        assert com[-1] == tuple(robot.truth.com[:2])
        zmp = session.traces[f"{robot.name}/ZMP"]
        assert zmp[-1] == pytest.approx(robot.measured_zmp())


def test_a_zmp_in_flight_is_left_out(session: Session) -> None:
    for robot in session.duel.robots:
        robot.measured_zmp = lambda: (np.nan, np.nan)  # type: ignore
    played(session, 25)
    assert len(session.traces["pursuer/CoM"]) == 1
    assert len(session.traces["pursuer/ZMP"]) == 0


def test_what_grows_is_cut(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    for scheme in session.duel.schemes:
        for name in ("walked", "landings", "planning_times"):
            getattr(scheme, name)[:] = range(130)
        scheme.velocity_jumps[:] = range(130)
    session._note(session.duel)
    for scheme in session.duel.schemes:
        for name in (
            *("walked", "landings"),
            *("planning_times", "velocity_jumps"),
        ):
            assert getattr(scheme, name) == list(range(30, 130))
    assert session.history.maxlen == session_module.HISTORY
    assert session.traces["evader/ZMP"].maxlen == session_module.TRACE


def test_a_session_knows_its_theory(session: Session) -> None:
    radius = 2.0 / pi
    assert session.theory is not None
    assert session.theory[0] == pytest.approx(2**0.5 * radius)
    assert session.theory[1] == pytest.approx(90.0)
    assert session.theory_radius == pytest.approx(radius)
    back = replace(SETTINGS, strategy=StrategySettings(angle=0.0))
    generation = session.generation
    session.reset(back)
    assert session.theory is None and session.theory_radius is None
    assert session.generation == generation + 1
    assert session.settings is back


def test_a_step_has_whole_ticks_and_at_least_one(session: Session) -> None:
    for duration, ticks in ((0.1, 25), (0.001, 1), (0.0099, 2)):
        before = session.duel.world.ticks
        session.step(duration)
        played(session, 0)
        assert session.duel.world.ticks == before + ticks


def test_a_duel_that_is_over_stays_over(session: Session) -> None:
    duel = session.duel
    duel.tick = lambda: Outcome.FALL  # type: ignore[method-assign]
    played(session, 5)
    assert session.outcome is Outcome.FALL
    told: list[Duel] = []
    session.on_tick = told.append
    played(session, 5)
    assert told == []
    session.reset()
    assert session.outcome is None and session.error is None


def test_a_push_acts_now_on_the_robot_that_is_meant(session: Session) -> None:
    played(session, 30)
    session.push(1, 0.4, pi / 2)
    played(session, 40)
    pursuer, evader = session.duel.robots
    assert pursuer.pusher is None and evader.pusher is not None
    heading = evader.truth.heading + pi / 2
    np.testing.assert_allclose(
        evader.pusher.impulse,
        [0.4 * np.cos(heading), 0.4 * np.sin(heading)],
        atol=0.02,
    )


def test_a_change_and_a_moment_are_of_the_duel(session: Session) -> None:
    changed: list[Duel] = []
    session.change(changed.append)
    played(session, 10)
    assert changed == [session.duel]
    moment = session.moment()
    data = session.duel.world.data
    assert moment.time == pytest.approx(0.04)
    np.testing.assert_array_equal(moment.positions, data.xpos)
    np.testing.assert_array_equal(moment.quaternions, data.xquat)
    played(session, 25)
    assert moment.time == pytest.approx(0.04)
    assert np.abs(moment.positions - data.xpos).max() > 0.0


def test_settings_that_cannot_be_end_the_session_at_once() -> None:
    with pytest.raises(StepAsideError):
        Session(replace(SETTINGS, robot="table"))


class FakeSession:
    """Keeps what panels ask for."""

    def __init__(self) -> None:
        """Begin with a duel of which only the time is known."""
        self.scheme = SimpleNamespace(role=None)
        self.duel = SimpleNamespace(
            world=SimpleNamespace(time=5.0), schemes=[self.scheme, None]
        )
        self.pushes: list[tuple[int, float, float]] = []
        self.history: list[tuple[float, float, float]] = []
        self.theory: tuple[float, float] | None = (0.9, 90.0)

    def change(self, request: Any) -> None:
        """Change at once."""
        request(self.duel)

    def push(self, robot: int, impulse: float, direction: float) -> None:
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
@pytest.mark.parametrize(("who", "number"), [("pursuer", 0), ("evader", 1)])
def test_the_push_button_pushes_who_and_where_it_says(
    where: str, angle: float, who: str, number: int
) -> None:
    gui, session = panels()
    said: list[str] = []
    add_push(gui, session, said.append)
    gui["Robot"].value, gui["To"].value = who, where
    gui["Impulse [N s]"].value = 0.7
    gui["Push"].press()
    assert session.pushes == [(number, 0.7, pytest.approx(radians(angle)))]
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
    hand = session.scheme.role
    assert isinstance(hand, Driven) and hand.going and hand.turn == -1.0
    for label, turn in (
        ("Drive left", 1.0),
        ("Drive right", -1.0),
        ("Drive straight", 0.0),
    ):
        gui[label].press()
        assert hand.turn == turn
    for label, going in (("Drive: halt", False), ("Drive: go", True)):
        gui[label].press()
        assert hand.going is going and hand.turn == 0.0
    gui["Walk"].press("stop")
    assert hand.going is False
    gui["Walk"].press("go")
    assert hand.going is True
    gui["Turn"].press("left")
    assert hand.turn == 1.0 and session.scheme.role is hand
    for time, distance, closest in ((6.0, 0.9, 0.9), (7.5, 0.5, 0.5)):
        panel.show(time, distance)
        assert score.content == (
            f"the evader survived {time - 5.0:.1f} s; closest approach "
            f"{closest:.2f} m"
        )
    panel.show(8.0, 0.8)
    assert "0.50 m" in score.content
    gui["Let it pursue by itself"].press()
    assert isinstance(session.scheme.role, Pursuit)
    session.duel.world.time = 20.0
    gui["Drive straight"].press()
    panel.show(21.0, 0.7)
    assert "survived 1.0 s; closest approach 0.70 m" in score.content
    panel.forget()
    assert score.content == ""
    panel.show(30.0, 0.1)
    assert score.content == ""


def test_plots_show_the_history_beside_theory() -> None:
    gui, session = panels()
    plots = Plots(gui)
    distance, angle = gui.plots
    assert distance.label == "Distance [m]"
    assert angle.label == "Angle between the headings [deg]"
    colours = [plot.series[1]["stroke"] for plot in gui.plots]
    assert colours == [PURSUER, EVADER]
    session.history = [(0.1, 1.0, 170.0)]
    before = distance.data
    plots.show(session)
    assert distance.data is before
    session.history += [(0.2, 0.9, 160.0)]
    plots.show(session)
    np.testing.assert_allclose(
        distance.data, [[0.1, 0.2], [1.0, 0.9], [0.9, 0.9]]
    )
    np.testing.assert_allclose(
        angle.data, [[0.1, 0.2], [170.0, 160.0], [90.0, 90.0]]
    )
    session.theory = None
    plots.show(session)
    assert np.isnan(distance.data[2]).all()


@pytest.fixture
def live(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Page, Any]]:
    monkeypatch.setattr("viser.ViserServer", Server)
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
    page._refresh()
    data = session.duel.world.data
    moved = [
        (int(name.split("/")[-1]), item)
        for name, item in server.scene.items.items()
        if name.startswith("/bodies/") and name.count("/") == 2
    ]
    assert len(moved) > 20
    for body, frame in moved:
        np.testing.assert_array_equal(frame.position, data.xpos[body])
        np.testing.assert_array_equal(frame.wxyz, data.xquat[body])
    assert "/layers/line of sight/both" in server.scene.items
    status = gui.texts[0].content
    assert "the pursuer comes" in status
    assert "1.0 s simulated" in status
    assert f"distance {session.duel.distance:.2f} m" in status
    assert f"closest {session.duel.min_distance:.2f} m" in status
    assert "over" not in status and "stopped" not in status
    assert gui["Start"].label == "Start"
    session.outcome, session.error = Outcome.CONTACT, "a bolt"
    page._refresh()
    status = gui.texts[0].content
    assert "**over: contact**" in status and "**stopped: a bolt**" in status


def test_the_page_draws_a_new_duel_anew(live: tuple[Page, Any]) -> None:
    page, server = live
    page._refresh()
    before = server.scene.items["/layers/line of sight/both"]
    page._refresh()
    assert server.scene.items["/layers/line of sight/both"] is before
    page.session.reset()
    page._refresh()
    assert server.scene.items["/layers/line of sight/both"] is not before


def test_buttons_start_step_and_set_the_speed(
    live: tuple[Page, Any],
) -> None:
    page, server = live
    session, gui = page.session, server.gui
    gui["Step 0.1 s"].press()
    played(session, 0)
    assert session.duel.world.ticks == 25
    session._advance = lambda ticks: None  # type: ignore[method-assign]
    gui["Start"].press()
    assert session.running
    page._refresh()
    assert gui["Start"].label == "Pause"
    asked: list[float] = []
    session.step = asked.append  # type: ignore
    gui["Step 0.1 s"].press()
    assert asked == []
    gui["Start"].press()
    assert not session.running
    for value, speed in (("0.25", 0.25), ("4", 4.0)):
        gui["Speed"].press(value)
        assert session.speed == speed
    gui["Speed"].press("as fast as it goes")
    assert session.speed == inf
    gui["Dark"].press(True)
    assert gui.themes == [False, True]
    gui["Footsteps"].press(False)
    assert page._layers.shown["footsteps"] is False
    assert page._layers.shown["CoM trace"] is True


def test_controls_begin_with_the_duels_own_values(
    live: tuple[Page, Any],
) -> None:
    gui = live[1].gui
    expected = {
        "Angle [deg]": 90.0,
        "Law": "proportional (4)",
        "Seed": 1,
        "Distance [m]": 1.0,
        "Pursuer turned by [deg]": round(degrees(0.3), 1),
        "Evader turned by [deg]": round(degrees(-0.2), 1),
        "Driving speed [m/s]": 0.1,
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
    old: Any = session.duel.schemes[1].role
    old.evading = True
    gui["Angle [deg]"].press(60.0)
    gui["Law"].press("saturated (6)")
    played(session, 0)
    role: Any = session.duel.schemes[1].role
    assert role.angle == pytest.approx(radians(60.0)) and role.saturated
    assert role.evading is True and role is not old
    assert session.settings.strategy.angle == pytest.approx(radians(60.0))
    gui["Angle [deg]"].press(1e6)
    message = gui.texts[1]
    assert message.visible and "angle" in message.content
    assert session.duel.schemes[1].role is role
    gui["Angle [deg]"].press(80.0)
    assert not message.visible and message.content == ""


def test_a_reset_takes_what_the_controls_say(live: tuple[Page, Any]) -> None:
    page, server = live
    session, gui = page.session, server.gui
    for label, value in (
        ("Seed", 9),
        ("Distance [m]", 1.4),
        ("Pursuer turned by [deg]", 45.0),
        ("Evader turned by [deg]", -10.0),
        ("Driving speed [m/s]", 0.08),
        ("Gain k [1/s]", 0.25),
        ("Body", "hardware"),
    ):
        gui[label].value = value
    gui["Drive straight"].press()
    gui["Reset"].press()
    settings = session.settings
    assert settings.seed == 9
    start = settings.start
    assert start.distance == 1.4
    assert start.pursuer_offset == pytest.approx(radians(45.0))
    assert start.evader_offset == pytest.approx(radians(-10.0))
    assert settings.gait.speed == 0.08 and settings.gait.gain == 0.25
    assert settings.body == BODIES["hardware"]
    assert settings.control == STABILISED
    assert isinstance(session.duel.schemes[0].role, Pursuit)
    assert page._drive._hand is None
    gui["Body"].value = "ideal"
    gui["Reset"].press()
    assert session.settings.control == OPEN_LOOP
    gui["Distance [m]"].value = 0.1
    gui["Reset"].press()
    message = gui.texts[1]
    assert message.visible and "distance must lie in" in message.content
    assert session.settings.start.distance == 1.4


@pytest.fixture(scope="module")
def run() -> Run:
    """A short run whose robots then are moved by hand."""
    result = run_duel(replace(SETTINGS, duration=2.0))
    arrays = {name: values.copy() for name, values in result.arrays.items()}
    times: Array = 0.02 * np.arange(len(arrays["times_s"]), dtype=float)
    arrays["times_s"] = times
    for name, side in (("pursuer", 1.0), ("evader", -1.0)):
        way = side * np.column_stack([times, -0.5 * times])
        arrays[f"{name}_torso"][:, :2] += way
        arrays[f"{name}_com"][:, :2] += way
        arrays[f"{name}_qpos"][:, :2] += way.astype(np.float32)
    summary = summarise(result) | {
        "triggered_at_s": 0.5,
        "converged_at_s": 1.6,
    }
    return Run("short", result.settings, summary, arrays)


@pytest.fixture
def replay(monkeypatch: pytest.MonkeyPatch, run: Run) -> tuple[Any, Any]:
    monkeypatch.setattr("viser.ViserServer", Server)
    made = ReplayPage(run, port=99)
    return made, made.server


@pytest.mark.parametrize(
    ("time", "index"),
    [(0.0, 0), (0.5, 25), (0.51, 26), (1.7, 85), (2.0, 100), (9.0, 100)],
)
def test_a_replay_shows_the_sample_of_its_time(
    replay: tuple[Any, Any], run: Run, time: float, index: int
) -> None:
    """Bodies, lines and words are those of that moment."""
    page, server = replay
    page._show(time)
    stage = Stage(run)
    stage.put(index)
    frames = [
        (int(name.split("/")[-1]), item)
        for name, item in server.scene.items.items()
        if name.startswith("/bodies/") and name.count("/") == 2
    ]
    assert len(frames) > 20
    for body, frame in frames:
        np.testing.assert_array_equal(frame.position, stage.data.xpos[body])
        np.testing.assert_array_equal(frame.wxyz, stage.data.xquat[body])
    status = server.gui.texts[0].content
    assert status == (
        f"**short**: {run.words(index)}\n\n{run.times[index]:.2f} s, "
        f"distance {run.distance[index]:.2f} m, between the headings "
        f"{run.orientation[index]:.0f}°"
    )
    items = server.scene.items
    torsos = [run.arrays[f"{n}_torso"] for n in ("pursuer", "evader")]
    places = [torso[index, :2] for torso in torsos]
    sight = items["/layers/line of sight/both"].points[0]
    np.testing.assert_allclose(sight[:, :2], places, atol=1e-6)
    np.testing.assert_allclose(sight[:, 2], 0.25)
    safety = items["/layers/safety area/evader"].points[..., :2]
    away = np.hypot(*(safety[:, 0] - places[1]).T)
    np.testing.assert_allclose(away, 0.8, atol=1e-5)
    circle = items["/layers/circle of theory/both"].points[..., :2]
    assert run.circle is not None
    middle = circle[:, 0].mean(axis=0)
    np.testing.assert_allclose(middle, run.circle[:2], atol=1e-5)
    for name in ("pursuer", "evader"):
        way = run.arrays[f"{name}_com"][: index + 1 : 5, :2]
        drawn = items.get(f"/layers/CoM trace/{name}")
        if len(way) < 2:
            assert drawn is None
            continue
        np.testing.assert_allclose(drawn.points[0, 0, :2], way[0], atol=1e-5)
        np.testing.assert_allclose(drawn.points[-1, 1, :2], way[-1], atol=1e-5)
        assert len(drawn.points) == len(way) - 1


def test_a_replay_has_its_slider_plots_and_layers(
    replay: tuple[Any, Any], run: Run
) -> None:
    page, server = replay
    assert server.options == {
        "host": "127.0.0.1",
        "port": 99,
        "label": "stepaside",
        "verbose": False,
    }
    slider = server.gui["Time [s]"]
    assert slider.min == 0.0 and slider.max == run.times[-1]
    assert slider.value == 0.0 and page.slider is slider
    distance, angle = server.gui.plots
    assert run.theory is not None
    for plot, values, level in (
        (distance, run.distance, run.theory[1]),
        (angle, run.orientation, run.theory[2]),
    ):
        np.testing.assert_allclose(plot.data[0], run.times)
        np.testing.assert_allclose(plot.data[1], values)
        np.testing.assert_allclose(plot.data[2], level)
    place = run.arrays["evader_torso"][0]
    camera = server.initial_camera
    np.testing.assert_allclose(
        camera.position, [place[0] - 1.5, place[1] - 1.6, 1.3]
    )
    np.testing.assert_allclose(camera.look_at, [place[0], place[1], 0.2])
    server.gui["Safety area"].press(False)
    page._show(1.0)
    assert "/layers/safety area/evader" not in server.scene.items
    assert "/layers/line of sight/both" in server.scene.items
    server.gui["Play"].press()
    page._show(1.0)
    assert server.gui["Play"].label == "Pause"
    server.gui["Play"].press()
    page._show(1.0)
    assert server.gui["Play"].label == "Play"


def test_playing_moves_the_slider_by_time_and_speed_to_the_end(
    replay: tuple[Any, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    page, server = replay
    clock = iter(0.25 * np.arange(100.0))
    monkeypatch.setattr(replaying, "perf_counter", lambda: next(clock))
    monkeypatch.setattr(replaying, "sleep", lambda seconds: None)
    shown: list[float] = []

    def show(time: float) -> None:
        shown.append(time)
        if len(shown) == 6:
            page._closing.set()

    page._show = show
    server.gui["Speed"].value = 2.0
    server.gui["Play"].press()
    # The clock is looked at twice in a round: half a second passes.
    page._loop()
    np.testing.assert_allclose(shown, [0.5, 1.5, 2.0, 2.0, 2.0, 2.0])
    assert page._playing is False


def test_a_replay_that_cannot_be_shown_goes_on(
    replay: tuple[Any, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    page, server = replay
    monkeypatch.setattr(replaying, "sleep", lambda seconds: None)
    tried: list[float] = []

    def fail(time: float) -> None:
        tried.append(time)
        if len(tried) == 2:
            page._closing.set()
        raise RuntimeError("no light")

    page._show = fail
    page.start()
    page._thread.join(timeout=60.0)
    assert len(tried) == 2
    page._closing.clear()
    page.close()
    assert server.stopped and page._closing.is_set()
