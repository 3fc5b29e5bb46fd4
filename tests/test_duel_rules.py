"""How a duel begins, is counted and ends; and one with honest bodies."""

from collections.abc import Iterator
from functools import cache
from math import pi
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.control import ControlScheme, Phase
from stepaside.control.balance.settings import STABILISED
from stepaside.games import duel as module
from stepaside.games.duel import Duel, DuelResult, Outcome, Progress, run_duel
from stepaside.games.settings import (
    DuelSettings,
    StartSettings,
    StrategySettings,
)
from stepaside.world.body_settings import BODIES
from stepaside.world.camera_settings import RoomSettings, Thing
from stepaside.world.robot import SimulatedRobot
from stepaside.world.servos import HonestServos
from stepaside.world.settings import SightSettings

START = StartSettings(1.3, 0.4, -0.2)


def begun(**changes: Any) -> Duel:
    return Duel(DuelSettings(**{"start": START, **changes}))


def test_robots_stand_where_the_start_says() -> None:
    duel = begun()
    pursuer, evader = (robot.truth for robot in duel.robots)
    assert [robot.name for robot in duel.robots] == ["pursuer", "evader"]
    assert duel.distance == pytest.approx(1.3, abs=0.03)
    assert pursuer.heading == pytest.approx(0.4)
    assert abs(evader.heading) == pytest.approx(pi - 0.2)
    np.testing.assert_allclose(pursuer.position, [0.0, 0.0], atol=0.02)
    np.testing.assert_allclose(evader.position, [1.3, 0.0], atol=0.02)
    assert duel.settings.start == START
    assert duel.min_distance == duel.distance
    assert duel.triggered_at is None and duel.triggered_distance is None


def test_roles_and_sight_belong_to_their_robots() -> None:
    strategy = StrategySettings(angle=0.4, safety_radius=0.7)
    duel = begun(strategy=strategy)
    assert duel.schemes[1].role == strategy.role()
    assert type(duel.schemes[0].role).__name__ == "Pursuit"
    for own, bearing in ((0, -0.4), (1, 0.2)):
        sighting = duel.robots[own].read().sighting
        assert sighting is not None
        assert sighting.bearing == pytest.approx(bearing, abs=0.02)
    noisy = begun(sight=SightSettings(bearing_noise=0.1))
    seen = [robot.read().sighting for robot in noisy.robots]
    offs = [s.bearing - b for s, b in zip(seen, (-0.4, 0.2), strict=True) if s]
    assert abs(offs[0] - offs[1]) > 1e-3  # draws of their own


def lay_down(duel: Duel, number: int) -> None:
    robot = duel.robots[number]
    at = robot.qpos_slice.start
    duel.world.data.qpos[at + 2] = 1.0
    duel.world.data.qpos[at + 3 : at + 7] = (0.5**0.5, 0.5**0.5, 0.0, 0.0)
    mujoco.mj_forward(duel.world.model, duel.world.data)


@pytest.mark.parametrize(
    ("fallen", "message"),
    [
        ((0,), "pursuer fell at 0.02 s"),
        ((1,), "evader fell at 0.02 s"),
        ((0, 1), "pursuer and evader fell at 0.02 s"),
    ],
)
def test_a_fall_ends_a_duel_and_is_told(
    monkeypatch: pytest.MonkeyPatch, fallen: tuple[int, ...], message: str
) -> None:
    tick = Duel.tick

    def clumsy(duel: Duel) -> Outcome | None:
        if duel.world.ticks == 4:
            for number in fallen:
                lay_down(duel, number)
        return tick(duel)

    monkeypatch.setattr(Duel, "tick", clumsy)
    result = run_duel(DuelSettings(start=START, duration=1.0))
    assert result.outcome is Outcome.FALL and result.message == message
    assert result.duration == pytest.approx(0.02)
    assert result.arrays["times_s"][-1] == result.duration


def touching(distance: float, **changes: Any) -> tuple[Any, str]:
    """Outcome where bodies are in contact at a distance, and its words."""
    duel = begun(start=StartSettings(distance, 0.0, 0.0), **changes)
    world: Any = duel.world
    world.robots_touch = lambda: True
    outcome = duel.tick()
    return outcome, "" if outcome is None else module._message(duel, outcome)


def test_contact_is_looked_for_where_there_can_be_any() -> None:
    """Robots two arm spans apart cannot touch each other, only things."""
    assert touching(0.6) == (
        Outcome.CONTACT,
        "the robots touched at 0.00 s",
    )
    assert touching(0.9)[0] is None
    room = RoomSettings(things=[Thing("red box", 3.0, 0.0)])
    assert touching(0.9, room=room) == (
        Outcome.CONTACT,
        "robot, thing touched at 0.00 s",
    )
    assert touching(0.6, pursuer="person") == (
        Outcome.CONTACT,
        "person and robot touched at 0.00 s",
    )


