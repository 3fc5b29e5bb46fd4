"""Short duels with every pair of settings.

Each duel is written, read, shown and pushed. All of this has its own tests
elsewhere; these tests check that every pair of settings is supported.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import combinations, product
from math import pi
from pathlib import Path
from threading import Event
from typing import Any, NamedTuple

import numpy as np
import pytest

from match_callbacks import observe_ticks
from stepaside.cli.duel import print_duel
from stepaside.core.errors import ConfigurationError
from stepaside.games.duel import Duel, run_duel
from stepaside.games.duel_settings import (
    PLAYERS,
    DuelSettings,
    StartSettings,
)
from stepaside.games.outcome import Outcome
from stepaside.games.run import DuelRun
from stepaside.games.run_archive import load_run, results_of, write_run_files
from stepaside.games.trajectory import Trajectory
from stepaside.games.walker import SimulatedPlayer
from stepaside.locomotion.zmp.control_settings import METHODS, ControlSettings
from stepaside.report.figure_style import plt
from stepaside.report.film import FilmRenderer, FilmSettings
from stepaside.report.replay_page import write_page
from stepaside.report.run_folder import write_run
from stepaside.report.viewer.camera_panel import picture
from stepaside.report.viewer.live_drawing import draw_session
from stepaside.report.viewer.live_session import LiveSession
from stepaside.sim.body_settings import BODIES
from stepaside.sim.camera_settings import (
    CameraSettings,
    ColourSettings,
    DepthSettings,
)
from stepaside.sim.offscreen_rendering import RAYCAST, choose_renderer
from stepaside.sim.person_settings import PURSUERS
from stepaside.strategies import Evasion
from synthetic_run import check_same

SENSING = ("ideal", "cameras")  # a lidar sees people only
PUSHED = 0.24  # [s]; a push is over, and what it does has been felt
LONG = 60.0  # [s]; no event of a loop that runs comes as late as this
CAMERAS = CameraSettings(  # as small as they still find each other
    colour=ColourSettings(width=160, height=120, renderer=RAYCAST),
    depth=DepthSettings(width=40, height=30),
)


class Case(NamedTuple):
    """Combination of settings."""

    pursuer: str
    sensing: str
    body: str
    method: str

    @property
    def walkers(self) -> tuple[str, ...]:
        """Players that are robots."""
        return PLAYERS if self.pursuer == "robot" else PLAYERS[1:]

    @property
    def cameras(self) -> set[str]:
        """Labels of all cameras."""
        if self.sensing == "ideal":
            return set()
        return {f"{name}, colour" for name in self.walkers} | {"evader, depth"}

    @property
    def duration(self) -> float:
        """Time until all players walk, in [s].

        Images have to arrive first, a person who comes is watched for a
        while, and feedback stands still for a second.
        """
        watched = self.pursuer == "person" and self.sensing == "cameras"
        return 1.2 if self.body != "ideal" else 0.9 if watched else 0.2

    def settings(self) -> DuelSettings:
        """Settings of the duel."""
        method: Any = self.method
        return DuelSettings(
            duration=self.duration,
            pursuer=self.pursuer,
            sensing=self.sensing,
            body=BODIES[self.body],
            control=ControlSettings(method, feedback=self.body != "ideal"),
            cameras=CAMERAS,
            start=StartSettings(1.2, 0.3, -0.2),
            strategy=Evasion(safety_radius=1.5),
        )


def accepted() -> Iterator[Case]:
    """Yield every valid combination."""
    for found in product(PURSUERS, SENSING, ("ideal", "hardware"), METHODS):
        case = Case(*found)
        try:
            case.settings()
        except ConfigurationError:
            continue
        yield case


def of_pairs(cases: Sequence[Case]) -> Iterator[Case]:
    """Yield half of the combinations, with every pair of settings."""
    controls = sorted({(case.body, case.method) for case in cases})
    for case in cases:
        number = controls.index((case.body, case.method))
        number += PURSUERS.index(case.pursuer) + SENSING.index(case.sensing)
        if number % 2 == 0:
            yield case


COMBINATIONS = tuple(accepted())
CASES = tuple(of_pairs(COMBINATIONS))


class Played(NamedTuple):
    """Duel of a case, and its run folder."""

    case: Case
    run: DuelRun
    folder: Path


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(
            case,
            id="-".join(case),
            marks=pytest.mark.xdist_group(f"matrix {'-'.join(case[:2])}"),
        )
        for case in CASES
    ],
)
def played(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Played:
    case: Case = request.param
    folder = tmp_path_factory.mktemp("runs") / "-".join(case)
    run = run_duel(case.settings())
    assert write_run(folder, run) == folder / "duel.png"
    return Played(case, run, folder)


def test_only_missing_feedback_is_refused() -> None:
    assert len(COMBINATIONS) == 2 * 2 * 4
    for pursuer, sensing in product(PURSUERS, SENSING):
        own = {
            case[2:] for case in COMBINATIONS if case[:2] == (pursuer, sensing)
        }
        hardware = {("hardware", method) for method in METHODS}
        assert own == {("ideal", "closed-form")} | hardware
    with pytest.raises(ConfigurationError, match="needs feedback"):
        Case("robot", "ideal", "ideal", "mpc").settings()


def test_every_pair_of_settings_is_played() -> None:
    def pairs(cases: Sequence[Case]) -> set[tuple[str, str]]:
        return {pair for case in cases for pair in combinations(case, 2)}

    assert pairs(CASES) == pairs(COMBINATIONS)
    assert len(CASES) == len(COMBINATIONS) / 2


# What only a walk is looked at for, what is told to robots that walk by
# themselves, and pushes, which are not given here.
NEAR = {"velocity", "tilt", "sole", "support", "heading_reference"}
NEAR |= {"estimate", "pushes", "command"}


def test_summary_describes_each_player(played: Played) -> None:
    case, run, _ = played
    assert run.outcome is Outcome.COMPLETED
    assert run.summary.triggered_at_s is not None
    assert run.duration == pytest.approx(run.times[-1])
    assert run.duration == pytest.approx(case.duration, abs=1e-9)
    assert tuple(run.tracks) == PLAYERS
    for name, track in run.tracks.items():
        lacking = {
            field
            for field in Trajectory.__dataclass_fields__
            if getattr(track, field) is None
        }
        if name not in case.walkers:
            assert lacking == set(Trajectory.__dataclass_fields__) - {
                *("com", "place", "torso")
            }
            continue
        blind = {"sight"} if case.sensing == "ideal" else set()
        assert lacking == blind | NEAR
        assert track.landings is not None and len(track.landings) == 1
    for name, track in run.tracks.items():
        for field in ("com", "torso", "com_reference", "zmp", "qpos"):
            rows = getattr(track, field)
            assert rows is None or len(rows) == len(run.times), (name, field)
    stilled = {
        f"{name}, {kind}"
        for name, kinds in run.stills.items()
        for kind, stills in kinds.items()
        if stills
    }
    assert stilled == case.cameras
    assert (run.summary.sight is not None) is bool(case.cameras)


def test_run_folder_is_complete_and_read_unchanged(
    played: Played, tmp_path: Path
) -> None:
    case, run, folder = played
    strip = ["sight.png"] if case.cameras else []
    assert sorted(file.name for file in folder.iterdir()) == [
        *("checksums.txt", "configuration.toml", "duel.png", *strip),
        *("summary.json", "trajectories.npz"),
    ]
    for file in folder.glob("*.png"):
        assert plt.imread(file).std() > 0.05
    loaded = load_run(folder)
    check_same(loaded, run)
    assert loaded.name == folder.name and not loaded.stills
    again = tmp_path / "again"
    again.mkdir()
    write_run_files(again, loaded)
    check_same(load_run(again), run)


def test_values_are_printed_beside_theory(
    played: Played, capsys: pytest.CaptureFixture[str]
) -> None:
    case, run, _ = played
    print_duel(run, "not reached")
    text = capsys.readouterr().out
    assert f"completed: played {case.duration:.2f} s" in text
    assert ("detection rate" in text) == bool(case.cameras)
    for name in PLAYERS:
        sees = bool(case.cameras) and name in case.walkers
        sight = results_of(run)[name]["sight"]
        assert (sight is not None) == sees
        told = sees and sight["bearing_error_deg"]["median"] is not None
        assert (f"{name}'s bearing error" in text) == told


def test_offline_page_is_written(played: Played, tmp_path: Path) -> None:
    _, _, folder = played
    file = tmp_path / "run.html"
    write_page(load_run(folder), file)
    text = file.read_text(encoding="utf-8")
    (told,) = re.findall(r"(\{\"times\".*\})", text)
    assert "@@" not in text and folder.name in text
    assert "NaN" not in told and "Infinity" not in told


@pytest.mark.skipif(
    choose_renderer() == RAYCAST, reason="neither EGL nor OSMesa works here"
)
def test_film_has_a_frame(played: Played) -> None:
    run = load_run(played.folder)
    cinema = FilmRenderer(run, FilmSettings(64, 48), choose_renderer())
    shown = cinema.picture(0.5 * played.case.duration)
    cinema.close()
    assert shown.shape == (48, 64, 3) and shown.std() > 5.0


@pytest.fixture
def session(played: Played) -> Iterator[LiveSession]:
    made = LiveSession(played.case.settings())
    yield made
    made.close()


def stepped(session: LiveSession, duration: float) -> None:
    """Advance the session by a time in [s], and wait for it."""
    done = Event()
    session.step(duration)
    session.change(lambda duel: done.set())
    assert done.wait(LONG) and session.error is None, session.error


def test_live_duel_is_stepped_pushed_and_drawn(
    played: Played, session: LiveSession
) -> None:
    case = played.case
    stepped(session, case.duration)
    for name in PLAYERS:
        if name in case.walkers:
            session.push(name, 2.5, pi / 2)
            continue
        with pytest.raises(
            ConfigurationError, match="only a robot can be pushed"
        ):
            session.push(name, 2.5, pi / 2)
    solved: set[str] = set()

    def look(duel: Duel) -> None:
        for player in duel.players:
            walk = player.snapshot().walk
            if walk is not None and walk.solved is not None:
                solved.add(player.name)

    observe_ticks(session.match, look)
    stepped(session, PUSHED)
    assert session.outcome is None
    passed = case.duration + PUSHED
    assert session.match.world.time == pytest.approx(passed, abs=0.012)
    # The plan itself is the answer until a push throws a robot off it.
    assert solved == (set(case.walkers) if case.method == "mpc" else set())
    for player in session.match.players:
        seen = player.snapshot()
        if not isinstance(player, SimulatedPlayer):
            assert seen.walk is None
            continue
        assert player.robot.pusher is not None
        impulse = np.hypot(*player.robot.pusher.impulse[:2])
        assert impulse == pytest.approx(2.5, rel=0.01)
        assert seen.walk is not None and seen.walk.plan is not None
        feedback = case.body != "ideal"
        assert (seen.walk.estimate is not None) == feedback

    drawn: set[tuple[str, str]] = set()

    class Noting:
        """Layers that record what is drawn."""

        def draw(self, layer: str, owner: str, *_: Any) -> None:
            """Record a drawing."""
            drawn.add((layer, owner))

    layers: Any = Noting()
    draw_session(layers, session)
    for name in PLAYERS:
        walks = name in case.walkers
        assert (("footsteps", name) in drawn) == walks
        assert ("CoM trace", name) in drawn
    frames = session.new_frames()
    assert set(frames) == case.cameras
    for label, report in frames.items():
        size = (120, 160, 3) if "colour" in label else (180, 240, 3)
        assert picture(report).shape == size
    assert len(session.match.recorder.times) > 20
