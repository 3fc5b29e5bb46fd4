"""Test that unreachable references end a duel as an outcome."""

import re
from collections.abc import Iterator

import numpy as np
import pytest

from stepaside.games.game import Outcome
from stepaside.games.game_settings import GameSettings, StartSettings, duel
from stepaside.games.player_settings import PLAYERS
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.planning import GaitSettings
from stepaside.report.film_captions import describe_state
from stepaside.robots import leg_kinematics as kinematics
from stepaside.strategies import Evasion

pytestmark = pytest.mark.usefixtures("blank_figures")

# Four times the paper's stride: it can be stood, and begun.
FAR = GaitSettings(stride=0.16)
WORDS = r"lost its footing at 1\.\d\d s: NAO cannot follow: (\w+ foot|CoM)"


def settings_of(pursuer: str) -> GameSettings:
    """Return a duel in which a robot walks at once, but not for long."""
    return duel(
        duration=4.0,
        pursuer={"body": pursuer},
        gait=FAR,
        start=StartSettings(1.0, 0.0, 0.0),
        evasion=Evasion(safety_radius=1.5),
    )


@pytest.fixture(scope="module", autouse=True)
def impatient() -> Iterator[None]:
    """Make legs fail before their robot falls."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(kinematics, "GREATEST_ERROR", 0.02)
        yield


@pytest.fixture(scope="module", params=["robot", "person"])
def run(request: pytest.FixtureRequest) -> Run:
    pursuer: str = request.param
    return run_game(settings_of(pursuer))


def test_an_unreachable_reference_ends_the_duel(run: Run) -> None:
    """The record is complete up to then, and the robot is named."""
    assert run.outcome is Outcome.UNREACHABLE
    who = PLAYERS if run.settings.pursuer.body == "robot" else PLAYERS[1:]
    name, rest = run.message.split(maxsplit=1)
    assert name in who and re.match(WORDS, rest)
    # It stood for the first double support, and then it walked.
    assert FAR.start_support < run.duration < 2.0
    assert f"{run.duration:.2f} s" in run.message
    assert run.times[-1] == pytest.approx(run.duration)
    assert (np.diff(run.times) > 0.0).all()
    for name in who:
        landings = run.tracks[name].landings
        assert landings is not None and len(landings) >= 1
    for track in run.tracks.values():
        assert len(track.torso) == len(run.times) == len(track.com)
        assert np.isfinite(track.torso).all()
    assert run.summary.planning is not None
    assert run.summary.planning.replans >= 1
    assert run.summary.converged_at_s is None
    last = len(run.times) - 1
    assert (
        describe_state(run, last)
        == run.message
        != describe_state(run, last - 1)
    )
