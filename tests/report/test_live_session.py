"""A live duel behind a page, without a browser."""

import json
from collections.abc import Callable, Iterator
from math import inf, pi
from pathlib import Path
from threading import Event, Thread, current_thread
from time import sleep

import numpy as np
import pytest

from match_callbacks import observe_ticks, stop_observing
from stepaside.core.errors import ConfigurationError, StepAsideError
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.run_archive import load_run
from stepaside.games.walker import SimulatedPlayer
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.report.viewer import live_session as live
from stepaside.report.viewer import plot_history as trails
from stepaside.report.viewer import run_saving as saving
from stepaside.report.viewer.drive_panel import TURN
from stepaside.report.viewer.live_session import LiveSession
from stepaside.report.viewer.status_text import outlook, status_text
from stepaside.strategies import Walk
from stepaside.strategies.approach import Approach

START = StartSettings(distance=1.0, pursuer_offset=0.0, evader_offset=0.0)
SETTINGS = DuelSettings(start=START)
LONG = 60.0  # [s]; no event of a loop that runs comes as late as this


@pytest.fixture
def session() -> Iterator[LiveSession]:
    made = LiveSession(SETTINGS)
    made.speed = inf
    yield made
    made.close()


def settle(session: LiveSession, rounds: int = 1) -> None:
    """Wait until the loop has done what was asked, and begins a round."""
    for _ in range(rounds):
        served = Event()
        session.change(_setter(served))
        assert served.wait(LONG), session.error


def _setter(event: Event) -> Callable[[RecordedGame], None]:
    return lambda duel: event.set()


def loop_thread(session: LiveSession) -> Thread:
    """Return the thread in which the duel is played."""
    found: list[Thread] = []
    done = Event()

    def note(duel: RecordedGame) -> None:
        found.append(current_thread())
        done.set()

    session.change(note)
    assert done.wait(60.0)
    return found[0]


def run_until(session: LiveSession, time: float) -> None:
    """Let time pass up to a tick, and stop there."""
    reached, duel = Event(), session.match
    tick = duel.in_physics.physics.tick

    def look(duel: RecordedGame) -> None:
        if duel.world.time + tick >= time - 1e-9:
            session.running = False
            reached.set()

    looking = observe_ticks(duel, look)
    session.running = True
    assert reached.wait(LONG), session.error
    settle(session)
    stop_observing(duel, looking)


def walker(session: LiveSession, number: int = 0) -> SimulatedPlayer:
    """Player who is a robot."""
    player = session.match.in_physics.players[number]
    assert isinstance(player, SimulatedPlayer)
    return player


def test_time_passes_only_while_it_runs(session: LiveSession) -> None:
    settle(session, rounds=5)
    assert session.match.world.time == 0.0
    run_until(session, 1.0)
    assert session.match.world.time == pytest.approx(1.0)
    settle(session, rounds=5)
    assert session.match.world.time == pytest.approx(1.0)


def test_a_pause_from_outside_holds_at_once(session: LiveSession) -> None:
    ticked = Event()
    observe_ticks(session.match, lambda duel: ticked.set())
    session.running = True
    assert ticked.wait(LONG)
    session.running = False
    settle(session)
    stopped = session.match.world.time
    settle(session, rounds=5)
    assert session.match.world.time == stopped > 0.0


def test_a_step_is_as_long_as_asked(session: LiveSession) -> None:
    session.step(0.1)
    settle(session, rounds=3)
    assert session.match.world.time == pytest.approx(0.1)


class Clock:
    """Time that passes only by sleeping, and by what a tick costs.

    Who sleeps for other tests' sake in this process does not count.
    """

    def __init__(self) -> None:
        self.now = 100.0
        self.sleeper: Thread | None = None

    def sleep(self, duration: float) -> None:
        """Let time pass."""
        if current_thread() is self.sleeper:
            self.now += duration
        else:
            sleep(duration)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(live, "perf_counter", lambda: made.now)
    monkeypatch.setattr(live, "sleep", made.sleep)
    return made


def time_for(
    clock: Clock,
    speed: float,
    cost: Callable[[float], float] = lambda time: 0.0,
) -> tuple[float, LiveSession]:
    """Time of the clock that 1.5 s of a duel take."""
    made = LiveSession(SETTINGS)
    clock.sleeper = loop_thread(made)
    made.speed = speed
    times = []

    def pay(duel: RecordedGame) -> None:
        times.append(clock.now)
        clock.now += cost(duel.world.time)

    observe_ticks(made.match, pay)
    run_until(made, 1.5)
    made.close()
    assert made.match.world.time == pytest.approx(1.5)
    return times[-1] - times[0], made


