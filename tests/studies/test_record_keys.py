"""Test the keys of records: whatever decides a result changes its key."""

from dataclasses import replace
from typing import Any

import pytest

from changed_settings import changed
from stepaside.arena import Disc, Door, Room, RoomRecipe
from stepaside.core.poses import Pose
from stepaside.games.duel_settings import DuelSettings, RobotSettings
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.planning import PRESETS
from stepaside.sim.camera_settings import RoomObject
from stepaside.sim.person_settings import PersonSettings
from stepaside.sim.push import Push
from stepaside.studies.duel_campaign import duel_study
from stepaside.studies.duel_record import settings_hash
from stepaside.studies.push_results import pushes_result
from stepaside.studies.tournament_campaign import tournament_study
from stepaside.studies.tournament_settings import TournamentSettings

ASIDE = "evasion(safety_radius=100)"

FEEDBACK = ControlSettings("closed-form", True)  # with which methods differ
PERSON = DuelSettings(pursuer="person", control=FEEDBACK)
ROOM = Room(3.0, 3.0, (Disc(0.5, 0.0, 0.2),))
OTHERS: dict[str, Any] = {
    "robot": ["other"],
    "evader_strategy": ["look-ahead"],
    "pursuer_strategy": ["lead"],
    "strategy.trigger": ["time", "distance"],
    "control.method": ["measured"],
    "sensing": ["cameras"],
    "cameras.colour.optics": ["v6", "v4"],
    "cameras.colour.renderer": ["raycast"],
    "pursuer": ["person"],
    "pursuer_robot": [RobotSettings(gait=PRESETS["fast"])],
    "evader_robot": [RobotSettings(gait=PRESETS["fast"])],
    "pushes": [(Push(1.0, 2.0, 0.0),)],
    "room.things": [[RoomObject("red box", 1.0, 1.0)]],
    "room.plan": [ROOM],
    "map.source": ["none", "seen"],
    "map.unseen": ["free"],
    "physics.integrator": ["discrete"],
    "person.path": ["circle", "straight"],
    "person.figure": ["child"],
    "person.reaction": [],  # needs a straight path
}
WALK = WalkSettings(control=FEEDBACK)
# What every trial of a campaign sets itself.
OF_TRIALS = {"seed", "duration", "pushes", "control.method"}
OF_TRIALS |= {"control.feedback"}


def key_of(settings: DuelSettings) -> str:
    return duel_study(settings, [settings.seed]).key_of(settings.seed)


def game_key(
    settings: TournamentSettings, pairing: tuple[str, str], seed: int
) -> str:
    study = tournament_study(settings, [pairing], [seed])
    return study.key_of(study.cases[0])


@pytest.mark.parametrize(
    ("settings", "others"),
    [
        (DuelSettings(control=FEEDBACK), {}),
        (
            PERSON,
            {
                "pursuer": [],
                "pursuer_strategy": [],
                "room.plan": [],
            },
        ),
    ],
    ids=["robots", "people"],
)
def test_every_setting_of_a_duel_changes_its_key(
    settings: DuelSettings, others: dict[str, Any]
) -> None:
    keys = {key_of(settings)}
    for name, made in changed(settings, OTHERS | others):
        assert key_of(made) not in keys, name
        keys.add(key_of(made))
        same = settings_hash(made) == settings_hash(settings)
        assert same == (name == "seed"), name


@pytest.mark.parametrize(
    "one",
    [Push(1.0, 2.0, 0.1), Disc(0.5, 0.0, 0.2)],
    ids=["push", "disc"],
)
def test_all_of_what_meets_a_duel_counts_in_its_key(one: Any) -> None:
    def key(each: Any) -> str:
        match each:
            case Push():
                return key_of(DuelSettings(pushes=(each,)))
        room = replace(DuelSettings().room, plan=Room(3.0, 3.0, (each,)))
        return key_of(DuelSettings(room=room))

    known = {"player": ["pursuer"], "figure": ["child"]}
    keys = [key(one), *(key(each) for _, each in changed(one, known))]
    assert len(set(keys)) == len(keys) > 3


def test_the_reaction_of_a_person_changes_the_key_of_a_duel() -> None:
    keys = {
        key_of(replace(PERSON, person=PersonSettings(path, reaction=reaction)))
        for path, reaction in (
            ("steer", "none"),
            ("straight", "none"),
            ("straight", "curious"),
            ("straight", "scared"),
        )
    }
    assert len(keys) == 4


@pytest.mark.parametrize("level", ["steps", "physics"])
def test_every_setting_of_a_tournament_changes_its_key(level: str) -> None:
    pairing = (ASIDE, "pursuit")
    for room in (RoomRecipe(doors=1, discs=1), ROOM):
        settings = TournamentSettings(level=level, room=room)
        others: dict[str, Any] = {
            "level": ["unicycle"],
            "map": ["none"] if level == "physics" else [],
            "room.obstacles": [(Disc(0.4, 0.0, 0.2),)],
            "room.doors": [(Door("east", 0.0, 0.6),)],
            "room.starts": [(Pose(-0.6, 0.0, 0.0), Pose(-0.6, 1.0, 0.0))],
            "room.moving": [],
            "game.largest_turn": [0.2],
            "game.pursuer_speed_ratio": [] if level == "physics" else [1.1],
        }
        if isinstance(room, RoomRecipe):
            others |= {"room.doors": [2]}
        keys = {game_key(settings, pairing, 1)}
        for name, made in changed(settings, others):
            key = game_key(made, pairing, 1)
            assert key not in keys, name
            keys.add(key)
    own = game_key(settings, pairing, 1)
    for other in ((ASIDE, "lead"), ("optimal", "pursuit")):
        assert game_key(settings, other, 1) != own
    assert game_key(settings, pairing, 2) != own


def test_a_result_names_all_that_its_walks_depend_on() -> None:
    """Of two walks that differ the files of results differ, too."""
    base: dict[str, Any] = dict(phases=4, seed=1, walk=WALK)

    def settings(**other: Any) -> dict[str, Any]:
        given = {"methods": ["mpc"], "body": "ideal", **base, **other}
        methods, body = given.pop("methods"), given.pop("body")
        found = pushes_result([], methods, body, **given)
        return {"command": found["command"], **found["settings"]}

    reach = replace(WALK.control.stabiliser, reach_forward=0.05)
    control = replace(WALK.control, stabiliser=reach)
    other = [
        settings(methods=["measured"]),
        settings(body="hardware"),
        settings(phases=8),
        settings(seed=2),
        settings(walk=replace(WALK, gait=PRESETS["fast"])),
        settings(walk=replace(WALK, control=control)),
    ]
    assert settings() not in other
    assert all(other.count(each) == 1 for each in other)
