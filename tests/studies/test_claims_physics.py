"""Test the claims in physics: every row is red under a fault."""

from collections.abc import Callable, Mapping, Sized
from dataclasses import replace
from math import isnan, radians

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games import DuelSettings, run_duel
from stepaside.games.duel_settings import PLAYERS
from stepaside.games.outcome import Outcome
from stepaside.studies import physics_readings as read
from stepaside.studies import walk_measures
from stepaside.studies.claim_jobs import JOBS
from stepaside.studies.claims import Claim, Readings
from stepaside.studies.walk_measures import swings
from stepaside.studies.watched_duel import WalkedPlan, WatchedDuel, watch
from watched import RADIUS, changed, standing_duel, walked_duel

Fault = Callable[[WatchedDuel], WatchedDuel]


def claims(job: str) -> dict[str, Claim]:
    return {claim.key: claim for claim in JOBS[job].claims}


# --- the duel of Fig. 5 ---------------------------------------------------


def far_until_late(duel: WatchedDuel) -> WatchedDuel:
    """They come to the circle at the very end only."""
    late = duel.times < 27.0
    return changed(
        duel, evader_torso=lambda t: t * np.where(late, 2, 1)[:, None]
    )


def later_plans(by: float) -> Fault:
    """Let the evader replace its plans at another time."""

    def fault(duel: WatchedDuel) -> WatchedDuel:
        walked = duel.plans["evader"]
        later = tuple(plan._replace(sent=plan.sent + by) for plan in walked)
        return replace(duel, plans={**duel.plans, "evader": later})

    return fault


def seldom_plans(duel: WatchedDuel) -> WatchedDuel:
    """Plans are walked for fifteen steps, well onto the straight part."""
    plans = {name: walked[::15] for name, walked in duel.plans.items()}
    return replace(duel, plans=plans)


def one_long_plan(duel: WatchedDuel) -> WatchedDuel:
    """One plan only is walked well onto the straight part."""
    walked = duel.plans["evader"]
    plans = {**duel.plans, "evader": walked[:5] + walked[20:]}
    return replace(duel, plans=plans)


def from_a_plan_on(change: Callable[[Array], Array]) -> Fault:
    """Change the evader's reference from one of its plans on."""

    def fault(duel: WatchedDuel) -> WatchedDuel:
        started = duel.plans["evader"][7].started
        since = np.maximum(duel.ticks - started, 0.0)[:, None]
        moved = duel.references["evader"] + change(since)
        return replace(duel, references={**duel.references, "evader": moved})

    return fault


def feet_of(change: Callable[[Array], Array]) -> Fault:
    """Change what the evader's feet bear."""

    def fault(duel: WatchedDuel) -> WatchedDuel:
        loads = change(duel.loads["evader"].copy())
        return replace(duel, loads={**duel.loads, "evader": loads})

    return fault


def evader_stands(duel: WatchedDuel) -> WatchedDuel:
    """Only the pursuer walks."""
    still = standing_duel()
    return replace(
        duel,
        loads={**duel.loads, "evader": still.loads["evader"]},
        plans={**duel.plans, "evader": ()},
    )


def limping(loads: Array) -> Array:
    """Hold the left foot up for another 0.1 s at each step."""
    air = loads[:, 0] == 0.0
    for shift in range(1, 26):
        loads[shift:, 0][air[:-shift]] = 0.0
    return loads


CIRCLE: dict[str, tuple[Fault, ...]] = {
    "settled": (far_until_late,),
    "pursuer_radius": (
        lambda d: changed(d, pursuer_torso=lambda t: t * (1.05, 1.05, 1.0)),
        lambda d: changed(d, pursuer_torso=lambda t: t * (0.95, 0.95, 1.0)),
        lambda d: changed(d, pursuer_torso=lambda t: t * (0.0, 0.0, 1.0)),
    ),
    "evader_radius": (
        lambda d: changed(d, evader_torso=lambda t: t * (1.05, 1.05, 1.0)),
        lambda d: changed(d, evader_torso=lambda t: t * (0.2, 0.2, 1.0)),
    ),
    "one_circle": (
        lambda d: changed(d, evader_torso=lambda t: t + (0.03, 0.03, 0.0)),
    ),
    "distance": (
        lambda d: changed(d, evader_torso=lambda t: 1.2 * t),
        lambda d: changed(d, evader_torso=lambda t: 0.8 * t),
    ),
    "orientation": (
        lambda d: changed(d, evader_torso=lambda t: t + (0, 0, 0.1)),
        lambda d: changed(d, evader_torso=lambda t: t - (0, 0, 0.1)),
        lambda d: changed(d, evader_torso=lambda t: t * (1, 1, -1)),
    ),
    "same_speed": (
        lambda d: changed(d, evader_torso=lambda t: 0.9 * t),
        lambda d: changed(d, evader_torso=lambda t: 0.0 * t),
        lambda _: standing_duel(),
    ),
    "landings": (
        feet_of(limping),
        feet_of(lambda loads: 0.0 * loads + 26.0),
        feet_of(lambda loads: 0.0 * loads),
        evader_stands,
    ),
    "both_feet": (
        later_plans(0.15),
        later_plans(-0.2),
        lambda d: replace(
            d, plans={name: p[::2] for name, p in d.plans.items()}
        ),
        evader_stands,
    ),
    "at_its_end": (later_plans(-0.08), evader_stands),
    "straight_part": (seldom_plans, one_long_plan, evader_stands),
    "place_jump": (
        from_a_plan_on(lambda t: np.where(t > 0.0, 1e-6, 0.0)),
        evader_stands,
    ),
    "velocity_jump": (
        from_a_plan_on(lambda t: 1e-4 * t),
        evader_stands,
    ),
}


