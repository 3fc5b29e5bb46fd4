"""Test presets, signals and looking back on the live page."""

from collections.abc import Iterator
from dataclasses import replace
from threading import Event
from typing import Any

import numpy as np
import pytest

from fake_page import open_fake
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.outcome import Outcome
from stepaside.report.viewer import live_page as pages
from stepaside.report.viewer.duel_presets import AS_STARTED, duel_presets
from stepaside.report.viewer.live_page import Page

SETTINGS = DuelSettings(start=StartSettings(distance=1.0))


@pytest.fixture
def page(monkeypatch: pytest.MonkeyPatch) -> Iterator[Page]:
    monkeypatch.setattr(pages, "open_server", open_fake)
    made = Page(SETTINGS, host="here", port=1234)
    yield made
    made.session.close()


def play(page: Page, seconds: float) -> None:
    """Let the duel go on, and show it."""
    done = Event()
    page.session.step(seconds)
    page.session.change(lambda duel: done.set())
    assert done.wait(60.0), page.session.error
    page.refresh()


def position(page: Page, body: str) -> Any:
    """Return where the scene shows a body."""
    number = page.session.match.world.model.body(body).id
    items: Any = page.server.scene
    return np.array(items.items[f"/bodies/{number}"].position)


def test_presets_begin_with_the_settings_of_the_page() -> None:
    settings = replace(SETTINGS, seed=9)
    found = duel_presets(settings)
    assert [*found][:4] == [AS_STARTED, "duel", "room", "person"]
    assert found[AS_STARTED] is settings
    assert {each.seed for each in found.values()} == {9}


def test_a_preset_replaces_duel_and_bodies(page: Page) -> None:
    gui: Any = page.server.gui
    scene: Any = page.server.scene
    before = [h for n, h in scene.items.items() if n.startswith("/bodies/")]
    gui["Preset"].press("room")
    page.refresh()
    settings = page.session.settings
    assert isinstance(settings, DuelSettings)
    assert settings.evader_strategy == "look-ahead"
    assert settings.room.plan is not None
    frames = [h for h in before if not hasattr(h, "faces")]
    assert frames and all(handle.removed for handle in frames)
    gui["Preset"].press("person")
    page.refresh()
    settings = page.session.settings
    assert isinstance(settings, DuelSettings) and settings.pursuer == "person"
    assert gui["Template speed [m/s]"].value == pytest.approx(0.26)
    gui["Preset"].press(AS_STARTED)
    assert page.session.settings == SETTINGS


def test_the_page_looks_back(page: Page) -> None:
    play(page, 3.0)
    then = position(page, "pursuer/torso")
    play(page, 2.0)
    now = position(page, "pursuer/torso")
    assert np.linalg.norm(now - then) > 0.05
    gui: Any = page.server.gui
    gui["Look back [s]"].value = 2.0
    page.refresh()
    np.testing.assert_allclose(
        position(page, "pursuer/torso"), then, atol=5e-3
    )
    assert "looking back" in gui.texts[0].content
    gui["Look back [s]"].value = 0.0
    page.refresh()
    np.testing.assert_array_equal(position(page, "pursuer/torso"), now)


def test_any_signal_is_plotted(page: Page) -> None:
    play(page, 1.0)
    page.plots.show(page.session)
    gui: Any = page.server.gui
    labels = gui["Signal"].options
    knee = "pursuer/LKneePitch [rad]"
    assert {knee, "evader/CoM z [m]", "evader/ZMP y [m]"} < set(labels)
    gui["Signal"].value = knee
    page.plots.show(page.session)
    plot = gui.plots[-1]
    assert plot.label == knee and len(plot.data[0]) == 9
    assert 0.0 < np.ptp(plot.data[1]) < 2.0  # it bends
    gui["Signal"].value = "evader/CoM z [m]"
    page.plots.show(page.session)
    assert plot.removed
    plot = gui.plots[-1]
    np.testing.assert_allclose(plot.data[1], 0.268, atol=0.01)
    gui["Signal"].value = "none"
    page.plots.show(page.session)
    assert plot.removed


def test_a_demonstration_plays_the_next_seed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(pages, "open_server", open_fake)
    page = Page(SETTINGS, host="here", port=1234, demo=True)
    try:
        play(page, 0.5)
        gui: Any = page.server.gui
        assert gui.main_panel.minimized and gui.panels[0].minimized
        (caption,) = gui.html
        assert " m</b>" in caption.content and "pursuer" in caption.content
        seed = page.session.settings.seed
        page.session.outcome = Outcome.CONTACT
        page.refresh()
        assert page.session.settings.seed == seed + 1
        assert page.session.outcome is None
    finally:
        page.session.close()
