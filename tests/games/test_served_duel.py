"""Test duels whose robots are commanded over ROS 2 topics."""

import os
from contextlib import closing

import pytest

pytest.importorskip("cyclonedds")

from stepaside.core.errors import ConfigurationError  # noqa: E402
from stepaside.drivers.ros2_dds import DdsParticipant  # noqa: E402
from stepaside.games.game_settings import duel  # noqa: E402
from stepaside.games.served_duel import serve_duel  # noqa: E402

DOMAIN = 20 + os.getpid() % 200


def test_the_wait_for_clients_is_limited() -> None:
    with closing(DdsParticipant(DOMAIN)) as dds:
        with pytest.raises(ConfigurationError, match="1 of 1 robots had no"):
            serve_duel(duel(), dds, {"evader": "/e"}, patience=0.02)