@pytest.mark.parametrize("key", claims("humanoids"))
def test_every_claim_on_the_circle_holds_and_fails(key: str) -> None:
    claim = claims("humanoids")[key]
    duel = walked_duel()
    assert claim.holds([read.read_circle(duel)[key]])
    for fault in CIRCLE[key]:
        assert not claim.holds([read.read_circle(fault(duel))[key]])


@pytest.mark.parametrize("outcome", [Outcome.FALL, Outcome.CONTACT])
def test_who_falls_or_touches_is_on_no_circle(outcome: Outcome) -> None:
    found = read.read_circle(walked_duel(outcome=outcome))
    for key in ("settled", "pursuer_radius", "distance", "orientation"):
        assert isnan(found[key])


# --- the durations --------------------------------------------------------


def tosses(tilt: float = radians(6.0), slide: float = 0.02) -> WatchedDuel:
    """Feet that are dragged, and a torso that tosses."""
    return walked_duel(tilt=tilt, slide=slide)


def falls(tilt: float = radians(50.0), duration: float = 4.0) -> WatchedDuel:
    return walked_duel(duration, outcome=Outcome.FALL, tilt=tilt)


Duels = tuple[WatchedDuel, ...]
TOSSES: dict[str, Duels] = {
    "printed_slide": (walked_duel(), tosses(slide=0.0015)),
    "printed_tilt": (walked_duel(), tosses(tilt=radians(2.9))),
}
WALKS: dict[str, Duels] = {
    "upright_for": (walked_duel(29.0), falls()),
    "tilt": (walked_duel(tilt=radians(12.0)), falls()),
    "distance": (
        standing_duel(),
        changed(walked_duel(), evader_torso=lambda t: 0.0 * t),
        walked_duel(speed=0.1),
    ),
    "speed": (
        standing_duel(),
        walked_duel(speed=0.1),
        changed(walked_duel(), evader_torso=lambda t: 0.9 * t),
    ),
}


@pytest.mark.parametrize("key", claims("durations"))
def test_every_claim_on_the_durations_holds_and_fails(key: str) -> None:
    claim = claims("durations")[key]

    def reading(printed: WatchedDuel, walked: WatchedDuel) -> float:
        return read.read_durations(printed, walked)[key]

    assert claim.holds([reading(tosses(), walked_duel())])
    faults = TOSSES.get(key, ()) + WALKS.get(key, ())
    assert faults
    for printed in TOSSES.get(key, ()):
        assert not claim.holds([reading(printed, walked_duel())])
    for walked in WALKS.get(key, ()):
        assert not claim.holds([reading(tosses(), walked)])


# --- the slippery floor ---------------------------------------------------

SLIPS = walked_duel(radius=0.9 * RADIUS, speed=0.06, slide=0.02)
NO_SLIP: dict[str, Duels] = {
    "slide": (walked_duel(radius=0.5, speed=0.06, slide=0.001),),
    "slower": (walked_duel(radius=0.5, speed=0.08, slide=0.02),),
    "smaller": (walked_duel(radius=0.7, speed=0.06, slide=0.02),),
}
ENDED = walked_duel(
    radius=0.5, speed=0.06, slide=0.02, outcome=Outcome.CONTACT
)
ONE_STANDS = (
    changed(SLIPS, pursuer_torso=lambda t: t * (0.0, 0.0, 1.0)),
    changed(SLIPS, evader_torso=lambda t: t * (0.0, 0.0, 1.0)),
)


@pytest.mark.parametrize("key", claims("slip"))
def test_every_claim_on_slip_holds_and_fails(key: str) -> None:
    claim, grip = claims("slip")[key], walked_duel()
    assert claim.holds([read.read_slip(grip, SLIPS)[key]])
    for fault in (*NO_SLIP[key], ENDED, standing_duel(), *ONE_STANDS):
        assert not claim.holds([read.read_slip(grip, fault)[key]])
    for fault in (ENDED, *ONE_STANDS):
        assert isnan(read.read_slip(fault, SLIPS)[key])


# --- measures -------------------------------------------------------------


def test_a_foot_that_bounces_has_not_swung() -> None:
    ticks = np.arange(500, dtype=np.float64) * 0.004
    load = np.full(500, 26.0)
    load[100:200] = 0.0
    load[210:230] = 0.0
    assert swings(ticks, load, 0.425).tolist() == [[ticks[100], ticks[200]]]


def test_a_foot_slides_by_what_it_moves_while_it_bears() -> None:
    for slide in (0.0, 0.005):
        found = walk_measures.mean_slide(walked_duel(slide=slide))
        assert found == pytest.approx(slide, abs=1e-12)


