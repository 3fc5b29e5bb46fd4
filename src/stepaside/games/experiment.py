"""Experiments: a ROS 2 bag of players, recorded elsewhere, as a run."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from .bag_poses import PoseSeries, read_poses
from .evaluation import measure
from .experiment_settings import ExperimentSettings
from .outcome import Outcome
from .player_names import MOST_PLAYERS, PLAYER_NAME
from .run import Run
from .trajectory import Trajectory, check_record

NOTED_GAP = 0.5  # without a pose, from which on a note says so, in [s]


def parse_sources(words: tuple[str, ...]) -> dict[str, str]:
    """Parse words like ``pursuer=robot1/base_link``.

    Raises:
        ConfigurationError: If a word has another form, a name occurs twice,
            or there are fewer than two.
    """
    sources: dict[str, str] = {}
    for word in words:
        name, sign, source = word.partition("=")
        if not (sign and source and PLAYER_NAME.fullmatch(name)):
            raise ConfigurationError(
                "frame must be NAME=FRAME or NAME=/TOPIC with a name in "
                f"lower case, got {word!r:.80}"
            )
        if name in sources:
            raise ConfigurationError(f"frame of {name} must be given once")
        sources[name] = source
    if not 2 <= len(sources) <= MOST_PLAYERS:
        raise ConfigurationError(
            f"players of a bag must be 2 to {MOST_PLAYERS}, each as --frame "
            f"NAME=FRAME, got {len(sources)}"
        )
    return sources


def import_experiment(bag: Path, words: tuple[str, ...]) -> Run:
    """Read a bag as a run.

    Samples are at the times of the first player's poses, as far as all
    players have poses; those of the others are interpolated.

    Args:
        bag: Folder of a ROS 2 bag, or a file of one.
        words: Players, as ``NAME=FRAME`` or ``NAME=/TOPIC``; at least two.

    Raises:
        ConfigurationError: If the bag lacks a frame or topic, the poses are
            not in one frame, or not at common times.
        ModuleNotFoundError: If rosbags is not installed.
    """
    sources = parse_sources(words)
    series = read_poses(bag, sources)
    worlds = {player: one.world for player, one in series.items()}
    if len(set(worlds.values())) > 1:
        found = ", ".join(f"{p} in {w}" for p, w in worlds.items())
        raise ConfigurationError(
            f"poses of all players must be in one frame, got {found}"
        )
    first = next(iter(series.values()))
    begin = max(one.times[0] for one in series.values())
    end = min(one.times[-1] for one in series.values())
    inside = (first.times >= begin) & (first.times <= end)
    times = first.times[inside]
    if len(times) < 2:
        raise ConfigurationError(
            f"players of {bag.name} must have poses at common times, got "
            + ", ".join(
                f"{p} from {one.times[0]:.1f} to {one.times[-1]:.1f} s"
                for p, one in series.items()
            )
        )
    tracks = {p: _sampled(one, times) for p, one in series.items()}
    elapsed = times - times[0]
    check_record(elapsed, tracks, bag.name)
    run = Run(
        name=bag.stem or bag.name,
        settings=ExperimentSettings(
            source=bag.name, frames=words, world=first.world
        ),
        outcome=Outcome.COMPLETED,
        message=f"recorded {elapsed[-1]:.2f} s in {first.world}",
        duration=round(float(elapsed[-1]), 9),
        times=elapsed,
        tracks=tracks,
    )
    notes = []
    for player, one in series.items():
        ends = [begin], np.clip(one.times, begin, end), [end]
        gap = float(np.diff(np.concatenate(ends)).max())
        if gap > NOTED_GAP:
            notes.append(f"{player} has no pose for {gap:.2f} s; interpolated")
        if one.invalid:
            notes.append(f"{player} has {one.invalid} invalid poses; left out")
    return replace(run, summary=replace(measure(run), notes=notes))


def _sampled(series: PoseSeries, times: Array) -> Trajectory:
    """Return the poses at times, linearly interpolated."""
    x, y, z, heading = (
        np.interp(times, series.times, column)
        for column in (*series.positions.T, series.headings)
    )
    return Trajectory(
        com=np.column_stack([x, y, z]),
        torso=np.column_stack([x, y, heading]),
    )
