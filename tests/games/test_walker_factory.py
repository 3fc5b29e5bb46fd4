"""Test the knowledge of a robot about its room."""

from types import SimpleNamespace
from typing import Any

import pytest

from stepaside.arena import Disc, Room
from stepaside.control.clearance.map_settings import MapSettings
from stepaside.control.clearance.swept_outline import BodyOutline, lateral_sway
from stepaside.control.scheme_builder import ClearanceSetup
from stepaside.core.poses import Pose
from stepaside.games import walker_factory as standing
from stepaside.games.walker_factory import (
    WalkerSetup,
    clearance_in,
    with_body_radius,
)
from stepaside.locomotion.zmp.control_settings import ControlSettings
from stepaside.planning import GaitSettings
from stepaside.sim.body_settings import BodySettings
from stepaside.strategies import Evasion
from stepaside.strategies.look_ahead import LookAhead

GAIT = GaitSettings()
FRAME = Pose(0.4, -0.2, 0.9)
PILLAR, UNSEEN = Disc(1.0, 0.0, 0.2), Disc(-1.0, 0.0, 0.3)
ROOM = Room(4.0, 3.0, (PILLAR,))
SETUP = WalkerSetup(
    "evader",
    "robot",  # type: ignore[arg-type]
    GAIT,
    ControlSettings(),
    BodySettings(),
    odometry_in_world=FRAME,
    seed=0,
)
MIND: Any = SimpleNamespace(
    floor=SimpleNamespace(
        version=1, occupied=lambda: (PILLAR,), unknown=lambda place: (UNSEEN,)
    )
)


@pytest.fixture(autouse=True)
def outline(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return an outline without measuring a robot."""
    made: Any = SimpleNamespace(radius=0.25)
    measured = {("robot", GAIT): made}
    monkeypatch.setattr(
        standing, "measure_outline", lambda *asked: measured[asked]
    )
    return made


def known(room: Room | None = ROOM, **settings: Any) -> ClearanceSetup | None:
    return clearance_in(
        room,
        MapSettings(**settings),
        SETUP,
        MIND if settings.get("source") == "seen" else None,
    )


def test_without_a_known_room_there_is_no_clearance() -> None:
    assert known(None) is None
    assert known(None, source="seen") is None
    assert known(source="none") is None


def test_a_given_room_is_known_exactly(outline: BodyOutline) -> None:
    clearance = known(margin=0.07)
    assert clearance is not None
    assert clearance.outline is outline and clearance.margin == 0.07
    assert clearance.surroundings.pose_odometry_in_map == FRAME
    assert PILLAR in clearance.surroundings.solids.shapes


@pytest.mark.parametrize("unseen", ["free", "taken"])
def test_a_mapped_room_is_known_by_the_map(
    unseen: str, outline: BodyOutline
) -> None:
    clearance = known(source="seen", unseen=unseen)
    assert clearance is not None and clearance.outline is outline
    assert clearance.surroundings.pose_odometry_in_map == Pose(0.0, 0.0, 0.0)
    assert clearance.surroundings.solids.shapes == ()
    now: Any = SimpleNamespace(time=0.0)
    clearance.surroundings.note(now, Pose(0.1, 0.2, 0.0))
    others = (UNSEEN,) if unseen == "taken" else ()
    assert clearance.surroundings.solids.shapes == (PILLAR, *others)


def test_the_body_radius_of_a_strategy_is_at_least_that_of_the_robot() -> None:
    """With outline, margin and sway."""
    clearance = known(margin=0.07)
    assert clearance is not None
    needs = 0.25 + 0.07 + lateral_sway(GAIT)
    small, wide = LookAhead(body_radius=0.1), LookAhead(body_radius=0.6)
    fitted = with_body_radius(small, clearance, GAIT)
    assert isinstance(fitted, LookAhead)
    assert fitted.body_radius == pytest.approx(needs)
    assert with_body_radius(wide, clearance, GAIT) is wide
    assert with_body_radius(small, None, GAIT) is small
    law = Evasion()
    assert with_body_radius(law, clearance, GAIT) is law
