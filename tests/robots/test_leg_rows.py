"""Test that rows of ticks have the bits of single ticks."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.locomotion.zmp.open_loop import LoadFeedforward
from stepaside.robots.description import load_robot
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics

NAO = load_robot("nao")
TICK = 0.004
TICKS = 150


def references(seed: int, jump: float) -> list[BodyReference]:
    """Random smooth references, and a jump that meets speed limits."""
    generator = np.random.default_rng(seed)
    time = TICK * np.arange(TICKS)[:, None]
    rates = generator.uniform(1.0, 6.0, 11)
    spans = np.array([0.01, 0.02, 0.003, *4 * [0.01], *4 * [0.01]])
    row = np.array(
        [0.02, 0.0, 0.26, 0.0, 0.05, 0.0, 0.1, 0.01, -0.05, 0.0, -0.05]
    )
    rows = row + spans * np.sin(rates * time) * generator.uniform(-1, 1, 11)
    rows[:, [5, 9]] = np.maximum(rows[:, [5, 9]], 0.0)
    rows[TICKS // 2 :, 0] += jump
    return [
        BodyReference(tuple(r[:3]), tuple(r[3:7]), tuple(r[7:]))
        for r in rows.tolist()
    ]


def legs() -> tuple[LegKinematics, LoadFeedforward]:
    kinematics = LegKinematics(NAO, tick=TICK)
    kinematics.stand(references(0, 0.0)[0])
    return kinematics, LoadFeedforward(kinematics, zmp_forward=0.01, tick=TICK)


def tick_by_tick(bodies: list[BodyReference], zmp: Array) -> list[Array]:
    kinematics, loads = legs()
    found = []
    for body, (x, y) in zip(bodies, zmp.tolist(), strict=True):
        targets = kinematics.track(body)
        found.append(targets + loads.added(body, (x, y)))
    return found


def row_by_row(
    bodies: list[BodyReference], zmp: Array, *, used: int
) -> list[Array]:
    """Return targets of blocks, of which only the first ticks are used."""
    kinematics, loads = legs()
    rows = np.array([body.row() for body in bodies])
    found: list[Array] = []
    while len(found) < len(bodies):
        at = slice(len(found), None)
        states = kinematics.track_rows(rows[at])
        offsets = loads.offset_rows(states.rows, rows[at], zmp[at])
        found += list((states.targets + offsets)[:used])
        kept = min(len(states.targets), used)
        kinematics.rewind(kept)
        loads.rewind(kept)
    return found


@pytest.mark.parametrize("used", [TICKS, 7])
@pytest.mark.parametrize(("seed", "jump"), [(1, 0.0), (2, 0.02), (3, -0.03)])
def test_rows_have_the_bits_of_single_ticks(
    seed: int, jump: float, used: int
) -> None:
    """Also where joint limits act, and after a return to an earlier tick."""
    bodies = references(seed, jump)
    generator = np.random.default_rng(seed)
    zmp = np.array([body.com[:2] for body in bodies])
    zmp += 0.01 * generator.standard_normal(zmp.shape)
    expected = tick_by_tick(bodies, zmp)
    found = row_by_row(bodies, zmp, used=used)
    np.testing.assert_array_equal(found, expected)
    speeds = np.abs(np.diff(found, axis=0)).max() / TICK
    assert (speeds > 6.0) == (jump != 0.0)  # a limit acts
