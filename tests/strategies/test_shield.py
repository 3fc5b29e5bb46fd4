"""Test the shield around a strategy."""

from dataclasses import dataclass, replace
from math import atan2, cos, hypot, inf, pi, sin

import numpy as np
import pytest

from stepaside.core.poses import Pose, wrap_angle
from stepaside.planning import Direction
from stepaside.strategies import (
    Intent,
    Knowledge,
    Limits,
    ShieldedStrategy,
    ShieldSettings,
    StandStill,
    Walk,
)
from stepaside.strategies.body_departure import BodyDeparture
from stepaside.strategies.shield import TemplatePoint, shield_model
from stepaside.strategies.velocity_set import VelocitySet
from stored_values import compare_stored, summed

LIMITS = Limits(0.1, 0.2, 0.04, 0.5)  # 0.08 m/s of gait time
CONTACT = 0.3  # [m]
PERSON = ShieldSettings(True, 0.1, 8.0, CONTACT)
BODY = BodyDeparture(0.15, 0.05, 0.003, 0.001)
LEGS = VelocitySet((-0.6, 0.7), (-0.3, 0.3), (-1.0, 1.0))
SPEED = PERSON.speed


@pytest.fixture(autouse=True)
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stepaside.strategies.shield.CELLS", 5)


def known(time: float, distance: float, **changes: object) -> Knowledge:
    """Return knowledge of a person who comes from ahead."""
    knowledge = Knowledge(time, 0.0, distance, LIMITS)
    return replace(knowledge, **changes)  # type: ignore[arg-type]


def approach(strategy: ShieldedStrategy, distance: float) -> list[Intent]:
    """Return the decisions of a standing robot whom a person approaches."""
    memory, intents = strategy.begin(), []
    for i in range(3):
        time = 0.5 * i
        intent, memory = strategy.decide(
            known(time, distance - SPEED * time), memory
        )
        intents.append(intent)
    return intents


def test_robot_stands_while_that_is_safe() -> None:
    strategy = ShieldedStrategy(StandStill(), PERSON, BODY)
    assert not any(intent.walks for intent in approach(strategy, 6.0))


def test_motion_of_a_start_is_held_for_a_period_from_its_first_step() -> None:
    strategy = ShieldedStrategy(StandStill(), PERSON, BODY)
    memory, numbers = strategy.begin(), []
    for i in range(6):  # it walks from 1.5 s on, after its response
        knowledge = known(0.5 * i, 1.0 - 0.5 * SPEED * i, moving=i > 2)
        _, memory = strategy.decide(knowledge, memory)
        if memory.held is not None and i > 1:
            numbers.append(memory.held.number)
            # The first step had begun when it was decided.
            until = 1.5 - 0.5 + 2.0 if i > 2 else inf
            assert memory.held.until == pytest.approx(until)
    assert len(numbers) == 4 and len(set(numbers)) == 1


@pytest.mark.parametrize("legs", [None, LEGS])
def test_decisions_by_old_sightings_are_those_that_are_stored(
    legs: VelocitySet | None,
) -> None:
    strategy = ShieldedStrategy(Walk(bearing=0.4), PERSON, BODY)
    memory, found = strategy.begin(), []
    for i in range(12):
        time, moving = 0.25 * i, 3 < i < 9
        away = 1.1 - (time - 0.1) * SPEED
        knowledge = known(time, away, bearing=0.3, age=0.1, moving=moving)
        if legs:
            limits = replace(LIMITS, velocities=legs)
            knowledge = replace(knowledge, limits=limits)
        intent, memory = strategy.decide(knowledge, memory)
        assert memory.rows[-1].time == pytest.approx(time - 0.1)
        found += [*summed([intent, memory.course, memory.stands_until])]
        found += [f"{memory.guarded} {memory.certified} {memory.command}"[:30]]
    compare_stored("decisions.json", f"shield, {legs is None}", found)


def test_certificate_begins_when_the_heading_of_the_person_is_known() -> None:
    """Until then no motion need be safe against all headings at once."""
    strategy = ShieldedStrategy(StandStill(), PERSON, BODY)
    memory, certified = strategy.begin(), []
    for i in range(12):
        knowledge = known(0.5 * i, 4.0 - 0.5 * SPEED * i)
        _, memory = strategy.decide(knowledge, memory)
        certified.append(memory.certified)
        assert memory.guarded
    assert not certified[0] and certified[-1]
    assert certified == sorted(certified)


def test_contact_that_no_motion_excludes_is_not_guarded() -> None:
    strategy = ShieldedStrategy(StandStill(), PERSON, BODY)
    memory = strategy.begin()
    for i in range(2):
        knowledge = known(0.5 * i, 0.4 - 0.5 * SPEED * i)
        _, memory = strategy.decide(knowledge, memory)
    assert not memory.guarded


