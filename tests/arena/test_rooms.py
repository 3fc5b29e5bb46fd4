"""Test rooms: walls, doors, paths, initial poses, files and seeds."""

import json
from dataclasses import replace
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from click.testing import CliRunner

from stepaside.arena import (
    OPEN_FLOOR,
    Box,
    Disc,
    Door,
    Room,
    RoomRecipe,
    check_initial_poses,
    clearance_between,
    first_waypoint,
    generate_room,
    load_room,
)
from stepaside.cli.main import main
from stepaside.core.entries import read_entries, to_entries
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose, wrap_angle

PILLAR = Room(4.0, 2.0, (Disc(0.0, 0.0, 0.3),))


def path_exists(room: Room, start: Any, end: Any, radius: float) -> bool:
    return first_waypoint(room.solid_set, start, end, radius) is not None


def two_rooms(gap: float) -> Room:
    """Room divided by a wall with a gap in [m]."""
    middle, length = 0.75 + 0.25 * gap, 1.5 - 0.5 * gap
    walls = [Box(0.0, y, 0.1, length) for y in (-middle, middle)]
    return Room(3.0, 3.0, tuple(walls))


def test_clearance_is_the_distance_to_the_nearest_solid() -> None:
    points = [[0.0, 0.8], [1.9, 0.0], [0.1, 0.0], [0.5, 0.0], [0.0, 1.2]]
    np.testing.assert_allclose(
        PILLAR.clearance(points), [0.2, 0.1, -0.2, 0.2, 0.1]
    )


def test_walls_surround_the_floor_and_doors_are_gaps() -> None:
    room = Room(4.0, 2.0, (), (Door("east", 0.2, 0.6), Door("north", -1.0)))
    assert not room.is_closed
    closed = Room(4.0, 2.0)
    inside = np.random.default_rng(1).uniform(-0.99, 0.99, (400, 2)) * [2, 1]
    np.testing.assert_allclose(
        closed.clearance(inside),
        np.minimum(2 - abs(inside[:, 0]), 1 - abs(inside[:, 1])),
    )
    middle, beside = [[2.05, 0.2]], [[2.05, -0.2]]
    assert room.clearance(middle)[0] == pytest.approx(0.3)
    assert room.clearance(beside)[0] < 0.0
    assert room.clearance([[-1.0, 1.05]])[0] == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("gap", "radius", "exists"),
    [
        (0.6, 0.2, True),
        (0.44, 0.2, True),
        (0.38, 0.2, False),
        (0.0, 0.01, False),
    ],
)
def test_path_leads_through_gaps_that_are_wide_enough(
    gap: float, radius: float, exists: bool
) -> None:
    assert path_exists(two_rooms(gap), (-1.0, 1.0), (1.0, 0.7), radius) == (
        exists
    )


def test_path_leads_around_corners_and_through_doors() -> None:
    """Each half has a door; the path leads outside around the wall."""
    shut = two_rooms(0.0)
    doors = (Door("north", -0.8), Door("north", 0.8))
    assert not path_exists(shut, (-1.0, 0.0), (1.0, 0.0), 0.2)
    assert path_exists(
        replace(shut, doors=doors), (-1.0, 0.0), (1.0, 0.0), 0.2
    )
    assert path_exists(OPEN_FLOOR, (-1.0, 0.0), (1.0, 0.0), 0.2)


RECIPE = RoomRecipe(3.0, 3.0, discs=3, boxes=2, polygons=2, doors=2)


