"""The live page, by viser's handles on a real server; no browser.

What the server sends to browsers is stored in ``tests/data/pages.json``.
"""

import os
import re
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from dataclasses import replace
from math import pi
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from flows.calls import games_of_pages, load_run, open_page
from flows.running import until
from stepaside.cli.main import main
from stored_values import compare_stored, content_of

viser = pytest.importorskip("viser")
live_page: Any = pytest.importorskip("stepaside.report.viewer.live_page")
pytestmark = pytest.mark.usefixtures("blank_figures")

LEFT_OUT = (
    "Theme",
    "SetSceneNodeVis",
    "BackgroundImage",
    "GuiSetPanel",
    "GuiPanel",
)
MANY = ("Mesh", "Frame", "SetPosition", "SetOrientation")
GAMES = games_of_pages()
del GAMES["duel"]  # like that of the start
QUEUE = viser.infra.WebsockServer.queue_message


class Viewer:
    """A browser that sees a page: its camera, and what it is told."""

    client_id = 5

    def __init__(self) -> None:
        self.camera = SimpleNamespace(
            position=np.zeros(3), look_at=np.zeros(3), aspect=1.5, fov=0.8
        )
        self.notices: list[str] = []
        self.atomic = nullcontext

    def add_notification(self, title: str, text: str, **_: Any) -> None:
        """Keep a notice."""
        self.notices.append(f"{title}: {text}")


class LivePage:
    """A page that is served, paused, and what a viewer does on it."""

    def __init__(self, settings: Any, messages: list[Any]) -> None:
        self._messages = messages
        self.page = open_page(settings)
        self.session, self.gui = self.page.session, self.page.server.gui
        self.viewer = Viewer()
        self.page.server.get_clients = lambda: {5: self.viewer}

    def control(self, name: str) -> Any:
        """Control with a label, or of the setting with a path."""
        controls = self.gui._gui_input_handle_from_uuid.values()
        (found,) = [
            each
            for each in controls
            if name in (each.label, str(each.hint).partition(": ")[0])
        ]
        return found

    def press(self, name: str, value: Any = True) -> None:
        """Press a button, or choose or enter a value."""
        self.control(name).value = value
        self.session.call(lambda: None)

    def play(self, duration: float) -> None:
        """Let simulated time pass, step by step, and show what comes."""
        for _ in range(round(10.0 * duration)):
            self.press("Game", "step")
        self.page.refresh()

    def trigger(self, key: str) -> None:
        """Press a key, by its name or what it does."""
        commands = self.gui._command_handle_from_uuid.values()
        for each in commands:
            if key in (each.label, each.hotkey):
                for call in each._impl.trigger_cb:
                    call(SimpleNamespace(client=self.viewer))
        self.session.call(lambda: None)

    def sent(self) -> list[Any]:
        """Messages to browsers since the last call."""
        found, self._messages[:] = self._messages[:], []
        return found

    def save(self) -> Any:
        """Save the game so far, and read it."""
        before = set(Path.cwd().glob("runs/*"))
        self.press("Game", "save")
        (made,) = set(Path.cwd().glob("runs/*")) - before
        return load_run(made)

    def show_plots(self) -> None:
        """Show plots and camera images, as a page does now and then."""
        self.page._plots.show(self.session)
        self.page._show_cameras()


