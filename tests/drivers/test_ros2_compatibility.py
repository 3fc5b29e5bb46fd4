"""Test the configuration of CycloneDDS for ROS 2's Fast DDS."""

import os
from collections.abc import Callable
from typing import Any
from xml.etree import ElementTree

import pytest

pytest.importorskip("cyclonedds")

from stepaside.drivers import ros2_dds as domain  # noqa: E402
from stepaside.drivers.ros2_dds import DdsParticipant  # noqa: E402

FAST_DDS = "1.15"  # vendor's number of Fast DDS, ROS 2's own DDS
OWN = "<CycloneDDS><Domain><General/></Domain></CycloneDDS>"
FILE = "file:///etc/cyclonedds.xml"


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> Callable[..., str]:
    """Return the configuration at the creation of a participant."""

    def tell(before: str | None = None, **changes: Any) -> str:
        seen: list[str] = []
        if before is None:
            monkeypatch.delenv("CYCLONEDDS_URI", raising=False)
        else:
            monkeypatch.setenv("CYCLONEDDS_URI", before)

        def participant(number: int) -> None:
            seen.append(os.environ.get("CYCLONEDDS_URI", ""))

        monkeypatch.setattr(domain, "DomainParticipant", participant)
        DdsParticipant(0, **changes)
        assert os.environ.get("CYCLONEDDS_URI") == before
        return seen[0]

    return tell


def last_ignored(told: str) -> str | None:
    """Return the vendors whose type information is ignored."""
    config = ElementTree.fromstring(told[told.rindex("<CycloneDDS>") :])
    return config.findtext("Domain/Compatibility/IgnoreTypeInformation")


@pytest.mark.parametrize("before", [None, "", OWN, FILE, f"{FILE},{OWN}"])
@pytest.mark.parametrize("beyond", [False, True])
def test_type_information_of_fast_dds_is_ignored_always(
    told: Callable[..., str], before: str | None, beyond: bool
) -> None:
    """CycloneDDS takes type information of Fast DDS 3 for invalid."""
    assert last_ignored(told(before, beyond=beyond)) == FAST_DDS


@pytest.mark.parametrize("before", [OWN, FILE, f"{FILE},{OWN}"])
def test_beyond_this_machine_the_own_configuration_counts(
    told: Callable[..., str], before: str
) -> None:
    assert told(before, beyond=True).startswith(f"{before},")
    assert before not in told(before)
