"""Test the claims on evading: each fails under a synthetic fault."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.games import Outcome
from stepaside.studies import game_claims as read
from stepaside.studies.claims import Claim, load_claims
from stepaside.studies.game_claims import DURATION
from stepaside.studies.tournament import ASIDE, StrategyTrack

BEST = 1.0  # bound of all starts, in [m]
Games = dict[tuple[str, str], tuple[StrategyTrack, ...]]
Fault = Callable[[Games], Games]


@pytest.fixture(autouse=True)
def known_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(read, "bound_of", lambda *_: BEST)


def claims(job: str) -> dict[str, Claim]:
    return load_claims()[job]


def game(
    closest: float = 0.7,
    outcome: Outcome = Outcome.COMPLETED,
    clear: float = 0.205,
    decision: float = 5e-4,
) -> StrategyTrack:
    """Return a game of three steps, closest at the second."""
    pursuer, evader = np.zeros((3, 3)), np.zeros((3, 3))
    evader[:, 0] = 1.2, closest, 1.1
    clearances = np.array([0.5, clear, 0.4])
    return StrategyTrack(
        outcome,
        np.arange(3.0),
        pursuer,
        evader,
        clearances,
        decision,
        decision,
    )


TOUCHED = game(outcome=Outcome.TOUCHED, clear=0.19)
CAPTURED = game(0.34, Outcome.CAPTURED)


def played() -> Games:
    """Return five games of each evader."""
    return {
        ("open", ASIDE): 5 * (game(0.7),),
        ("open", "look-ahead"): 5 * (game(0.99),),
        ("room", ASIDE): 5 * (TOUCHED,),
        ("room", "look-ahead"): 5 * (game(),),
    }


def with_games(tournament: str, evader: str, *games: StrategyTrack) -> Fault:
    """Replace the games of an evader in a tournament."""
    return lambda found: found | {(tournament, evader): games}


AHEAD = "look-ahead"
EVADING: dict[str, tuple[Fault, ...]] = {
    "farther": (
        with_games("open", AHEAD, game(0.8)),
        with_games("open", ASIDE, game(0.9)),
    ),
    "best": (with_games("open", AHEAD, game(0.9), game(0.95)),),
    "survives": (
        with_games("room", AHEAD, CAPTURED, CAPTURED, game(), game(), game()),
        with_games("room", AHEAD, TOUCHED, TOUCHED, game(), game(), game()),
    ),
    "clear": (with_games("room", AHEAD, *(4 * (game(),)), game(clear=0.199)),),
    "aside": (
        with_games("room", ASIDE, *(5 * (game(),))),
        with_games("room", AHEAD, *(5 * (TOUCHED,))),
    ),
    "decision": (with_games("room", AHEAD, game(), game(decision=0.03)),),
}


@pytest.mark.parametrize("key", claims("evading"))
def test_every_claim_on_evading_holds_and_fails(key: str) -> None:
    claim, right = claims("evading")[key], played()
    assert claim.holds([read.read_evading(right)[key]])
    for fault in EVADING[key]:
        assert not claim.holds([read.read_evading(fault(right))[key]])


def duel(
    outcome: Outcome = Outcome.COMPLETED,
    touched: tuple[str, ...] = (),
    duration: float = DURATION,
    captured_at: float | None = None,
) -> Any:
    """Return the attributes of a duel that the readings use."""
    return SimpleNamespace(
        outcome=outcome,
        duration=duration,
        summary=SimpleNamespace(touched=touched, captured_at_s=captured_at),
    )


CONTACT = Outcome.CONTACT
BOTH = ("evader", "pursuer")
ROOM: dict[str, tuple[tuple[Any, float], ...]] = {
    "touched": (
        (duel(CONTACT, ("disc 1", "evader"), 9.0), 0.02),
        (duel(Outcome.FALL, (), 9.0), 0.02),
        (duel(CONTACT, ("disc 1", "evader"), 9.0, captured_at=3.0), 0.02),
    ),
    "clear": ((duel(), -0.001),),
    "free": (
        (duel(CONTACT, BOTH, 9.0), 0.02),
        (duel(CONTACT, BOTH), 0.02),
        (duel(Outcome.FALL, (), 30.0), 0.02),
        (duel(duration=30.0), 0.02),
        (duel(captured_at=20.0), 0.02),
    ),
}


@pytest.mark.parametrize("key", claims("rooms"))
def test_every_claim_in_rooms_holds_and_fails(key: str) -> None:
    claim = claims("rooms")[key]

    def reading(run: Any, least: float) -> float:
        clear = {"pursuer": 0.3, "evader": least}
        return read.read_room(run, lambda _, name: clear[name])[key]

    assert claim.holds([reading(duel(), 0.02)])
    for run, least in ROOM[key]:
        assert not claim.holds([reading(run, least)])