@pytest.fixture
def opened(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Iterator[Callable[[Any], LivePage]]:
    """Function that opens the page of a game."""
    messages: list[Any] = []

    def record(server: Any, message: Any) -> None:
        messages.append(message)
        QUEUE(server, message)

    monkeypatch.setattr(viser.infra.WebsockServer, "queue_message", record)
    monkeypatch.chdir(tmp_path)
    made: list[LivePage] = []

    def opens(settings: Any) -> LivePage:
        made.append(LivePage(settings, messages))
        return made[-1]

    yield opens
    for each in made:
        each.page.start()
        each.page.close()


def told(messages: list[Any], *, brief: bool = True) -> Iterator[Any]:
    """Yield what a page is told, by kind: texts, and sums of all numbers."""
    kinds: dict[str, list[Any]] = {}
    for message in messages:
        kind = type(message).__name__.removesuffix("Message")
        if not kind.startswith(LEFT_OUT):
            kinds.setdefault(kind, []).append(message)
    for kind, found in kinds.items():
        values = [*content_of(found)]
        texts = " ".join(x for x in values if isinstance(x, str))
        texts = re.sub(r"[0-9a-f]{8}-[-0-9a-f]+", "", texts)
        numbers = np.array([x for x in values if isinstance(x, float)])
        phase = np.arange(len(numbers))
        short = brief or kind in MANY
        yield f"{kind} {len(found)} {len(texts) if short else texts}"
        for weights in (np.cos(phase), np.sin(phase)):
            yield float(numbers @ weights)


@pytest.mark.parametrize("kind", GAMES)
def test_a_game_is_shown_pushed_driven_saved_and_reset(
    kind: str, opened: Callable[[Any], LivePage]
) -> None:
    page, whole = opened(GAMES[kind]), kind == "as started"
    session = page.session
    shown = [*told(page.sent(), brief=not whole)]
    page.play(1.0)
    page.show_plots()
    shown += [*told(page.sent(), brief=False)]

    robot = [p.name for p in session.played.players if p.body == "robot"][-1]
    page.press("Robot", robot)
    page.press("Impulse [N s]", 0.4)
    page.press("Direction", "right")
    page.press("Push")
    page.play(0.5)
    driver = page.control("Driven robot").value
    page.press("Turn", "left")
    page.play(3.0 if whole else 0.5)
    page.press("Walk", "halt")
    page.play(1.5 if whole else 0.2)
    page.show_plots()
    shown += [*told(page.sent(), brief=False)]
    page.press("Stop driving")

    run = page.save()
    shown += page.viewer.notices
    for key in "1234":
        page.trigger(key)
        page.page.refresh()
        camera = page.viewer.camera
        shown += map(float, [*camera.position, *camera.look_at])
    assert run.settings.seed == GAMES[kind].seed
    (push,) = run.tracks[robot].pushes
    row = int(np.searchsorted(run.times, push[0]))
    heading = run.tracks[robot].torso[row, 2] - 0.5 * pi
    right = np.array([np.cos(heading), np.sin(heading)])
    np.testing.assert_allclose(push[-2:], 0.4 * right, atol=0.02)
    others = [t.pushes for n, t in run.tracks.items() if n != robot]
    assert all(each is None or len(each) == 0 for each in others)
    if whole:
        path = run.tracks[driver].torso
        assert path[-1, 2] > path[row, 2] + 0.1
        assert np.ptp(path[-10:, :2], axis=0).max() < 0.01

    page.press("seed", 9)
    page.press("Game", "reset")
    assert session.world.time == 0.0 and not session.driven
    assert session.settings == replace(GAMES[kind], seed=9)
    page.page.refresh()
    shown += told(page.sent())
    compare_stored("pages.json", kind, shown, 1e-4)


def test_a_preset_begins_with_its_settings_in_the_controls(
    opened: Callable[[Any], LivePage],
) -> None:
    page = opened(GAMES["as started"])
    presets = page.control("Preset")
    for name in presets.options[::-1]:
        page.press("Preset", name)
        page.page.refresh()
        settings = page.session.settings
        assert settings == {**GAMES, "duel": settings}[name]
        (evader,) = [p for p in settings.players if p.name == "evader"]
        assert page.control("players.1.strategy").value == evader.strategy
        distance = settings.start.distance
        shown = page.control("start.distance").value
        assert str(shown) == str("" if distance is None else distance)
        assert page.session.world.time == 0.0
        page.press("Game", "reset")
        assert page.session.settings == settings


def test_a_page_starts_and_pauses_and_steps_only_a_paused_game(
    opened: Callable[[Any], LivePage],
) -> None:
    page = opened(GAMES["walk"])
    session = page.session
    page.press("Speed", "as fast as possible")
    page.press("Start")
    until(lambda: session.world.time > 0.5)
    page.page.refresh()
    page.press("Pause")
    page.page.refresh()
    time = session.world.time
    page.press("Game", "step")
    assert session.world.time == pytest.approx(time + 0.1, abs=0.01)
    page.press("Start")
    page.trigger("space")
    assert not session.running


def test_keys_do_what_buttons_do(opened: Callable[[Any], LivePage]) -> None:
    page = opened(GAMES["as started"])
    session = page.session
    for key in "NNN":
        page.trigger(key)
    assert session.world.time == pytest.approx(0.3, abs=0.02)
    for key, words in {
        "arrowleft": "walks to the left",
        "arrowright": "walks to the right",
        "arrowup": "walks straight ahead",
        "H": "halts",
        "G": "walks straight ahead",
    }.items():
        page.sent()
        page.trigger(key)
        (text,) = [m.updates for m in page.sent() if hasattr(m, "updates")][:1]
        assert words in str(text), key
    page.trigger("S")
    assert "stepaside show runs/live-seed7" in page.viewer.notices[-1]
    page.trigger("R")
    assert session.world.time == 0.0 and not session.driven


@pytest.mark.parametrize("runs", [True, False])
@pytest.mark.parametrize("opens", [True, False])
def test_the_command_serves_a_page_until_it_is_interrupted(
    opens: bool, runs: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[str] = []
    began: list[bool] = []

    def interrupted(_: float) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("webbrowser.open", shown.append)
    monkeypatch.setattr("stepaside.cli.view.sleep", interrupted)
    start = live_page.Page.start

    def note(page: Any) -> None:
        began.append(page.session.running)
        start(page)

    monkeypatch.setattr(live_page.Page, "start", note)
    file = tmp_path / "walk.toml"
    file.write_text('game = "walk"\n')
    port = 8200 + os.getpid() % 1000
    words = ["view", str(file), "--port", str(port)] + ["--no-open"][opens:]
    words += ["--no-run"][runs:]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 0, done.output
    (address,) = re.findall(r"serving at (\S+); press", done.output)
    assert address.startswith("http://127.0.0.1:")
    assert shown == [address][: int(opens)] and began == [runs]
    assert "saved runs remain" in done.stderr