def test_generated_room_follows_its_recipe() -> None:
    for seed in range(4):
        room = generate_room(RECIPE, seed)
        assert generate_room(RECIPE, seed) == room
        assert (len(room.obstacles), len(room.doors)) == (7, 2)
        assert room.starts is not None
        check_initial_poses(room, room.starts)
        pursuer, evader = room.starts
        x, y = evader.x - pursuer.x, evader.y - pursuer.y
        assert 0.6 <= hypot(x, y) <= 1.5
        aim = float(np.arctan2(y, x))
        assert abs(wrap_angle(aim - pursuer.theta)) <= np.pi / 2
        bearing = wrap_angle(aim + np.pi - evader.theta)
        assert abs(bearing) <= np.pi / 6 + 1e-12
        for i, one in enumerate(room.obstacles):
            for other in room.obstacles[:i]:
                if not isinstance(one, Disc):
                    assert clearance_between(one, other) > 0.0
    assert generate_room(RECIPE, 1) != generate_room(RECIPE, 2)


def test_room_survives_a_round_trip_through_a_file(tmp_path: Path) -> None:
    room = generate_room(RECIPE, 3)
    file = tmp_path / "room.toml"
    file.write_text(tomli_w.dumps(to_entries(room)), encoding="utf-8")
    assert load_room(file) == room
    again = tmp_path / "again.json"
    answer = CliRunner().invoke(
        main, ["run", "room", str(file), "--output", str(again), "--json"]
    )
    assert answer.exit_code == 0, answer.output
    assert load_room(again) == room
    assert read_entries(Room, json.loads(answer.output)["room"]) == room


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("width = 3.0", "must have both width and depth"),
        (
            "width = nan\ndepth = 3.0",
            r"width must lie in \[0.5, 100\] \[m\], got nan",
        ),
        ("width = true\ndepth = 3.0", r"width must lie in .* \[m\], got True"),
        ("height = 3.0", "unknown entry height; there are width"),
        ("obstacles = 3", "obstacles must be an array, got 3"),
        ("obstacles = [3]", "obstacles 1 must be a table"),
        ("[[obstacles]]\nx = 1\ny = 0", "obstacles 1: missing entry radius"),
        (
            "[[obstacles]]\nx = 1\ny = 0\nradius = nan",
            "obstacles 1: radius must lie in .*nan",
        ),
        (
            "[[obstacles]]\nx = 1\ny = 0\nr = 1\nradius = 1",
            "obstacles 1: an obstacle must have the entries of one shape",
        ),
        (
            "[[obstacles]]\ncorners = [[0,0],[1,1],[1,0],[0,1]]",
            "obstacles 1: polygon must not cross itself",
        ),
        ("[[doors]]\nside = 'up'", "doors 1.side must be one of east"),
        ("[[doors]]\nside = 'east'", "must have walls for its doors"),
        (
            "width=1.0\ndepth=1.0\n[[doors]]\nside='east'\nwidth=1.2",
            "doors must lie in their wall",
        ),
        (
            "width=1.0\ndepth=1.0\n[[obstacles]]\nx=0.7\ny=0\nradius=0.1",
            "must stand between the walls",
        ),
        ("starts = [[0, 0, 0]]", "starts must have 2 entries"),
        ("width = ", "room.toml: "),
        (
            "starts = [[0, 0, 0], [1, 0, 0]]\n"
            "[[obstacles]]\nx=0.1\ny=0\nradius=0.1",
            "the pursuer must start at least 0.2",
        ),
    ],
)
def test_invalid_file_is_refused_in_one_line(
    text: str, rule: str, tmp_path: Path
) -> None:
    file = tmp_path / "room.toml"
    file.write_text(text, encoding="utf-8")
    answer = CliRunner().invoke(main, ["run", "room", str(file)])
    assert answer.exit_code == 2
    assert len(answer.output.splitlines()) == 1
    with pytest.raises(ConfigurationError, match=rule):
        room = load_room(file)
        assert room.starts is not None
        check_initial_poses(room, room.starts)


def test_starts_are_limited_as_places_and_as_bearings() -> None:
    far, turned = Pose(20.0, -20.0, 0.0), Pose(0.0, 0.0, 20.0)
    assert Room(starts=(far, far)).starts == (far, far)
    with pytest.raises(ConfigurationError, match="start theta must lie"):
        Room(starts=(far, turned))