def test_share_of_the_arc_is_in_path_time_after_the_start_support() -> None:
    gait = DuelSettings().gait
    first = WalkedPlan(0.0, 0.0, True)
    second = WalkedPlan(1.347, 0.8 + 0.547, False)
    assert walk_measures.plan_share((first, second), gait) == pytest.approx(
        0.4 / 5.0
    )
    assert isnan(walk_measures.plan_share((first,), gait))


def test_jumps_are_found_in_their_size() -> None:
    fault = from_a_plan_on(lambda t: np.where(t > 0.0, 0.002, 0.0) + 0.03 * t)
    jump = walk_measures.reference_jumps(fault(walked_duel()), "evader")
    assert jump.place == pytest.approx(0.002, rel=1e-6)
    assert jump.velocity == pytest.approx(0.03, rel=1e-6)


# --- real duels, for a few seconds ----------------------------------------


def test_watching_changes_nothing() -> None:
    settings = DuelSettings(seed=5, duration=2.0)
    duel, watched = run_duel(settings), watch(settings)
    assert watched.outcome is duel.outcome
    assert watched.duration == duel.duration
    np.testing.assert_array_equal(watched.times, duel.times)
    assert set(watched.tracks) == set(duel.tracks) == set(PLAYERS)
    for name in PLAYERS:
        arrays = duel.tracks[name].arrays(name)
        found = watched.tracks[name].arrays(name)
        assert set(found) == set(arrays)
        for key, values in arrays.items():
            np.testing.assert_array_equal(found[key], values)
    for name in PLAYERS:  # one stands on its left foot as on its right one
        weight = watched.loads[name].sum(axis=1)[50:100].mean()
        assert weight == pytest.approx(5.3 * 9.81, rel=0.05)
        left, right = watched.feet[name][0]
        facing = duel.tracks[name].torso[0, 2]
        across = np.array([-np.sin(facing), np.cos(facing)])
        assert (left - right) @ across == pytest.approx(0.1, abs=1e-3)


def shortly(seconds: float) -> Callable[..., DuelSettings]:
    """Settings of a duel in which both walk at once, for a short time."""

    def settings(seed: int, *, slippery: bool = False) -> DuelSettings:
        short = read.walk_settings(seed, duration=seconds)
        if slippery:
            physics = replace(short.physics, friction=read.SLIPPERY)
            return replace(short, physics=physics)
        return short

    return settings


def holding(job: str, found: Readings) -> set[str]:
    assert set(found) == set(claims(job))
    return {k for k, c in claims(job).items() if c.holds([found[k]])}


def test_humanoids_walk_as_their_forces_and_references_tell(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(read, "circle_settings", shortly(5.0))
    replanning = {
        *("landings", "both_feet", "at_its_end"),
        *("straight_part", "place_jump", "velocity_jump"),
    }
    found = read.measure_humanoids(1)
    assert replanning <= holding("humanoids", found)


def test_as_printed_feet_are_dragged_and_exchanged_they_walk(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    right = read.walk_settings

    def settings(seed: int, preset: str) -> DuelSettings:
        return right(seed, preset, 6.0 if preset == "as-printed" else 4.0)

    monkeypatch.setattr(read, "walk_settings", settings)
    found = read.measure_durations(1)
    assert {"printed_slide", "printed_tilt", "tilt"} <= holding(
        "durations", found
    )
    assert found["upright_for"] == pytest.approx(4.0)


def test_on_a_slippery_floor_feet_slip_and_robots_are_slower(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(read, "slip_settings", shortly(5.0))
    assert {"slide", "slower"} <= holding("slip", read.measure_slip(1))


def test_settings_of_the_studies_are_what_they_say() -> None:
    grip, slip = (
        read.slip_settings(3, slippery=slippery) for slippery in (False, True)
    )
    assert (grip.physics.friction, slip.physics.friction) == (0.8, 0.05)
    assert replace(slip, physics=grip.physics) == grip
    printed, walks = (
        read.walk_settings(3, preset).gait for preset in ("as-printed", "nao")
    )
    assert (printed.single_support, printed.double_support) == (0.122, 0.425)
    assert (walks.single_support, walks.double_support) == (0.425, 0.122)
    assert set(PLAYERS) == {"pursuer", "evader"}


def test_they_have_settled_before_what_is_measured_of_them() -> None:
    """Radii and distance are those of the last third."""
    third = read.circle_settings(1).duration * 2.0 / 3.0
    assert claims("humanoids")["settled"].expected == third


def test_no_claim_in_physics_is_without_a_fault() -> None:
    faults: dict[str, Mapping[str, Sized]] = {
        "humanoids": CIRCLE,
        "durations": TOSSES | WALKS,
        "slip": NO_SLIP,
    }
    seeded = {name for name, job in JOBS.items() if job.seeded}
    # Those of games in rooms are in test_claims_evading.
    assert set(faults) == seeded - {"evading", "rooms"}
    for name, by_key in faults.items():
        assert set(by_key) == set(claims(name))
        assert all(by_key.values())
