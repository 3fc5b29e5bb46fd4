"""Test the initial poses of any number of players."""

from dataclasses import replace
from itertools import combinations
from math import atan2, hypot, pi, radians
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import wrap_angle
from stepaside.games.drawn_starts import least_distance
from stepaside.games.game_settings import GameSettings, duel, read_game
from stepaside.games.game_starts import with_starts


def game(*more: dict[str, Any], **entries: Any) -> GameSettings:
    players = [
        {"name": "red", "role": "pursuer"},
        {"name": "ruby", "role": "pursuer"},
        {"name": "blue", "role": "evader"},
        *more,
    ]
    return read_game(entries | {"players": players}, "game")


@pytest.mark.parametrize("seed", range(5))
def test_drawn_starts_keep_their_distance_and_face_opponents(
    seed: int,
) -> None:
    settings = with_starts(game(seed=seed))
    poses = {p.name: p.pose for p in settings.players}
    for one, other in combinations(poses.values(), 2):
        assert one is not None and other is not None
        assert hypot(other.x - one.x, other.y - one.y) >= settings.start.near
    for name, most in (("red", pi / 2), ("ruby", pi / 2)):
        own, blue = poses[name], poses["blue"]
        assert own is not None and blue is not None
        assert hypot(own.x, own.y) <= settings.start.far
        sight = atan2(blue.y - own.y, blue.x - own.x)
        assert abs(wrap_angle(own.theta - sight)) <= most
    blue = poses["blue"]
    hunters = [poses["red"], poses["ruby"]]
    assert blue is not None
    sights = [
        abs(wrap_angle(atan2(p.y - blue.y, p.x - blue.x) - blue.theta))
        for p in hunters
        if p is not None
    ]
    assert min(sights) <= radians(30.0)


def test_overlapping_starts_are_refused() -> None:
    near = {"name": "guest", "body": "person", "start": [0.1, 0.0, 0.0]}
    also = {"name": "host", "body": "person", "start": [0.4, 0.0, 0.0]}
    with pytest.raises(
        ConfigurationError,
        match=r"guest and host must be at least 0.5 \[m\].*got 0.3$",
    ):
        with_starts(game(near, also))
    guest = game(near).player("guest")
    assert least_distance(guest, guest) == 0.5
    assert least_distance(guest, game().player("red")) == 0.45


@pytest.mark.parametrize(("width", "depth"), [(6.0, 6.0), (12.0, 1.6)])
def test_drawn_goals_are_free_and_across_the_room(
    width: float, depth: float
) -> None:
    room = {"width": width, "depth": depth}
    guests = {"name": "guest", "body": "person", "draws_goal": True}
    made = game(guests | {"count": 8}, room=room, start={"near": 0.6})
    settings = with_starts(made)
    for own in settings.players[3:]:
        (x, y), (u, v, _) = own.goal, own.start
        assert hypot(u - x, v - y) >= max(width, depth) / 3.0
        assert abs(x) <= 0.5 * width - 0.3 and abs(y) <= 0.5 * depth - 0.3
    assert with_starts(settings) == settings
    other = with_starts(replace(made, seed=2))
    assert other.players[3].goal != settings.players[3].goal


def test_goals_and_bodies_in_walls_are_refused() -> None:
    room = {"width": 4.0, "depth": 4.0}
    guest = {"name": "guest", "body": "person", "goal": [2.5, 0.0]}
    with pytest.raises(ConfigurationError, match="goal of guest must be on"):
        with_starts(game(guest, room=room))
    leaning = {"name": "leaning", "start": [1.95, 0.0, 0.0]}
    with pytest.raises(ConfigurationError, match="start of leaning must be"):
        with_starts(game(leaning, room=room))


def test_a_start_beside_that_of_a_duel_is_refused() -> None:
    for room in (None, 5):
        made = with_starts(duel(room=room))
        assert with_starts(made) == made
        for name in ("pursuer", "evader"):
            own = duel(room=room, **{name: {"start": (0.1, 0.0, 0.0)}})
            with pytest.raises(ConfigurationError, match=f"{name}: start"):
                with_starts(own)


def test_a_floor_without_a_free_place_is_told() -> None:
    alone: dict[str, Any] = {
        "players": [{"name": "solo"}],
        "room": {"width": 1, "depth": 1},
    }
    alone["room"]["obstacles"] = [{"x": 0, "y": 0, "radius": 0.3}]
    with pytest.raises(ConfigurationError, match="no such place"):
        with_starts(read_game(alone))
