"""Test the sightings of several players and what a robot knows of them."""

from math import atan2, hypot, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.control.sight_sources import SightOfPlayers
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.player_identity import PlayerIdentity, Role
from stepaside.core.poses import Pose
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import GaitSettings
from stepaside.strategies import Pursuit

EVADER = PlayerIdentity("blue", Role.EVADER, "evader")
HUNTERS = tuple(
    PlayerIdentity(name, Role.PURSUER, "pursuer") for name in ("one", "two")
)
GUEST = PlayerIdentity("guest", Role.BYSTANDER, "guest")
TICK = 0.02


def measure(*sightings: Sighting) -> RobotState:
    empty = np.zeros(3)
    return RobotState(
        0.0, np.zeros(1), empty, empty, np.zeros(8), None, players=sightings
    )


def at(who: PlayerIdentity, distance: float, time: float = 0.0) -> Sighting:
    return Sighting(time, 0.1, distance, identity=who)


def opponent(sight: SightOfPlayers, *sightings: Sighting) -> str:
    step: Any = None
    seen = sight.see(measure(*sightings), step, None)
    assert seen is not None and seen.identity is not None
    return seen.identity.name


def test_the_opponent_is_the_nearest_one_with_a_margin() -> None:
    sight = SightOfPlayers(EVADER)
    one, two = HUNTERS
    assert opponent(sight, at(one, 2.0), at(two, 1.0), at(GUEST, 0.5)) == "two"
    # Only clearly nearer: no switching to and fro between equal distances.
    assert opponent(sight, at(one, 0.95)) == "two"
    assert opponent(sight, at(one, 0.85)) == "one"
    names = [s.identity.name for s in sight.in_sight.sightings if s.identity]
    assert names == ["one", "two", "guest"]
    assert sight.in_sight.identity == EVADER


def test_an_assigned_target_is_kept_and_bystanders_serve_if_alone() -> None:
    sight = SightOfPlayers(EVADER, "one")
    step: Any = None
    assert sight.see(measure(at(HUNTERS[1], 1.0)), step, None) is None
    assert opponent(sight, at(HUNTERS[0], 3.0)) == "one"
    assert opponent(SightOfPlayers(EVADER), at(GUEST, 4.0)) == "guest"


def test_opponents_of_one_measurement_have_different_numbers() -> None:
    """By its number the strategy's rates are those of one player."""
    sight, step = SightOfPlayers(EVADER), SimpleNamespace()
    far: Any = step
    first = sight.see(measure(at(HUNTERS[0], 1.0)), far, None)
    second = sight.see(measure(at(HUNTERS[1], 0.5)), far, None)
    assert first is not None and second is not None
    assert first.target_id != second.target_id


class Recorder(Pursuit):
    """Pursuit that stores what it is given."""

    __slots__ = ()
    known: list[Any] = []

    def decide(self, knowledge: Any, memory: Any) -> Any:
        """Store the knowledge."""
        self.known.append(knowledge)
        return super().decide(knowledge, memory)


def runner() -> StrategyRunner:
    Recorder.known.clear()
    return StrategyRunner(Recorder(), GaitSettings())


def pass_time(made: StrategyRunner, begin: float, end: float) -> None:
    """Turn by 0.2 rad/s and move ahead slowly, from tick to tick."""
    for time in np.arange(round(begin / TICK), round(end / TICK) + 1) * TICK:
        made.templates.note(time, Pose(0.05 * time, 0.0, 0.2 * time))
        made.headings.note(time, 0.2 * time)


def sighting_of(
    who: PlayerIdentity, x: float, y: float, time: float
) -> Sighting:
    """Return the exact sighting of a point in odometry."""
    own = Pose(0.05 * time, 0.0, 0.2 * time)
    bearing = atan2(y - own.y, x - own.x) - own.theta
    return Sighting(time, bearing, hypot(y - own.y, x - own.x), identity=who)


def test_others_are_known_with_position_and_velocity_over_the_floor() -> None:
    made, sight = runner(), SightOfPlayers(EVADER)
    step: Any = None
    for k in range(8):
        time = 0.5 * k
        pass_time(made, time - 0.48, time)
        seen = sight.see(
            measure(
                sighting_of(HUNTERS[0], 2.0 - 0.1 * time, 0.5, time),
                sighting_of(HUNTERS[1], -1.0, 1.0 + 0.2 * time, time),
            ),
            step,
            None,
        )
        made.note_players(sight.in_sight)
        made.decide(time, seen, moving=True)
    known = Recorder.known[-1]
    own = Pose(0.05 * 3.5, 0.0, 0.2 * 3.5)
    assert known.identity == EVADER and len(known.opponents) == 2
    for other, position, velocity in zip(
        known.others,
        ((2.0 - 0.35, 0.5), (-1.0, 1.7)),
        ((-0.1, 0.0), (0.0, 0.2)),
        strict=True,
    ):
        there = own.transform_points([other.position])[0]
        assert there == pytest.approx(position, abs=1e-9)
        turned = Pose(0.0, 0.0, own.theta)
        over_floor = turned.transform_points([other.velocity])[0]
        assert over_floor == pytest.approx(velocity, abs=1e-9)
        assert other.age == 0.0
    nearest = min(known.others, key=lambda other: other.distance)
    assert known.bearing == pytest.approx(nearest.bearing)
    assert known.distance == pytest.approx(nearest.distance)


def test_a_hidden_player_stays_where_it_was_seen() -> None:
    made, sight = runner(), SightOfPlayers(EVADER)
    step: Any = None
    sight.see(measure(sighting_of(HUNTERS[0], 1.0, 1.0, 0.5)), step, None)
    for before, now in ((0.0, 0.5), (0.5, 3.0), (3.0, 7.5)):
        pass_time(made, before, now)
        seen = sight.see(measure(), step, None)
        made.note_players(sight.in_sight)
        made.decide(now, seen, moving=True)
        known, (other,) = Recorder.known[-1], Recorder.known[-1].others
        taken = now if now - 0.5 > 1.0 else 0.5
        frame = Pose(0.05 * taken, 0.0, 0.2 * taken)
        there = frame.transform_points([other.position])[0]
        assert there == pytest.approx((1.0, 1.0), abs=1e-9)
        assert known.bearing == pytest.approx(other.bearing)
        assert known.age == other.age == now - 0.5


def test_roles_oppose_and_teams_join() -> None:
    assert Role.PURSUER.opposes(Role.EVADER)
    assert Role.EVADER.opposes(Role.PURSUER)
    assert not Role.EVADER.opposes(Role.EVADER)
    assert not Role.BYSTANDER.opposes(Role.PURSUER)
    assert HUNTERS[0].is_with(HUNTERS[1])
    assert not HUNTERS[0].is_with(HUNTERS[0])
    known = Recorder.known[-1] if Recorder.known else None
    if known is not None:
        towards = known.towards(-1.0, 0.0)
        assert (towards.bearing, towards.distance) == (pi, 1.0)


def test_players_are_numbered_from_one_in_the_order_of_their_sightings() -> (
    None
):
    sight, step = SightOfPlayers(EVADER), SimpleNamespace()
    one, two = HUNTERS
    for seen, number in ((at(one, 1.0), 1), (at(two, 0.2), 2)):
        got = sight.see(measure(seen), step, None)  # type: ignore[arg-type]
        assert got is not None and got.target_id == number