def test_person_beyond_every_robot_changes_nothing(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where contact can be forced from everywhere, the strategy decides.

    The warning names the greatest speed that a robot at 0.08 m/s evades.
    """
    monkeypatch.setattr("stepaside.strategies.shield.SPEED_STEP", 2.0)
    faster = replace(PERSON, speed=1.4, turning_radius=0.5)
    strategy = ShieldedStrategy(StandStill(), faster)
    assert not any(intent.walks for intent in approach(strategy, 1.2))
    assumed, said = caplog.messages
    assert "departs from its template, 0.2 m" in assumed
    assert "no state is certified against a person at 1.4 m/s" in said
    assert "The greatest speed against which some are is 0.04 m/s" in said


@dataclass(frozen=True)
class AtRandom:
    """Evader that walks at random.

    Attributes:
        random: Source of its headings.
    """

    random: np.random.Generator
    direction: Direction = Direction.BACKWARD
    saturated: bool = False

    def begin(self) -> None:
        """Return an empty memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Decide on a random heading."""
        return Intent(float(self.random.uniform(-pi, pi))), None


def play(seed: int, start: tuple[float, float, float]) -> float:
    """Return the closest approach to a shielded robot that walks at random.

    Unicycles in steps; the person turns towards the robot, or at random.
    """
    random = np.random.default_rng(seed)

    strategy = ShieldedStrategy(AtRandom(random), PERSON, BODY)
    memory = strategy.begin()
    own, person = Pose(*start), Pose(0.0, 0.0, 0.0)
    most = SPEED / PERSON.turning_radius * 0.5
    closest = np.inf
    for i in range(80):
        dx, dy = person.x - own.x, person.y - own.y
        bearing = wrap_angle(atan2(dy, dx) - own.theta)
        knowledge = Knowledge(
            0.5 * i, bearing, hypot(dx, dy), LIMITS,
            pose_in_map=own, moving=i > 0,
        )  # fmt: skip
        intent, memory = strategy.decide(knowledge, memory)
        if i == 1 and not memory.guarded:
            return np.inf  # no certified start
        turn = min(max(0.08 * intent.heading, -0.08 * pi), 0.08 * pi)
        way = -0.04 * intent.speed_factor * intent.walks
        own = own.compose(
            Pose(way * cos(0.5 * turn), way * sin(0.5 * turn), turn)
        )
        aim = wrap_angle(atan2(own.y - person.y, own.x - person.x) - person[2])
        rate = min(max(aim, -most), most)
        if random.random() < 0.3:
            rate = most * float(random.choice([-1.0, 1.0]))
        person = person.compose(Pose(0.5 * SPEED, 0.0, rate))
        closest = min(closest, hypot(person.x - own.x, person.y - own.y))
    return closest


def test_no_contact_from_certified_starts() -> None:
    found = [
        play(seed, (x, y, theta))
        for seed, (x, y, theta) in enumerate(
            np.random.default_rng(2)
            .uniform([-0.5, -0.7, -pi], [2.0, 0.7, pi], (30, 3))
            .tolist()
        )
    ]
    assert sum(np.isfinite(found)) > 10
    assert min(found) > CONTACT


@pytest.mark.parametrize("duration", [0.08, 0.48])
def test_template_point_follows_a_displaced_body_slowly(
    duration: float,
) -> None:
    """By no more than 0.24 of the speed of the legs."""
    point = TemplatePoint((0.0, 0.0))
    moved = point.advance((0.2, 0.0), (0.0, 5.0), LEGS, duration)
    assert moved.position[1] == pytest.approx(0.24 * 0.7 * duration, rel=0.01)


def test_legs_choose_among_motions_to_all_sides_alike() -> None:
    limits = replace(LIMITS, velocities=LEGS)
    choices = shield_model(limits, PERSON, departure=BODY).choices()
    for mirrored in choices * [1.0, -1.0, -1.0]:
        assert np.abs(choices - mirrored).max(axis=1).min() < 1e-9
    assert choices[:, 0].min() < -0.5 and choices[:, 0].max() > 0.6


def test_person_is_known_after_a_halt_in_which_nothing_is_decided() -> None:
    strategy = ShieldedStrategy(StandStill(), PERSON, BODY)
    memory = strategy.begin()
    for time in (0.0, 2.0):  # longer than a step and 1 s
        knowledge = known(time, 3.0 - SPEED * time, moving=time < 1.0)
        _, memory = strategy.decide(knowledge, memory)
    assert memory.course is not None and memory.guarded
