"""Test that each column of a record has its own values."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fake_robot import FIRST, STEP, Run
from stepaside.core.poses import Array
from stepaside.drivers.play_log import PlayLog, PlayTick, joint_row
from stepaside.drivers.safety import SafetyState
from stepaside.drivers.velocity_loop import DrivingState
from stepaside.games.play_conversion import (
    opponent_trajectory,
    run_of_play,
    sight_table,
    sightings_in,
)
from stepaside.games.play_rows import PlayedRows
from stepaside.games.play_settings import PlaySettings
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import Foot
from velocity_fakes import read_log


def measured(time: float, seed: int) -> RobotState:
    """Readings of which no two are the same."""
    random = np.random.default_rng(seed)
    return RobotState(
        time,
        random.normal(size=4),
        random.normal(size=3),
        random.normal(size=3),
        random.normal(size=8),
        None,
    )


def test_every_column_has_its_values(tmp_path: Path) -> None:
    """Sensors do not swap, and measured is not commanded."""
    run, log = Run(), PlayLog(tmp_path / "play", {})
    ticks = []
    for i, time in enumerate((FIRST - 0.2, FIRST + 0.1, FIRST + STEP + 0.1)):
        scheme, told = run.until(time), measured(time, i)
        made = SimpleNamespace(
            locomotion=scheme, phase=scheme.phase, pose=scheme.pose
        )
        targets = np.arange(4.0) + 10.0 * i
        row = joint_row(told, targets, made, 1 + i, run.steps[-1])  # type: ignore[arg-type]
        seen = Sighting(time - 0.05, 0.3 + i, 1.2 + i)
        state = SafetyState.WALKING
        log.note(PlayTick(state, "chest button", time, seen, "", row))
        ticks.append((told, targets, seen, scheme.state, run.steps[-1]))
    log.close()
    rows = read_log(tmp_path / "play")
    for i, (told, targets, seen, walk, begun) in enumerate(ticks):
        assert walk is not None
        for name in (
            *("joint_positions", "gyro", "accelerometer", "foot_forces"),
        ):
            np.testing.assert_array_equal(rows[name][i], getattr(told, name))
        np.testing.assert_array_equal(rows["targets"][i], targets)
        assert rows["times_s"][i] == told.time
        assert rows["sighting"][i].tolist() == list(seen[:3])
        assert rows["mind"][i] == 1 + i
        assert rows["com_reference"][i].tolist() == [*walk.reference.com[:2]]
        assert rows["zmp_reference"][i].tolist() == [*walk.zmp_reference]
        step = walk.step(told.time)
        side = 1.0 if step.swing is Foot.RIGHT else -1.0
        assert rows["support"][i].tolist() == [*step.support, side]
        side = 1.0 if begun.foot is Foot.LEFT else -1.0
        assert rows["begun"][i].tolist() == [
            *(begun.landing_time, side, *begun.landing, begun.planning_time),
        ]


@pytest.mark.parametrize("late", [0.0, 0.2, 0.5])
@pytest.mark.parametrize("began", [0.0, 40.0])
def test_a_standing_player_is_recorded_where_it_stands(
    late: float, began: float
) -> None:
    """However late, by a robot that walks and turns, on its own clock."""
    times: Array = 0.02 * np.arange(300, dtype=np.float64)
    own = np.column_stack(
        [0.1 * times, np.sin(0.3 * times), 0.6 * times + 2.0]
    )
    other = 2.0, -1.0
    taken = np.floor(times / 0.1) * 0.1 - late
    there = np.array([np.interp(taken, times, c) for c in own.T]).T
    x, y = other[0] - there[:, 0], other[1] - there[:, 1]
    seen = np.column_stack(
        [taken + began, np.arctan2(y, x) - there[:, 2], np.hypot(x, y)]
    )
    seen[taken < 0.0] = np.nan
    seen[200:220] = np.nan
    columns = {"times_s": times + began, "sighting": seen}
    found = sightings_in(PlayedRows(columns, times, ()))
    track = opponent_trajectory(found, times, own)
    assert track is not None
    np.testing.assert_allclose(
        track.torso[:, :2], np.broadcast_to(other, (300, 2)), atol=2e-3
    )
    known = found[~np.isnan(found[:, 1])]
    delays = known[:, 0] - known[:, 1]
    assert delays.max() == pytest.approx(late, abs=0.021)
    table = sight_table(found)
    assert table[:, 5].sum() == 1.0 and table.shape[1] == 6
    np.testing.assert_array_equal(table[:, 1:3], found[:, 2:])


def test_the_summary_covers_only_the_walk(
    tmp_path: Path,
) -> None:
    """Way and circle in metres, shares of the time that it walked."""
    log, radius, period = PlayLog(tmp_path / "play", {}), 0.5, 0.05
    for i in range(1200):
        now = period * i
        walking = 200 <= i < 1000
        angle = 0.2 * period * min(max(i - 200, 0), 800)
        seen = i < 200 or i % 4 == 0 or i >= 1000
        state = DrivingState.WALKING if walking else DrivingState.STANDING
        row: Any = {
            "pose": np.array([*radius * np.array([np.sin(angle),
                              -np.cos(angle)]), angle]),
            "wanted": np.array([0.1, 0.2, 0.0]),
            "velocity": np.array([0.1, 0.2, 0.0]),
        }  # fmt: skip
        near = Sighting(now, 0.3, 1.5 if walking else 0.9) if seen else None
        log.note(PlayTick(state, "opponent detected", now, near, "", row))
    log.close()
    run = run_of_play(tmp_path / "play", PlaySettings())
    found = run.summary
    assert found.walking_s == pytest.approx(800 * period)
    assert run.duration == pytest.approx(1199 * period)
    assert found.sighted_share == pytest.approx(0.25, abs=0.01)
    assert found.radius_m == pytest.approx(radius, abs=1e-3)
    assert found.path_length_m == pytest.approx(8.0 * radius, rel=0.02)
    assert found.closest_m == pytest.approx(0.9)
    assert found.distance_m == pytest.approx(1.5, abs=0.05)
    assert found.steps is None and found.plan_time_us is None
    assert [c.time_s for c in found.changes] == pytest.approx([0, 10, 50])
