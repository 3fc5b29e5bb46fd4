"""The page begins with what it was started with."""

from dataclasses import replace
from typing import Any

import pytest

from fake_page import open_fake
from stepaside.games.duel_settings import DuelSettings
from stepaside.locomotion.zmp.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
)
from stepaside.report.viewer import live_page as pages
from stepaside.report.viewer.duel_panel import CUSTOM_BODY, body_choices
from stepaside.report.viewer.live_page import Page
from stepaside.sim.body_settings import BODIES
from stepaside.strategies import Evasion


def test_presets_are_offered_with_their_control() -> None:
    choices, name = body_choices(DuelSettings())
    assert name == "ideal" and tuple(choices) == tuple(BODIES)
    assert choices["ideal"] == (BODIES["ideal"], OPEN_LOOP)
    for other in set(BODIES) - {"ideal"}:
        assert choices[other] == (BODIES[other], STABILISED)


def test_a_preset_keeps_the_control_that_it_was_started_with() -> None:
    control = ControlSettings("mpc", True)
    settings = DuelSettings(body=BODIES["delayed"], control=control)
    choices, name = body_choices(settings)
    assert name == "delayed"
    assert choices[name] == (BODIES["delayed"], control)
    assert choices["hardware"][1] == STABILISED


def test_a_body_of_its_own_stands_beside_the_presets() -> None:
    body = replace(BODIES["hardware"], backlash=0.05)
    choices, name = body_choices(DuelSettings(body=body, control=STABILISED))
    assert name == CUSTOM_BODY and tuple(choices) == (*BODIES, CUSTOM_BODY)
    assert choices[CUSTOM_BODY] == (body, STABILISED)


def test_controls_show_a_start_that_is_not_the_usual_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(pages, "open_server", open_fake)
    control = ControlSettings("closed-form", True)
    settings = DuelSettings(
        strategy=Evasion(saturated=True),
        body=BODIES["delayed"],
        control=control,
    )
    page = Page(settings, host="there", port=1234)
    try:
        gui: Any = page.server.gui
        assert gui["Law"].value == "saturated (6)"
        assert gui["Body"].value == "delayed"
        gui["Duel"].press("reset")
        begun = page.session.settings
        assert isinstance(begun, DuelSettings)
        assert (begun.body, begun.control) == (BODIES["delayed"], control)
        assert begun.strategy.saturated
    finally:
        page.session.close()
