"""Test the signals of a game that is played again."""

from dataclasses import replace

import numpy as np
import pytest

from stepaside.core.constants import GRAVITY
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.recorded_game import run_duel, run_walk
from stepaside.games.replayed_signals import RobotSignals, repeat_game
from stepaside.games.run import DuelRun, Run, WalkRun
from stepaside.games.walk_settings import WALKER, WalkSettings
from stepaside.robots.description import load_robot


@pytest.fixture(scope="module")
def walk() -> WalkRun:
    return run_walk(WalkSettings(duration=4.0))


@pytest.fixture(scope="module")
def signals(walk: WalkRun) -> RobotSignals:
    repeated = repeat_game(walk)
    assert repeated.reason == ""
    return repeated.robots[WALKER]


@pytest.fixture(scope="module")
def duel() -> DuelRun:
    start = StartSettings(distance=0.9, pursuer_offset=0.0, evader_offset=0.0)
    return run_duel(DuelSettings(duration=3.0, start=start))


def test_joint_velocities_are_the_rates_of_the_recorded_angles(
    walk: WalkRun, signals: RobotSignals
) -> None:
    assert walk.walker.qpos is not None
    assert signals.joint_velocity is not None
    angles = walk.walker.qpos[:, 7:].astype(float)
    period = walk.times[1] - walk.times[0]
    rates = (angles[2:] - angles[:-2]) / (2.0 * period)
    deviation = np.abs(rates - signals.joint_velocity[1:-1])
    # Angles are in single precision, and the rate is a mean over 40 ms.
    assert np.median(deviation) < 0.01
    walking = np.abs(rates) > 0.5
    assert walking.sum() > 100
    agree = np.sign(rates) == np.sign(signals.joint_velocity[1:-1])
    assert agree[walking].mean() > 0.99


def test_foot_forces_carry_the_weight_and_the_accelerometer_feels_it(
    signals: RobotSignals,
) -> None:
    model = load_robot("nao").compile()
    weight = GRAVITY * float(model.body_mass.sum())
    assert signals.foot_forces is not None
    assert signals.accelerometer is not None
    total = signals.foot_forces.sum(axis=1)[10:]
    assert total.mean() == pytest.approx(weight, rel=0.03)
    assert signals.accelerometer[10:, 2].mean() == pytest.approx(
        GRAVITY, rel=0.03
    )


def test_a_straight_knee_holds_against_the_weight(
    signals: RobotSignals, walk: WalkRun
) -> None:
    model = load_robot("nao").compile()
    knee = model.joint("LKneePitch").qposadr[0] - 7
    assert signals.joint_effort is not None
    standing = signals.joint_effort[walk.times < 0.5, knee][5:]
    # A bent knee that is loaded from above needs a torque that stretches it.
    assert (standing < -0.1).all()


def test_the_dcm_leads_the_com_by_its_velocity(
    walk: WalkRun, signals: RobotSignals
) -> None:
    assert signals.dcm is not None and signals.com_velocity is not None
    eta = walk.settings.gait.eta
    lead = eta * (signals.dcm - walk.walker.com[:, :2])
    np.testing.assert_allclose(lead, signals.com_velocity, atol=1e-12)
    assert walk.walker.velocity is not None
    np.testing.assert_array_equal(signals.com_velocity, walk.walker.velocity)


def test_first_footstep_of_each_plan_is_the_recorded_landing(
    walk: WalkRun, signals: RobotSignals
) -> None:
    landings = walk.walker.landings
    assert landings is not None and len(landings) == len(signals.plans) > 4
    for landing, plan in zip(landings, signals.plans, strict=True):
        np.testing.assert_allclose(plan.footsteps[0], landing[1:], atol=1e-12)
    assert [p.phase for p in signals.phases][:2] == ["standing", "walking"]


def test_a_game_that_differs_gives_no_signals_but_a_reason(
    duel: DuelRun,
) -> None:
    track = duel.evader
    assert track.qpos is not None
    qpos = track.qpos.copy()
    qpos[50, 20] += 1e-6
    changed: Run = replace(
        duel,
        tracks={**duel.tracks, "evader": replace(track, qpos=qpos)},
    )
    repeated = repeat_game(changed)
    assert not repeated.robots
    assert "evader moved differently" in repeated.reason


def test_joints_follow_their_targets(
    walk: WalkRun, signals: RobotSignals
) -> None:
    targets = signals.joint_targets
    assert targets is not None and walk.walker.qpos is not None
    names = signals.target_names
    assert targets.shape == (len(walk.times), len(names))
    model = load_robot("nao").compile()
    columns = [model.joint(name).qposadr[0] for name in names]
    angles = walk.walker.qpos[:, columns]
    # Ideal joints are where they were sent a tick of 4 ms before.
    aligned = np.abs(angles - targets).mean()
    assert aligned < 0.004
    assert np.abs(angles[1:] - targets[:-1]).mean() > 2.0 * aligned
