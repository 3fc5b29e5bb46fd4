"""A duel that is over, put together as a run."""

from dataclasses import replace
from typing import TYPE_CHECKING

from .duel_evaluation import summarise
from .duel_run import DuelRun
from .duel_settings import DuelSettings
from .match import Match
from .outcome import Outcome
from .recorder import Recorder

if TYPE_CHECKING:
    from .camera_duel import SightObserver


def ended_duel(
    settings: DuelSettings,
    match: Match,
    outcome: Outcome,
    recorder: Recorder,
    witness: "SightObserver | None",
    wall_time: float,
) -> DuelRun:
    """What was played, as a value.

    Args:
        settings: What decided it, with the start that was drawn.
        match: The game.
        outcome: How it ended.
        recorder: Who kept the record.
        witness: Who judged what the robots saw, if somebody did.
        wall_time: Time that it took, in [s].
    """
    tracks, times = recorder.tracks(), recorder.times
    if witness is not None:
        for name, rows in witness.sight().items():
            tracks[name] = replace(tracks[name], sight=rows)
    summary = summarise(
        settings,
        match,
        outcome,
        times,
        tracks,
        recorder.planning(),
        None if witness is None else witness.figures(),
        wall_time,
    )
    return DuelRun(
        name=f"duel-seed{settings.seed}",
        settings=settings,
        outcome=outcome,
        message=match.message,
        duration=summary.duration_s,
        times=times,
        tracks=tracks,
        summary=summary,
        stills={} if witness is None else witness.stills(),
    )
