"""Test the stabiliser with a fake state estimator."""

from math import exp

import numpy as np
import pytest

from synthetic_state import (
    BODY,
    COM,
    DCM,
    ETA,
    MEASUREMENT,
    ROW,
    TICK,
    ZERO,
    same,
    stabiliser,
    step,
)


def test_without_errors_the_plan_is_unchanged() -> None:
    feedback, _ = stabiliser()
    for _ in range(20):
        assert feedback.update(MEASUREMENT, ROW, step()) == BODY
    assert feedback.com_shift == feedback.dcm_shift == ZERO
    assert feedback.zmp_shift == feedback.step_shift == ZERO


def test_beyond_the_dead_zone_the_reference_follows_the_error() -> None:
    """By 5/s of the error, and the pendulum runs on with the ZMP's shift."""
    feedback, fake = stabiliser()
    fake.off_dcm, fake.off_com = (0.025, 0.0), (0.0, -0.0175)
    body = feedback.update(MEASUREMENT, ROW, step())
    gave = 5.0 * TICK * 0.01
    zmp = np.array([4.0 * gave, 0.0])
    same(feedback.zmp_shift, zmp)
    dcm = zmp + exp(ETA * TICK) * (np.array([gave, 0.0]) - zmp)
    same(feedback.dcm_shift, dcm)
    com = np.array([0.0, -gave])
    com = com + TICK * ETA * (dcm - com)
    same(feedback.com_shift, com)
    same(body.com, (COM[0] + com[0], COM[1] + com[1], 0.27))


def test_a_shift_is_brought_back_by_the_zmp() -> None:
    """With xi' = eta (xi - 4 xi) it fades, and the CoM follows."""
    feedback, fake = stabiliser()
    feedback.dcm_shift, feedback.com_shift = (0.003, -0.002), (0.001, 0.001)
    for ticks in range(1, 200):
        fake.off_dcm, fake.off_com = feedback.dcm_shift, feedback.com_shift
        feedback.update(MEASUREMENT, ROW, step())
        if ticks == 25:
            fade = (4.0 - 3.0 * exp(ETA * TICK)) ** 25
            same(feedback.dcm_shift, (0.003 * fade, -0.002 * fade))
            assert fade == pytest.approx(exp(-3.0 * ETA * 25 * TICK), rel=0.1)
    assert np.abs(feedback.dcm_shift).max() < 1e-6
    assert np.abs(feedback.com_shift).max() < 1e-4


@pytest.mark.parametrize("late", [0, 1, 3])
def test_the_estimator_gets_the_delayed_command(late: int) -> None:
    feedback, fake = stabiliser(delay=late * TICK)
    for i in range(8):
        x = COM[0] + 0.1 * i
        row = ROW._replace(
            body=BODY._replace(com=(x, COM[1], 0.27)),
            dcm=(DCM[0] + 0.1 * i, DCM[1]),
        )
        seen = 0.1 * max(i - late, 0)
        fake.off_com = fake.off_dcm = (seen, 0.0)
        feedback.update(MEASUREMENT, row, step())
        same(fake.told[i][0].com[0], COM[0] + seen)
        same(feedback.error, ZERO)
        same(feedback.com_error, ZERO)


def test_feet_tilt_with_the_torso() -> None:
    feedback, fake = stabiliser()
    fake.tilt = (0.1, -0.2)
    body = feedback.update(MEASUREMENT, ROW, step())
    part = 0.3 * 50.0 * TICK
    same(body.left_tilt, (0.1 * part, -0.2 * part))
    same(body.right_tilt, body.left_tilt)
    feedback, fake = stabiliser()
    fake.tilt, fake.left_share = (0.1, -0.2), 0.25
    body = feedback.update(MEASUREMENT, ROW, step())
    same(body.right_tilt, (0.1 * part, -0.2 * part))
    same(body.left_tilt, (0.05 * part, -0.1 * part))


def test_a_commanded_lean_tilts_no_foot() -> None:
    meant = BODY.roll(0.1)
    assert abs(meant) > 0.01
    tilts = {}
    for lean in (0.1, 0.0):
        feedback, fake = stabiliser(lean=lean)
        fake.tilt = (meant, 0.0)
        for _ in range(400):  # until the onset has passed
            body = feedback.update(MEASUREMENT, ROW, step())
        tilts[lean] = body.left_tilt
    same(tilts[0.1], ZERO)
    same(tilts[0.0], (0.3 * meant, 0.0))


def test_an_error_beyond_the_sole_moves_the_landing() -> None:
    """No faster than a swing foot can follow: 1.5 m/s."""
    for sign in (1.0, -1.0):
        feedback, fake = stabiliser()
        fake.off_dcm = step().from_support(sign * 0.2, sign * 0.2)
        feedback.update(MEASUREMENT, ROW, step())
        reach = sign * 1.5 * TICK
        same(feedback.step_shift, np.clip(feedback.step_shift, -0.006, 0.006))
        assert np.abs(feedback.step_shift).max() == pytest.approx(abs(reach))
        for _ in range(100):
            feedback.update(MEASUREMENT, ROW, step())
        x, y = step().to_support(*feedback.step_shift)
        place = (0.08, 0.12) if sign > 0 else (-0.08, 0.082)
        assert (0.04 + x, 0.1 + y) == pytest.approx(place)