def test_without_contact_a_near_duel_goes_on() -> None:
    duel = begun(start=StartSettings(0.6, 0.0, 0.0))
    assert duel.tick() is None


def test_a_duel_notes_its_closest_and_when_the_evader_began() -> None:
    duel = begun()
    ways = iter((1.0, 0.9, 0.95, 0.85))
    kind = type(duel)
    phases = iter((Phase.STANDING, Phase.STANDING, Phase.WALKING, None))

    class Told(kind):  # type: ignore[valid-type, misc]
        @property
        def distance(self) -> float:
            scheme = self.schemes[1]
            phase = next(phases)
            if phase is not None:
                scheme.phase = phase
            return next(ways)

    duel.__class__ = Told
    for robot, scheme in zip(duel.robots, duel.schemes, strict=True):
        robot.step = robot.world.advance  # type: ignore[method-assign]
        scheme.update = lambda measured, s=scheme: s.joint_targets  # type: ignore
    duel.min_distance = 5.0
    closest = []
    for _ in range(4):
        duel.tick()
        closest.append(duel.min_distance)
    assert closest == [1.0, 0.9, 0.9, 0.85]
    assert duel.triggered_at == pytest.approx(0.012)
    assert duel.triggered_distance == 0.95


@pytest.mark.parametrize(
    ("duration", "ticks"), [(0.04, 10), (0.0399, 10), (0.0401, 11)]
)
def test_a_duel_lasts_as_long_as_asked(duration: float, ticks: int) -> None:
    result = run_duel(DuelSettings(start=START, duration=duration))
    assert result.outcome is Outcome.COMPLETED
    assert result.duration == pytest.approx(0.004 * ticks)
    assert result.message == f"played {0.004 * ticks:.2f} s"
    samples = [*0.02 * np.arange((ticks - 1) // 5 + 1), 0.004 * ticks]
    np.testing.assert_allclose(result.arrays["times_s"], samples)
    # The pursuer plans at once; its first ZMP is midway between its feet.
    assert result.replans == 1 and result.planning_times.size == 1
    assert result.velocity_jump == 0.0
    assert result.sight is None and result.stills == {}
    assert result.min_distance == pytest.approx(1.3, abs=0.03)


def test_figures_of_both_robots_are_put_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(
        ControlScheme, "margins", property(lambda scheme: scheme.told)
    )

    def note(duel: Duel) -> Outcome:
        for number, scheme in enumerate(duel.schemes, start=1):
            told: Any = scheme
            told.replans = 10 * number
            told.planning_times = [0.1 * number, 0.2]
            told.velocity_jumps = [0.1, 0.3 - 0.1 * number, 0.0]
            told.told = [0.02 * number, 0.03]
        return Outcome.COMPLETED

    monkeypatch.setattr(Duel, "tick", note)
    result = run_duel(DuelSettings(start=START, duration=1.0))
    assert result.replans == 30
    np.testing.assert_allclose(result.planning_times, [0.1, 0.2, 0.2, 0.2])
    assert result.velocity_jump == pytest.approx(0.2)
    assert result.zmp_margin == 0.02


def test_who_never_walked_has_no_margin() -> None:
    result = run_duel(hardware(duration=0.1))
    assert result.zmp_margin is None and result.velocity_jump == 0.0
    assert result.replans == 0 and result.planning_times.size == 0


def clock(monkeypatch: pytest.MonkeyPatch, step: float) -> None:
    """A wall clock that moves on whenever somebody looks at it."""

    def ticking() -> Iterator[float]:
        now = 100.0
        while True:
            yield now
            now += step

    times = ticking()
    monkeypatch.setattr(module, "perf_counter", lambda: next(times))


def test_progress_is_told_at_most_five_times_a_second(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock(monkeypatch, 0.11)
    told: list[Progress] = []
    result = run_duel(DuelSettings(start=START, duration=0.5), told.append)
    # Looked at every 0.1 s of the duel; every other time 0.22 s have passed.
    np.testing.assert_allclose([p.time for p in told], [0.2, 0.4])
    assert told[0].real_time_factor == pytest.approx(0.2 / 0.22)
    assert told[1].real_time_factor == pytest.approx(0.4 / 0.44)
    assert told[0].distance == pytest.approx(1.3, abs=0.03)
    assert result.wall_time == pytest.approx(0.11 * 6)


def test_an_interrupted_duel_is_kept_and_its_robots_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    closed: list[str] = []
    monkeypatch.setattr(
        SimulatedRobot, "close", lambda robot: closed.append(robot.name)
    )
    clock(monkeypatch, 1.0)

    def interrupt(progress: Progress) -> None:
        raise KeyboardInterrupt

    result = run_duel(DuelSettings(start=START, duration=5.0), interrupt)
    assert result.outcome is Outcome.INTERRUPTED
    assert result.message == "interrupted at 0.10 s"
    assert result.duration == pytest.approx(0.1)
    assert closed == ["pursuer", "evader"]


def test_an_error_closes_the_robots_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    closed: list[str] = []
    monkeypatch.setattr(
        SimulatedRobot, "close", lambda robot: closed.append(robot.name)
    )

    def fail(duel: Duel) -> None:
        raise RuntimeError("a bolt came loose")

    monkeypatch.setattr(Duel, "tick", fail)
    with pytest.raises(RuntimeError, match="bolt"):
        run_duel(DuelSettings(start=START, duration=1.0))
    assert closed == ["pursuer", "evader"]


def hardware(**changes: Any) -> DuelSettings:
    return DuelSettings(
        **{
            "seed": 3,
            "duration": 12.0,
            "start": StartSettings(0.95, 0.3, -0.2),
            "body": BODIES["hardware"],
            "control": STABILISED,
            **changes,
        }
    )


def test_both_robots_of_a_hardware_duel_have_honest_bodies() -> None:
    duel = Duel(hardware())
    assert duel.world.physics.tick == 0.012
    masses = []
    for robot, scheme in zip(duel.robots, duel.schemes, strict=True):
        assert isinstance(robot.servos, HonestServos)
        assert scheme.stabiliser is not None
        assert scheme.stabiliser.settings == STABILISED
        torso = duel.world.model.body(f"{robot.name}/torso").id
        masses.append(duel.world.model.body_mass[torso])
        readings = [robot.read() for _ in range(3)]
        # Noise differs from reading to reading, encoders are coarse.
        assert np.abs(readings[0].gyro - readings[2].gyro).max() > 0.0
        steps = readings[0].joint_positions / (2.0 * pi / 4096)
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
    assert masses[0] != masses[1]


@cache
def hardware_duel() -> DuelResult:
    return run_duel(hardware())


def test_hardware_robots_play_the_game_with_feedback() -> None:
    """One comes, the other steps aside and turns away; nobody falls."""
    result = hardware_duel()
    assert result.outcome is Outcome.COMPLETED
    assert result.duration == pytest.approx(12.0)
    arrays = result.arrays
    times = arrays["times_s"]
    np.testing.assert_allclose(np.diff(times)[:-1], 0.024)
    for name, values in arrays.items():
        # Only the ZMP is not there at times, before the first step.
        assert np.isfinite(values).mean() > 0.99, name
    apart = arrays["evader_torso"] - arrays["pursuer_torso"]
    distance = np.hypot(apart[:, 0], apart[:, 1])
    at, began = result.triggered_at, result.triggered_distance
    assert at is not None and began is not None
    assert 0.78 < began < 0.8
    assert distance[times < at - 0.02].min() > 0.8 - 1e-3
    assert result.min_distance == pytest.approx(distance.min(), abs=2e-3)
    assert 0.5 < result.min_distance < 0.8
    stood = arrays["evader_com"][times < at - 0.02, :2]
    assert np.abs(stood - stood[0]).max() < 0.01
    heights = np.concatenate(
        [arrays["pursuer_com"][:, 2], arrays["evader_com"][:, 2]]
    )
    assert heights.min() > 0.26 and heights.max() < 0.275
    fled = arrays["evader_torso"][-1] - arrays["evader_torso"][0]
    assert np.hypot(*fled[:2]) > 0.2 and abs(fled[2]) > 0.4
    assert result.velocity_jump < 1e-9
    assert result.zmp_margin is not None and result.zmp_margin > 0.02


@pytest.mark.parametrize("name", ["pursuer", "evader"])
def test_hardware_robots_walk_where_their_footsteps_are(name: str) -> None:
    """Torso against the middle of the last two footsteps, in the world."""
    result = hardware_duel()
    arrays = result.arrays
    landings = arrays[f"{name}_landings"]
    done = landings[landings[:, 0] < 12.0]
    assert len(done) > 8
    # Feet land in turn, one gait apart.
    np.testing.assert_array_equal(done[1:, 1], -done[:-1, 1])
    step = result.settings.gait.step_duration
    np.testing.assert_allclose(np.diff(done[1:, 0]), step, atol=0.013)
    middle = 0.5 * (done[1:, 2:4] + done[:-1, 2:4])
    walked = np.array(
        [
            np.interp(done[1:, 0], arrays["times_s"], column)
            for column in arrays[f"{name}_torso"][:, :2].T
        ]
    ).T
    assert np.hypot(*(middle[-1] - middle[0])) > 0.15
    assert np.hypot(*(walked - middle).T).max() < 0.05


def test_hardware_bodies_and_their_errors_come_from_the_seed() -> None:
    first = run_duel(hardware(duration=1.5)).arrays
    again = run_duel(hardware(duration=1.5)).arrays
    other = run_duel(hardware(duration=1.5, seed=4)).arrays
    for name, values in first.items():
        np.testing.assert_array_equal(values, again[name])
    off = first["pursuer_qpos"][-1] - other["pursuer_qpos"][-1]
    assert np.abs(off).max() > 1e-4