@pytest.mark.parametrize("speed", [0.5, 1.0, 2.0])
def test_time_passes_at_the_speed_asked_for(
    clock: Clock, speed: float
) -> None:
    took, made = time_for(clock, speed)
    assert took * speed == pytest.approx(1.5, abs=0.015)
    assert made.real_time_factor == pytest.approx(speed, rel=0.05)


def test_a_short_delay_is_made_up_and_a_long_one_is_not(clock: Clock) -> None:
    def hitch(length: float) -> Callable[[float], float]:
        return lambda time: length if abs(time - 0.5) < 1e-9 else 0.0

    assert time_for(clock, 1.0, hitch(0.1))[0] == pytest.approx(1.5, abs=0.02)
    assert 0.1 < live.MAX_DELAY < 3.0
    assert time_for(clock, 1.0, hitch(3.0))[0] == pytest.approx(4.5, abs=0.02)


def test_a_slow_machine_is_told_by_the_factor(clock: Clock) -> None:
    took, made = time_for(clock, 1.0, lambda time: 0.008)
    assert took == pytest.approx(3.0, abs=0.02)
    assert made.real_time_factor == pytest.approx(0.5, rel=0.05)


def test_a_push_changes_the_run() -> None:
    ways = []
    for impulse in (0.0, 0.8):
        made = LiveSession(SETTINGS)
        made.speed = inf
        way: list[float] = []

        def record_command(duel: RecordedGame, way: list[float] = way) -> None:
            way.append(
                float(
                    duel.in_physics.players[0].truth.position_com_in_world[1]
                )
            )

        observe_ticks(made.match, record_command)
        made.push("pursuer", impulse, pi / 2)
        run_until(made, 1.0)
        made.close()
        ways.append(way[:200])
    assert len(ways[0]) == len(ways[1]) == 200
    off = max(abs(a - b) for a, b in zip(*ways, strict=True))
    assert off > 1e-3


def test_nonsense_is_refused_and_the_duel_goes_on(
    session: LiveSession,
) -> None:
    with pytest.raises(ConfigurationError, match="push impulse"):
        session.push("pursuer", -1.0, 0.0)
    before = session.match
    with pytest.raises(ConfigurationError, match="distance"):
        session.reset(DuelSettings(start=StartSettings(distance=0.1)))
    assert session.match is before


def test_a_reset_begins_again(session: LiveSession) -> None:
    run_until(session, 0.5)
    session.reset()
    assert session.match.world.time == 0.0
    assert not session.trail.history and not session.trail.steps


def test_a_duel_is_let_go_by_the_thread_that_drew_for_it() -> None:
    """When another one has begun, and at the end; each of them once."""
    made = LiveSession(SETTINGS)
    loop = loop_thread(made)
    closed: list[tuple[RecordedGame, Thread]] = []

    def watch() -> RecordedGame:
        duel = made.match
        duel.world.close = lambda: closed.append(  # type: ignore[method-assign]
            (duel, current_thread())
        )
        return duel

    first = watch()
    with pytest.raises(ConfigurationError, match="distance"):
        made.reset(DuelSettings(start=StartSettings(distance=0.1)))
    assert closed == []
    made.reset()
    assert [duel for duel, _ in closed] == [first]
    second = watch()
    made.close()
    assert [duel for duel, _ in closed] == [first, second]
    assert {thread for _, thread in closed} == {loop}


def test_errors_in_the_loop_are_told(session: LiveSession) -> None:
    def fail(duel: object) -> None:
        raise RuntimeError("a bolt came loose")

    session.change(fail)
    settle(session)
    assert session.error is not None
    assert "a bolt came loose" in session.error


def test_the_hand_steers_the_same_planner(session: LiveSession) -> None:
    scheme = walker(session).scheme

    def hold(hand: Walk) -> None:
        session.change(lambda duel: scheme.decisions.adopt(hand))

    hold(Walk(TURN))
    run_until(session, 3.0)
    plan = scheme.state.plan
    assert plan is not None and plan.bearing == pytest.approx(TURN)
    hold(Walk(-0.5 * TURN))
    run_until(session, 4.5)
    plan = scheme.state.plan
    assert plan is not None and plan.bearing == pytest.approx(-0.5 * TURN)
    hold(Walk(-0.5 * TURN, speed_factor=0.0))
    run_until(session, 8.0)
    assert scheme.phase is Phase.STANDING


