"""Live page of a game of any number of players."""

from collections.abc import Iterator
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fake_page import open_fake
from stepaside.core.errors import ConfigurationError
from stepaside.games.game_file import load_game, parse_game
from stepaside.games.game_settings import GameSettings
from stepaside.games.outcome import Outcome
from stepaside.games.run_archive import load_run
from stepaside.games.walker import SimulatedPlayer
from stepaside.report.viewer import live_page as pages
from stepaside.report.viewer.live_page import Page
from stepaside.report.viewer.run_saving import RunSaver
from stepaside.report.viewer.viewer_clients import ViewerClients
from stepaside.strategies import TeleoperatedPursuit

EXAMPLES = Path(__file__).parents[2] / "examples"


def game(**entries: Any) -> GameSettings:
    """Return a game of two pursuers, an evader and a person."""
    far = {"safety_radius": 2.0}
    players = [
        {"name": "red", "role": "pursuer", "start": [1.0, 0.0, pi]},
        {"name": "ruby", "role": "pursuer", "start": [-1.5, 0.0, 0.0]},
        {
            "name": "blue",
            "role": "evader",
            "start": [0.0, 0.0, 0.0],
            "evasion": far,
        },
        {
            "name": "guest",
            "body": "person",
            "start": [0.0, 3.0, 0.0],
            "goal": [3.0, 3.0],
        },
    ]
    return parse_game({"players": players} | entries, "game")


@pytest.fixture
def live(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Page, Any]]:
    monkeypatch.setattr(pages, "open_server", open_fake)
    made = Page(game(), host="there", port=1234)
    server: Any = made.server
    yield made, server
    made.session.close()


def played(page: Page, duration: float) -> None:
    """Play for a time, in [s]; the loop does nothing else then."""
    page.session.step(duration)
    page.session.push("red", 1e-9, 0.0)  # waits for the step


def test_all_players_are_shown_with_their_opponents(
    live: tuple[Page, Any],
) -> None:
    page, server = live
    played(page, 1.0)
    page.refresh()
    items = server.scene.items
    for name in ("red", "ruby", "blue", "guest"):
        assert f"/names/{name}" in items
        assert f"/layers/CoM trace/{name}" in items
    sights = {n for n in items if n.startswith("/layers/line of sight/")}
    assert sights == {
        "/layers/line of sight/red-blue",
        "/layers/line of sight/ruby-blue",
    }
    ring = items["/layers/safety radius/blue"].points[:, 0, :2]
    blue = page.session.match.player("blue").truth
    away = ring - np.array(blue.position_torso_in_world)
    np.testing.assert_allclose(np.hypot(*away.T), 2.0, atol=1e-3)
    status = server.gui.texts[0].content
    assert "**walking**: red, ruby, blue, guest" in status
    assert f"least distance {page.session.match.distance:.2f} m" in status
    assert "closest approach" in status
    page.plots.show(page.session)
    assert [plot.label for plot in server.gui.plots] == ["Distance [m]"]


def test_cameras_follow_any_player(
    live: tuple[Page, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    page, server = live
    follow = server.gui["Follow"]
    assert follow.options == ("All players", "red", "ruby", "blue", "guest")
    aimed: list[Any] = []
    monkeypatch.setattr(
        ViewerClients,
        "aim",
        lambda _, places, heights: aimed.append(np.array(places)),
    )
    for name in follow.options:
        follow.value = name
        page.refresh()
    everybody, *pairs = aimed
    assert everybody.shape == (4, 2)
    np.testing.assert_allclose(everybody[0], [1.0, 0.0], atol=0.03)  # red
    np.testing.assert_allclose(everybody[1], [0.0, 0.0], atol=0.03)  # blue
    own = [[1.0, 0.0], [-1.5, 0.0], [0.0, 0.0], [0.0, 3.0]]
    nearest = [[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]
    for places, here, there in zip(pairs, own, nearest, strict=True):
        np.testing.assert_allclose(places, [there, here], atol=0.03)


def test_any_robot_that_pursues_is_driven_and_gets_its_strategy_back(
    live: tuple[Page, Any],
) -> None:
    page, server = live
    gui = server.gui
    assert gui["Driven robot"].options == ("red", "ruby")
    gui["Driven robot"].value = "ruby"
    ruby = page.session.match.player("ruby")
    assert isinstance(ruby, SimulatedPlayer)
    before = ruby.scheme.decisions.strategy
    gui["Turn"].press("left")
    played(page, 0.1)
    assert ruby.scheme.decisions.strategy == TeleoperatedPursuit(1.0, True)
    page.refresh()
    status = gui.texts[0].content
    assert "Ruby is **driven by hand**" in status
    gui["Stop driving"].press()
    played(page, 0.1)
    assert ruby.scheme.decisions.strategy is before


def test_robots_are_pushed_by_name_and_people_are_not(
    live: tuple[Page, Any],
) -> None:
    page, server = live
    gui = server.gui
    assert gui["Robot"].options == ("red", "ruby", "blue", "guest")
    gui["Robot"].value = "ruby"
    gui["Push"].press()
    played(page, 0.2)
    pushed = {
        player.name: len(player.snapshot().pushes)
        for player in page.session.match.players
    }
    assert pushed["ruby"] == 1 and pushed["blue"] == 0
    with pytest.raises(ConfigurationError, match="only a robot"):
        page.session.push("guest", 0.4, 0.0)


def test_a_reset_plays_the_next_seed_and_a_game_is_saved(
    live: tuple[Page, Any], tmp_path: Path
) -> None:
    page, server = live
    server.gui["Seed"].value = 5
    server.gui["Game"].press("reset")
    assert page.session.settings.seed == 5
    played(page, 0.5)
    folder = page.session.save(RunSaver(tmp_path))
    assert load_run(folder).players == ("red", "ruby", "blue", "guest")


def test_an_audience_sees_every_player_and_the_next_seed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(pages, "open_server", open_fake)
    page = Page(game(seed=7), host="there", port=1234, demo=True)
    try:
        page.refresh()
        gui: Any = page.server.gui
        caption = gui.html[-1].content
        for name in ("red", "ruby", "blue", "guest"):
            assert f">{name}</b>" in caption
        assert "angle" not in caption
        page.session.outcome = Outcome.CONTACT
        page.refresh()
        assert page.session.settings.seed == 8
    finally:
        page.session.close()


def test_templates_have_no_live_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pages, "open_server", open_fake)
    with pytest.raises(ConfigurationError, match="level must be physics"):
        Page(load_game(EXAMPLES / "teams.toml"), host="there", port=1)
