"""Test the clock of a served simulation, with a simulated time."""

from typing import Any

import pytest

from stepaside.games.served_duel import ClientSynchroniser

TICK = 0.012  # [s]


class Clock:
    """Clock that is advanced by hand."""

    now = 1000.0

    def __call__(self) -> float:
        """Time, in [s]."""
        return self.now

    def pause(self, duration: float) -> None:
        """Let time pass."""
        self.now += duration


class FakeServer:
    """Server whose client answers at once, or never."""

    def __init__(self, *, answers: bool = True) -> None:
        self.answers, self.connected = answers, True
        self.log: list[str] = []

    def speak(self) -> None:
        """Note it."""
        self.log.append("speak")

    def hear(self) -> bool:
        """Return whether no command is awaited."""
        return self.answers or not self.connected

    def act(self) -> None:
        """Note it."""
        self.log.append("act")

    def drop(self, why: str) -> None:
        """Disconnect the client."""
        self.connected = False
        self.log.append(why)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    module = "stepaside.games.served_duel"
    monkeypatch.setattr(f"{module}.monotonic", clock)
    monkeypatch.setattr(f"{module}.sleep", clock.pause)
    return clock


def exchange_of(*servers: Any, **changes: Any) -> ClientSynchroniser:
    return ClientSynchroniser(servers, TICK, **changes)


def test_ticks_are_12_ms_apart_for_any_computing_time(clock: Clock) -> None:
    exchange = exchange_of(FakeServer())
    began = clock.now
    for _ in range(50):
        exchange.before(None)  # type: ignore[arg-type]
        clock.now += 0.005
    assert clock.now - began == pytest.approx(49 * TICK + 0.005)
    assert exchange.late == 0


def test_a_stall_is_not_caught_up_with(clock: Clock) -> None:
    exchange = exchange_of(FakeServer())
    exchange.before(None)  # type: ignore[arg-type]
    clock.now += 1.0
    exchange.before(None)  # type: ignore[arg-type]
    resumed = clock.now
    for _ in range(10):
        exchange.before(None)  # type: ignore[arg-type]
    assert clock.now - resumed == pytest.approx(10 * TICK)


def test_in_lock_step_a_silent_client_is_dropped_and_the_game_goes_on(
    clock: Clock,
) -> None:
    silent = FakeServer(answers=False)
    exchange = exchange_of(FakeServer(), silent, lock_step=True)

    exchange.before(None)  # type: ignore[arg-type]
    assert exchange.unanswered == 1
    assert not silent.connected and "no answer for 5 s" in silent.log[-2]
    before = clock.now
    exchange.before(None)  # type: ignore[arg-type]
    assert clock.now == before and exchange.late == 0