def test_history_is_bounded(
    session: LiveSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full history drops its oldest entries, so a page can stay open."""
    assert session.trail.history.maxlen == trails.MAX_SAMPLES
    monkeypatch.setattr(trails, "MAX_SAMPLES", 4)
    monkeypatch.setattr(trails, "MAX_TRACE", 3)
    session.reset()
    # What is true at 1.0 s is noted by the tick that begins then.
    run_until(session, 1.004)
    trail = session.trail
    times = [row[0] for row in trail.history]
    assert times == pytest.approx([0.7, 0.8, 0.9, 1.0])
    assert len(trail.traces) == 4
    assert all(len(trace) == 3 for trace in trail.traces.values())


@pytest.mark.parametrize(
    ("phases", "distance", "angle", "expected"),
    [
        ((Phase.STANDING, Phase.STANDING), 1.0, 180.0, "standing"),
        ((Phase.WALKING, Phase.STANDING), 0.7, 180.0, "triggered"),
        ((Phase.WALKING, Phase.WALKING), 0.5, 120.0, "evading"),
        ((Phase.WALKING, Phase.WALKING), 0.91, 91.0, "on the circle"),
        ((Phase.FALLEN, Phase.WALKING), 0.91, 91.0, "pursuer fell"),
        ((Phase.WALKING, Phase.HALTING), 0.91, 91.0, "**halting**"),
    ],
)
def test_words_say_what_goes_on(
    phases: tuple[Phase, Phase], distance: float, angle: float, expected: str
) -> None:
    words = status_text(phases, distance, angle, 0.8, (0.9, 90.0))
    assert expected in words


def test_of_a_live_duel_the_first_minutes_are_kept(
    session: LiveSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Histories are bounded."""
    monkeypatch.setattr(saving, "MAX_RECORDED", 1.0)
    run_until(session, 2.0)
    duel = session.match
    assert duel.world.time >= 2.0
    np.testing.assert_allclose(duel.recorder.times, 0.02 * np.arange(51))
    assert all(len(t.com) == 51 for t in duel.recorder.tracks().values())
    assert isinstance(duel, RecordedGame) and duel.sight_observer is None
    assert duel.observers[0] is session.trail


def test_what_was_played_is_saved_with_pushes_and_commands(
    session: LiveSession, tmp_path: Path
) -> None:
    kept = saving.RunSaver(tmp_path)
    with pytest.raises(StepAsideError, match="nothing has been recorded"):
        session.save(kept)
    run_until(session, 0.6)
    session.push("evader", 0.2, 0.0)
    session.record_command(turn=1.0, going=True)
    run_until(session, 1.2)
    folder = session.save(kept)
    run = load_run(folder)
    assert run.tracks["evader"].pushes is not None
    assert run.times[-1] >= 1.0 and folder.parent == tmp_path
    (asked,) = json.loads((folder / saving.COMMAND_FILE).read_text())
    assert asked["turn"] == 1.0 and 0.5 < asked["time_s"] <= 1.2
    again = session.save(kept)
    assert again.name == f"{folder.name}-2"


def test_a_page_saves_a_few_runs_at_most(
    session: LiveSession, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(saving, "MAX_FOLDERS", 0)
    with pytest.raises(StepAsideError, match="must be at most 0"):
        session.save(saving.RunSaver(tmp_path))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("phase", "distance", "theory", "settling", "told"),
    [
        (Phase.STANDING, 1.53, (0.9, 90.0), 14.0, "in about 10 s"),
        (Phase.WALKING, 0.60, (0.9, 90.0), 10.0, "in about 19 s"),
        (Phase.WALKING, 0.91, (0.9, 90.0), 10.0, "within 5 % of it"),
        (Phase.WALKING, 0.91, None, None, "no circle"),
    ],
)
def test_the_outlook_says_what_comes_next_and_when(
    phase: Phase,
    distance: float,
    theory: tuple[float, float] | None,
    settling: float | None,
    told: str,
) -> None:
    """Off by a third, five hundredths are log(6.7) times the slowest mode."""
    words = outlook(
        distance,
        phase,
        safety=0.8,
        approach=Approach(distance, 0.0, -0.073, 0.0),
        theory=theory,
        settling=settling,
    )
    assert told in words
