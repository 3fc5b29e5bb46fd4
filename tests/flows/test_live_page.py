"""The live page, by its controls on a real server; no browser."""

import json
import re
from collections.abc import Iterator
from math import pi
from pathlib import Path
from time import sleep
from typing import Any

import numpy as np
import pytest

from flows.calls import load_run, serve_page
from flows.running import Running, until

pytest.importorskip("viser")

SEED, BEGAN = 7, 1.2  # [m] between the players


class Page:
    """A page that is served, and what a viewer does on it."""

    def __init__(self, folder: Path, *words: object) -> None:
        self.folder = folder
        process = serve_page(folder, SEED, BEGAN)
        self.running = Running(process)
        self.running.until_said("serving at")

    def _ask(self, *words: object) -> Any:
        process, lines = self.running.process, self.running.out
        assert process.stdin is not None
        before = len(lines)
        process.stdin.write(json.dumps(words) + "\n")
        process.stdin.flush()
        until(lambda: len(lines) > before)
        return json.loads(lines[before])

    def press(self, control: str, value: object = True) -> None:
        """Press a button, or choose or enter a value."""
        self._ask(control, value)

    def options(self, control: str) -> list[str]:
        """Values that a choice offers."""
        found: list[str] = self._ask(control)[1]
        return found

    def value(self, control: str) -> Any:
        """Present value of a control."""
        return self._ask(control)[0]

    @property
    def texts(self) -> str:
        """All texts of the page."""
        return "\n\n".join(self._ask(""))

    @property
    def time(self) -> float:
        """Simulated time that the page shows, in [s]."""
        (found,) = re.findall(r"([\d.]+) s simulated", self.texts)
        return float(found)

    def play(self, duration: float) -> None:
        """Start, wait until so much time has passed, and pause."""
        end = self.time + duration
        self.press("Start")
        until(lambda: self.time >= end)
        self.press("Start")
        until(self._is_still)

    def _is_still(self) -> bool:
        """Whether the page, which tells the time now and then, knows it."""
        before = self.time
        sleep(0.5)
        return self.time == before

    def save(self, group: str = "Game") -> Any:
        """Save the game so far, and read it."""
        before = set(self.folder.glob("runs/*"))
        self.press(group, "save")
        (made,) = until(lambda: set(self.folder.glob("runs/*")) - before)
        return load_run(made)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    made = Page(tmp_path_factory.mktemp("page"))
    made.press("Speed", "4")
    yield made
    assert made.running.interrupt() == 0, made.running.said
    made.running.close()


@pytest.fixture
def fresh(page: Page) -> Page:
    """The duel that the page was started with, at its beginning."""
    page.press("Preset", page.options("Preset")[-1])
    page.press("Preset", "as started")
    until(lambda: page.time == 0.0)
    return page


def test_a_duel_starts_pauses_and_goes_on_step_by_step(fresh: Page) -> None:
    fresh.play(1.0)
    paused = fresh.save().times[-1]
    for _ in range(5):
        fresh.press("Game", "step")
    until(lambda: fresh.time > paused + 0.4)
    run = fresh.save()
    assert run.times[-1] - paused == pytest.approx(0.5, abs=0.021)
    assert run.settings.seed == SEED
    assert run.distance[0] == pytest.approx(BEGAN, abs=1e-3)


def test_a_push_has_its_size_and_direction(fresh: Page) -> None:
    fresh.play(0.5)
    fresh.press("Robot", "evader")
    fresh.press("Impulse [N s]", 0.7)
    fresh.press("Direction", "left")
    fresh.press("Push")
    fresh.play(1.0)
    run = fresh.save()
    assert run.tracks["pursuer"].pushes is None
    (push,) = run.tracks["evader"].pushes
    row = int(np.searchsorted(run.times, push[0]))
    heading = run.tracks["evader"].torso[row, 2] + 0.5 * pi
    left = np.array([np.cos(heading), np.sin(heading)])
    np.testing.assert_allclose(push[-2:], 0.7 * left, atol=0.02)
    com = run.tracks["evader"].com[:, :2]
    way = (com[row : row + 25] - com[row]) @ left  # within half a second
    assert way.max() > 0.001 > -2.0 * way.min()


@pytest.mark.parametrize(("way", "sign"), [("left", 1.0), ("right", -1.0)])
def test_a_driven_robot_turns_and_halts_as_it_is_told(
    way: str, sign: float, fresh: Page
) -> None:
    fresh.play(2.0)
    fresh.press("Turn", way)
    fresh.play(4.0)
    assert f"Driven by hand**: the pursuer walks to the {way}" in fresh.texts
    driven = fresh.save()
    heading = driven.tracks["pursuer"].torso[:, 2]
    assert sign * (heading[-1] - heading[0]) > 0.2
    fresh.press("Walk", "halt")
    fresh.play(2.0)
    assert "Driven by hand**: the pursuer halts" in fresh.texts
    fresh.press("Stop driving")
    assert "Not driven: the pursuer follows its own" in fresh.texts
    fresh.play(3.0)
    path = fresh.save().tracks["pursuer"].torso
    rest, released = len(heading) + 75, len(heading) + 100
    assert np.ptp(path[rest:released, :2], axis=0).max() < 0.01
    assert sign * (path[-1, 2] - path[released, 2]) < -0.05  # back, and on


@pytest.mark.parametrize(
    "preset",
    [
        "as started",
        "duel",
        "room",
        "person",
        "cameras",
    ],
)
def test_reset_begins_again_in_every_preset(preset: str, page: Page) -> None:
    if preset not in page.options("Preset"):
        pytest.skip("cv2 is not installed")
    page.press("Preset", page.options("Preset")[preset == "as started"])
    page.press("Preset", preset)
    until(lambda: page.time == 0.0)
    page.play(0.1)
    seed = int(page.value("seed")) + 1
    page.press("seed", seed)
    page.press("Game", "reset")
    until(lambda: page.time == 0.0)
    page.play(0.1)
    run = page.save()
    assert run.settings.seed == seed
    assert run.times[-1] < 5.0


def test_a_reset_keeps_the_strategy_of_a_preset(page: Page) -> None:
    page.press("Preset", "duel")
    page.play(0.1)
    page.press("Preset", "room")
    until(lambda: page.time == 0.0)
    page.play(0.1)
    page.press("Game", "reset")
    until(lambda: page.time == 0.0)
    page.play(0.1)
    assert page.save().settings.evader.strategy == "look-ahead"


def test_a_preset_shows_its_seed_and_start(fresh: Page) -> None:
    """A reset after it plays the same duel."""
    fresh.press("seed", SEED + 5)
    fresh.press("Game", "reset")
    until(lambda: fresh.time == 0.0)
    fresh.press("Preset", "duel")
    until(lambda: fresh.time == 0.0)
    fresh.play(0.1)
    first = fresh.save()
    fresh.press("Game", "reset")
    until(lambda: fresh.time == 0.0)
    fresh.play(0.1)
    again = fresh.save()
    assert first.settings.seed == again.settings.seed == SEED
    assert first.distance[0] == pytest.approx(again.distance[0], abs=1e-3)


def test_every_preset_is_tested(page: Page) -> None:
    known = {"as started", "duel", "room", "person", "cameras"}
    assert set(page.options("Preset")) <= known
