"""Test a simulated robot with its controller."""

from typing import Any

import numpy as np

from stepaside.games import DuelSettings
from stepaside.games.game import play
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.walker import SimulatedPlayer
from stepaside.locomotion.zmp.control_settings import STABILISED

DURATION = 3.0


def test_a_walking_robot_measures_only_when_a_decision_is_due() -> None:
    """In open loop with exact sightings; the motion is the same."""
    readings, tracks = [], []
    for coasts in (True, False):
        duel = RecordedGame(DuelSettings(seed=3, duration=DURATION))
        pursuer = duel.in_physics.players[0]
        assert isinstance(pursuer, SimulatedPlayer)
        if not coasts:
            pursuer.scheme.coast = lambda now: None  # type: ignore[method-assign]
        robot: Any = pursuer.robot
        read, times = robot.read, list[float]()

        def note(read: Any = read, times: Any = times, **parts: bool) -> Any:
            measured = read(**parts)
            assert measured.gyro.size == 0  # nothing in the loop reads it
            times.append(measured.time)
            return measured

        robot.read = note
        play(duel)
        tracks.append(duel.run().tracks["pursuer"])
        readings.append(times)
    sparing, each = readings
    assert len(each) == round(DURATION / 0.004)
    walking = [time for time in sparing if time > 1.0]
    assert len(walking) < 0.05 * len(each)
    other = tracks[1].arrays("pursuer")
    for key, values in tracks[0].arrays("pursuer").items():
        np.testing.assert_array_equal(values, other[key], err_msg=key)


def test_feedback_reads_sightings_only_when_a_decision_is_due() -> None:
    """At each tick while standing; the motion is the same."""
    seen, tracks = [], []
    for sparing in (True, False):
        settings = DuelSettings(seed=3, duration=DURATION, control=STABILISED)
        duel = RecordedGame(settings)
        robot: Any = duel.in_physics.players[0].robot  # type: ignore[attr-defined]
        read, times = robot.read, list[float]()

        def note(
            read: Any = read,
            times: Any = times,
            always: bool = not sparing,
            *,
            sees: bool,
            feels: bool,
        ) -> Any:
            measured = read(sees=sees or always, feels=feels)
            if measured.sighting is not None:
                times.append(measured.time)
            return measured

        robot.read = note
        play(duel)
        tracks.append(duel.run().tracks["pursuer"])
        seen.append(times)
    assert len(seen[1]) == round(DURATION / 0.004)
    walking = [time for time in seen[0] if time > 2.0]
    assert 0 < len(walking) < 0.05 * len(seen[1])
    other = tracks[1].arrays("pursuer")
    for key, values in tracks[0].arrays("pursuer").items():
        np.testing.assert_array_equal(values, other[key], err_msg=key)
