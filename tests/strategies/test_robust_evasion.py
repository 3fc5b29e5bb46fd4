"""Test the evader that does not know its opponent."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import atan2, cos, hypot, inf, pi, sin

import numpy as np
import pytest

from floor_duels import STEP, play_steps
from stepaside.arena import Disc, Room, RoomRecipe, generate_room
from stepaside.core.poses import Pose, wrap_angle
from stepaside.games import Outcome
from stepaside.strategies import (
    Knowledge,
    Limits,
    Pursuit,
    RobustEvasion,
    Strategy,
)
from stepaside.strategies.robust_evasion import (
    MODELS,
    ModelFit,
    RobustMemory,
    actions_of,
)
from stepaside.strategies.search.beam_search import BeamRules, beam_search
from stepaside.strategies.search.step_motion import (
    Objective,
    PursuerModel,
    StepRules,
    pair_of,
    pursuer_turn,
)

STEPS = StepRules(0.04, 0.08, 0.08 * pi)
LIMITS = Limits(0.1, 0.2, 0.04, 0.4)


def arena(seed: int) -> tuple[Room, tuple[Pose, Pose]]:
    room = generate_room(RoomRecipe(), seed)
    assert room.starts is not None
    return room, room.starts


@pytest.mark.parametrize("number", range(len(MODELS)))
def test_model_that_makes_the_steps_is_the_one_that_is_planned_against(
    number: int,
) -> None:
    *_, (_, memory) = decisions(RobustEvasion(20, 20), MODELS[number], 14)
    weights = memory.fit.weights()
    assert memory.assumed == (number,)
    assert weights[number] == 1.0 and weights.sum() < 1.01
    assert memory.fit.speed == pytest.approx(1.0, abs=1e-3)


@dataclass(frozen=True)
class World:
    """Frame in which a state is seen: mirrored, then turned.

    Attributes:
        side: -1 for the mirror image.
        angle: Angle by which the room is turned, in [rad].
    """

    side: float = 1.0
    angle: float = 0.0

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Return a point in this frame."""
        c, s = cos(self.angle), sin(self.angle)
        return c * x - s * self.side * y, s * x + c * self.side * y

    def known(self, state: tuple[float, ...], *, walks: bool) -> Knowledge:
        """Return knowledge of a state (x, y, theta, bearing, distance)."""
        x, y, theta, bearing, distance = state
        turned = wrap_angle(self.side * theta + self.angle)
        own = Pose(*self.point(x, y), turned)
        room = Room(3.0, 3.0, (Disc(*self.point(0.5, 0.4), 0.2),))
        return Knowledge(
            0.0, self.side * bearing, distance, LIMITS, pose_in_map=own,
            obstacles_in_map=room.solid_set,
            step_start_in_map=own if walks else None,
        )  # fmt: skip


def states(number: int, nearest: float) -> list[tuple[float, ...]]:
    """Return free states in the room of :class:`World`."""
    random = np.random.default_rng(1)
    found: list[tuple[float, ...]] = []
    walls = World().known((0.0, 0.0, 0.0, 0.0, 1.0), walks=False)
    while len(found) < number:
        low = [-1.2, -1.2, -pi, -pi, nearest]
        state = random.uniform(low, [1.2, 1.2, pi, pi, 0.9])
        if walls.obstacles_in_map.clearance(state[None, :2])[0] > 0.22:
            found.append(tuple(state.tolist()))
    return found


def test_decision_is_turned_and_mirrored_with_the_state() -> None:
    """Where two plans are equally good the order of the turns decides."""
    evader, same = RobustEvasion(10_000, 4), []
    for state in states(30, 0.5):
        intents = [
            evader.decide(world.known(state, walks=False), RobustMemory())[0]
            for world in (World(), World(angle=0.5 * pi), World(-1.0))
        ]
        headings = np.array([intent.heading for intent in intents])
        signs = np.array([1.0, 1.0, -1.0])
        same.append(np.abs(signs * headings - headings[0]) < 1e-6)
    assert np.mean(same, axis=0)[1] > 0.9
    assert np.mean(same, axis=0)[2] > 0.8


@pytest.mark.parametrize(("walks", "least"), [(False, 0.205), (True, 0.215)])
def test_plans_keep_a_margin_to_walls(walks: bool, least: float) -> None:
    """0.5 cm, and 1 cm for walkers; 0.4 cm of it are for turns."""
    evader, found = RobustEvasion(20, 30), []
    for state in states(60, 0.4):
        known = World().known(state, walks=walks)
        _, memory = evader.decide(known, RobustMemory())
        x, y, theta = known.pose_in_map
        pose, points = (x, y, theta), []
        for turn, speed in memory.moves:
            pose = Pose(*pose).along_arc(-0.04 * speed, turn)
            points.append(pose[:2])
        if points:
            found += known.obstacles_in_map.clearance(points).tolist()
    assert least - 0.004 < min(found) < least + 0.002


