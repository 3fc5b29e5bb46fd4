"""A live duel behind a page, without a browser."""

from collections.abc import Iterator
from math import inf, pi
from time import monotonic, sleep

import pytest

from stepaside.control import Phase
from stepaside.control.driving import TURN, Driven
from stepaside.errors import ConfigurationError
from stepaside.report.viewer.session import Session
from stepaside.report.viewer.words import words_of
from stepaside.simulation.duel import Duel
from stepaside.simulation.settings import DuelSettings, StartSettings

START = StartSettings(distance=1.0, pursuer_offset=0.0, evader_offset=0.0)
SETTINGS = DuelSettings(start=START)


@pytest.fixture
def session() -> Iterator[Session]:
    made = Session(SETTINGS)
    made.speed = inf
    yield made
    made.close()


def run_until(session: Session, time: float) -> None:
    session.running = True
    deadline = monotonic() + 30.0
    while session.duel.world.time < time and monotonic() < deadline:
        sleep(0.005)
    session.running = False
    sleep(0.05)


def test_time_passes_only_while_it_runs(session: Session) -> None:
    sleep(0.1)
    assert session.duel.world.time == 0.0
    run_until(session, 1.0)
    stopped = session.duel.world.time
    assert stopped >= 1.0
    sleep(0.1)
    assert session.duel.world.time == stopped


def test_a_step_is_as_long_as_asked(session: Session) -> None:
    session.step(0.1)
    sleep(0.3)
    assert session.duel.world.time == pytest.approx(0.1)


def test_real_time_is_kept() -> None:
    made = Session(SETTINGS)
    made.running = True
    sleep(1.5)
    made.close()
    assert made.duel.world.time == pytest.approx(1.5, abs=0.4)


def test_a_push_changes_the_run() -> None:
    ways = []
    for impulse in (0.0, 0.8):
        made = Session(SETTINGS)
        made.speed = inf
        way: list[float] = []

        def note(duel: Duel, way: list[float] = way) -> None:
            way.append(float(duel.robots[0].truth.com[1]))

        made.on_tick = note
        made.push(0, impulse, pi / 2)
        run_until(made, 1.0)
        made.close()
        ways.append(way[:200])
    assert len(ways[0]) == len(ways[1]) == 200
    off = max(abs(a - b) for a, b in zip(*ways, strict=True))
    assert off > 1e-3


def test_nonsense_is_refused_and_the_duel_goes_on(session: Session) -> None:
    with pytest.raises(ConfigurationError, match="push impulse"):
        session.push(0, -1.0, 0.0)
    before = session.duel
    with pytest.raises(ConfigurationError, match="distance"):
        session.reset(DuelSettings(start=StartSettings(distance=0.1)))
    assert session.duel is before


def test_a_reset_begins_again(session: Session) -> None:
    run_until(session, 0.5)
    session.reset()
    assert session.duel.world.time == 0.0
    assert not session.history


def test_errors_in_the_loop_are_told(session: Session) -> None:
    def fail(duel: object) -> None:
        raise RuntimeError("a bolt came loose")

    session.change(fail)
    sleep(0.3)
    assert session.error is not None
    assert "a bolt came loose" in session.error


def test_the_hand_steers_the_same_planner(session: Session) -> None:
    hand = Driven(turn=1.0, going=True)
    session.change(lambda duel: setattr(duel.schemes[0], "role", hand))
    run_until(session, 3.0)
    plan = session.duel.schemes[0].plan
    assert plan is not None and plan.bearing == pytest.approx(TURN)
    hand.turn = -0.5
    run_until(session, 4.5)
    plan = session.duel.schemes[0].plan
    assert plan is not None and plan.bearing == pytest.approx(-0.5 * TURN)
    hand.going = False
    run_until(session, 8.0)
    assert session.duel.schemes[0].phase is Phase.STANDING


def test_history_is_bounded(session: Session) -> None:
    assert session.history.maxlen is not None
    assert all(trace.maxlen for trace in session.traces.values())


@pytest.mark.parametrize(
    ("phases", "distance", "angle", "expected"),
    [
        ((Phase.STANDING, Phase.STANDING), 1.0, 180.0, "standing"),
        ((Phase.WALKING, Phase.STANDING), 0.7, 180.0, "triggered"),
        ((Phase.WALKING, Phase.WALKING), 0.5, 120.0, "evading"),
        ((Phase.WALKING, Phase.WALKING), 0.91, 91.0, "on the circle"),
        ((Phase.FALLEN, Phase.WALKING), 0.91, 91.0, "pursuer fell"),
        ((Phase.WALKING, Phase.HALTING), 0.91, 91.0, "comes to rest"),
    ],
)
def test_words_say_what_goes_on(
    phases: tuple[Phase, Phase], distance: float, angle: float, expected: str
) -> None:
    words = words_of(phases, distance, angle, 0.8, (0.9, 90.0))
    assert expected in words


def test_a_live_duel_keeps_no_record_that_grows(session: Session) -> None:
    run_until(session, 2.0)
    assert session.duel.world.time >= 2.0
    assert len(session.duel.recorder.arrays()["times_s"]) == 1
