"""Test that summaries of duels are written and read again."""

import json
from dataclasses import asdict, replace
from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.archive_reader import parse_object
from stepaside.games.duel_summary import (
    DuelSummary,
    PlanTimes,
    PlayerSummary,
    TheorySummary,
)
from stepaside.games.sight_summary import (
    ErrorSpread,
    PerceptionSummary,
    SightSummary,
)
from synthetic_run import figures

BLIND = figures(
    seed=3,
    triggered_at_s=2.5,
    triggered_at_distance_m=0.79,
    converged_at_s=11.0,
    replans=40,
    min_zmp_margin_m=0.021,
    theory=TheorySummary(None, True, 0.637, 0.9, 90.0),
    plan_time_us=PlanTimes(180.0, 300.0),
    pursuer=PlayerSummary(0.63),
    evader=PlayerSummary(0.64),
)
EYES = SightSummary(
    bearing_error_deg=ErrorSpread(0.7, None),
    distance_error_m=ErrorSpread(None, None),
    detection_rate=0.9,
    false_detections=2,
    misled_s=0.5,
    lost_s=0.0,
)
SEEING = figures(
    pursuer=PlayerSummary(0.63, EYES),
    evader=PlayerSummary(None, replace(EYES, depth_detection_rate=1.0)),
    sight=PerceptionSummary("raycast", 0.97, 4, 1.5),
)
WITH_A_PERSON = figures(
    pursuer=PlayerSummary(None), evader=PlayerSummary(0.6, EYES)
)


@pytest.mark.parametrize("told", [BLIND, SEEING, WITH_A_PERSON])
def test_a_summary_is_read_as_written(told: DuelSummary) -> None:
    """Through JSON text, too."""
    plain = asdict(told)
    assert parse_object(DuelSummary, plain, "test") == told
    again = json.loads(json.dumps(plain))
    found = parse_object(DuelSummary, again, "test")
    assert found == told
    assert json.dumps(asdict(found)) == json.dumps(plain)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"distance_m": "far"}, "distance_m"),
        ({"distance_m": None}, "distance_m"),
        ({"distance_m": True}, "finite number"),
        ({"replans": 1.5}, "replans"),
        ({"replans": True}, "int"),
        ({"seed": "one"}, "seed"),
        ({"theory": None}, "theory"),
        ({"theory": [1.0]}, "theory"),
        ({"theory": {"radius_m": 1.0}}, "exists"),
        ({"plan_time_us": "fast"}, "plan_time_us"),
        ({"start": 1.0}, "start"),
        ({"pursuer": 0.6}, "pursuer"),
        ({"evader": {"radius_m": "wide"}}, "radius_m"),
        ({"evader": {"radius_m": 0.6, "sight": {"lost_s": 1.0}}}, "sight"),
        ({"sight": {"camera": "raycast"}}, "sight"),
    ],
)
def test_a_damaged_entry_is_refused_by_name(
    changes: dict[str, Any], word: str
) -> None:
    with pytest.raises(ConfigurationError) as refused:
        parse_object(DuelSummary, asdict(BLIND) | changes, "summary.json")
    message = str(refused.value)
    assert message.startswith("summary.json: ") and word in message
    assert "\n" not in message