def sights_of_walkers(
    model: PursuerModel, sway: float, noise: float, seed: int = 0
) -> Iterator[tuple[ModelFit, tuple[float, float, float]]]:
    """Yield the fit and the true pose of a walking pursuer after each step.

    Both bodies sway to alternate sides; the evader zigzags away.
    """
    generator = np.random.default_rng(seed)
    pursuer, own, fit = (-0.9, 0.1, 0.4), (0.3, 0.5, 3.6), ModelFit()
    for n in range(40):
        side = sway if n % 2 else -sway
        x = pursuer[0] - side * sin(pursuer[2]) + side * sin(own[2])
        y = pursuer[1] + side * cos(pursuer[2]) - side * cos(own[2])
        x, y = np.array([x, y]) + noise * generator.normal(size=2)
        fit = fit.observe(n, Pose(*own), (x, y), STEPS, sways=True)
        yield fit, pursuer
        turn = pursuer_turn(pair_of(own, pursuer), model, STEPS)
        pursuer = Pose(*pursuer).along_arc(0.04, turn)
        own = Pose(*own).along_arc(-0.04, 0.2 if n % 16 < 8 else -0.2)


@pytest.mark.parametrize(
    ("number", "wrong"), [(0, {5, 6}), (3, {5, 6}), (5, {0, 6}), (6, {0, 5})]
)
def test_model_of_a_swaying_pursuer_stays_and_others_are_ruled_out(
    number: int, wrong: set[int]
) -> None:
    """With the sway of NAO, and an error of 1 mm, within 15 steps.

    Until then more dangerous models may take the places of the true one.
    """
    for seed in range(5):
        fits = [
            fit
            for fit, _ in sights_of_walkers(MODELS[number], 0.0125, 1e-3, seed)
        ]
        for fit in fits[15:]:
            assert number in fit.plausible()
            assert not wrong & set(fit.plausible())


def decisions(
    evader: RobustEvasion, model: PursuerModel, number: int
) -> Iterator[tuple[Knowledge, RobustMemory]]:
    """Yield knowledge and memory after each decision on an open floor."""
    pursuer, own = (-1.0, 0.1, 1.2), (0.4, -0.2, 2.0)
    memory = evader.begin()
    for n in range(number):
        x, y = pursuer[0] - own[0], pursuer[1] - own[1]
        bearing = wrap_angle(atan2(y, x) - own[2])
        known = Knowledge(
            0.4 * n, bearing, hypot(x, y), LIMITS, pose_in_map=Pose(*own)
        )
        intent, memory = evader.decide(known, memory)
        yield known, memory
        turn = pursuer_turn(pair_of(own, pursuer), model, STEPS)
        pursuer = Pose(*pursuer).along_arc(model.speed * 0.04, turn)
        turn = STEPS.share * intent.heading
        own = Pose(*own).along_arc(-0.04 * intent.speed_factor, turn)


def test_plan_is_searched_again_when_the_pursuer_departs_from_it() -> None:
    evader = RobustEvasion(20, 20)
    *_, (known, memory) = decisions(evader, MODELS[3], 24)
    assert len(memory.moves) < memory.planned
    behind = replace(known, time=9.6, bearing=pi, distance=0.4)
    _, after = evader.decide(behind, memory)
    assert len(after.moves) == after.planned < memory.planned


def survival(
    evader: Strategy, pursuer: Strategy, seed: int, steps: int
) -> int:
    room, starts = arena(seed)
    track = play_steps(pursuer, evader, starts, steps, room=room)
    return round(float(track.times[-1]) / STEP)


@pytest.mark.slow
def test_herding_is_survived_in_a_room() -> None:
    assert survival(RobustEvasion(), Pursuit(pull=1.0), 1000, 225) == 225


def test_sharp_pursuer_needs_0_8_of_the_time_of_an_offline_search() -> None:
    """The search knows the pursuer; the evader has to find it out."""
    room, (pursuer, evader) = arena(1000)
    path = beam_search(
        pair_of(evader, pursuer),
        actions_of(STEPS.largest),
        PursuerModel(12.5),
        Objective(STEPS, room.solid_set.packed, 0.2, capture=0.35),
        BeamRules(1000, 450),
    )
    sharp = Pursuit(gain=inf)
    online = survival(RobustEvasion(), sharp, 1000, 450)
    assert 0.8 * len(path) < online < 450


def test_faster_pursuer_of_the_paper_is_survived_on_an_open_floor() -> None:
    starts = generate_room(RoomRecipe(None, None), 1002).starts
    assert starts is not None
    faster = {"gait": {"speed": 0.11, "stride": 0.044}}
    track = play_steps(Pursuit(), RobustEvasion(), starts, 225, pursuer=faster)
    assert track.outcome is Outcome.COMPLETED


def test_walker_that_is_nearer_than_the_capture_distance_still_flees() -> None:
    evader, own = RobustEvasion(20, 20), Pose(0.0, 0.0, pi)
    near = Knowledge(
        0.0, 0.0, 0.34, LIMITS, pose_in_map=own, step_start_in_map=own
    )
    intent, memory = evader.decide(near, evader.begin())
    assert len(memory.moves) > 5 and intent.speed_factor == 1.0
    still = replace(near, step_start_in_map=None)
    _, lost = evader.decide(still, evader.begin())
    assert len(lost.moves) == 0
