"""Recordings of a live game in pieces, and the thread that shows them."""

import logging
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from threading import Event, Thread
from typing import NamedTuple, Protocol

import numpy as np

from ...core.poses import Array
from ...games.duel import Duel, make_duel_run
from ...games.game_evaluation import GameRecord
from ...games.game_furnishing import colours_of_players
from ...games.game_match import GameMatch, make_match_run
from ...games.match import Match
from ...games.outcome import Outcome
from ...games.recorder import Recorder
from ...games.replayed_signals import SignalRecorder
from ...games.run import Run
from ..landed_footsteps import LANDED, NO_FOOTSTEPS
from .recording import Recording, RobotModel

LOG = logging.getLogger(__name__)
PERIOD = 0.1  # between two pieces, in [s] of the clock on the wall
LEAST = 2  # samples of a piece


class LivePiece(NamedTuple):
    """What has happened since the last piece.

    Attributes:
        recording: The samples, with all signals.
        begins: Whether it is the first of a game.
    """

    recording: Recording
    begins: bool


class LiveSink(Protocol):
    """Receiver of a live game."""

    def show(self, piece: LivePiece) -> None:
        """Show a piece."""

    def close(self) -> None:
        """Disconnect."""


class LiveRecorder:
    """Match observer that gives out what it has recorded, piece by piece."""

    def __init__(self) -> None:
        """Begin without a match."""
        self._match: Duel | GameMatch | None = None
        self._begins = False
        self._models: Mapping[str, RobotModel] = {}
        self._pending: dict[str, Array] = {}  # footsteps yet to land

    def before(self, match: Match) -> None:
        """Take a sample when one is due."""
        if match is not self._match:
            assert isinstance(match, Duel | GameMatch)
            self._match, self._begins = match, True
            self._pending = {}
            robots = {
                p.name: match.settings.robot_of(p.name).robot
                for p in match.players
                if p.name in match.settings.robots
            }
            colours = colours_of_players(match.settings)
            self._models = {
                n: RobotModel.of(r, colours.get(n)) for n, r in robots.items()
            }
            self._renew(match)
        self._recorder.before(match)
        self._signals.before(match)

    def acted(self, match: Match) -> None:
        """Record steps, plans and images of this tick."""
        self._recorder.acted(match)
        self._signals.acted(match)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Take the last sample."""
        if match is self._match:
            self._recorder.ended(match, outcome)
            self._signals.ended(match, outcome)

    def _renew(self, match: Match) -> None:
        tick = match.world.physics.tick
        self._recorder = Recorder(match.players, tick=tick)
        self._signals = SignalRecorder()

    def take(self) -> LivePiece | None:
        """Return what was recorded since the last call; None if too little.

        No tick may run meanwhile.
        """
        match = self._match
        if match is None or len(self._recorder.times) < LEAST:
            return None
        run = _run_of(match, self._recorder)
        tracks = {
            name: replace(
                track, landings=self._landed(name, track.landings, run.times)
            )
            for name, track in run.tracks.items()
        }
        signals = self._signals.signals(run)
        begins, self._begins = self._begins, False
        self._renew(match)
        recording = Recording(
            replace(run, tracks=tracks), self._models, signals, ()
        )
        return LivePiece(recording, begins)

    def _landed(
        self, name: str, landings: Array | None, times: Array
    ) -> Array | None:
        """Return the footsteps that landed in a piece, and keep the others."""
        if landings is None:
            return None
        pending = self._pending.get(name, NO_FOOTSTEPS)
        rows = np.concatenate([pending, landings])
        landed = rows[:, 0] + LANDED <= times[-1]
        self._pending[name] = rows[~landed]
        found: Array = rows[landed]
        return found


def _run_of(match: Duel | GameMatch, recorder: Recorder) -> Run:
    """Return what was recorded of a game as a run."""
    ended = Outcome.INTERRUPTED
    if isinstance(match, Duel):
        return make_duel_run(match.settings, match, ended, recorder, None, 0.0)
    record = GameRecord(
        *(match.settings, ended, match.message, match.world.time),
        *(recorder.times, recorder.tracks(), recorder.planning()),
        *(match.goals_at, match.touched, match.fallen),
    )
    return make_match_run(record, 0.0)


class LiveStreams:
    """Thread that passes the pieces of a live game to other programs."""

    def __init__(
        self,
        recorder: LiveRecorder,
        lock: AbstractContextManager[object],
        sinks: Sequence[LiveSink],
    ) -> None:
        """Start the thread.

        Args:
            recorder: Observer of the game.
            lock: Lock that is held while the game changes.
            sinks: The programs; the caller closes them.
        """
        self._recorder, self._lock, self._sinks = recorder, lock, sinks
        self._closing = Event()
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop the thread."""
        self._closing.set()
        self._thread.join(timeout=5.0)

    def _run(self) -> None:
        while not self._closing.wait(PERIOD):
            try:
                with self._lock:
                    piece = self._recorder.take()
                for sink in self._sinks if piece is not None else ():
                    assert piece is not None
                    sink.show(piece)
            except Exception:  # of a library; the game goes on
                LOG.exception("a piece of the game could not be shown")
