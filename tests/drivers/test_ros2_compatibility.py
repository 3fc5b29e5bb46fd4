"""Test the configuration of CycloneDDS for ROS 2's Fast DDS."""

import os
from xml.etree import ElementTree

import pytest

pytest.importorskip("cyclonedds")

from stepaside.drivers import ros2_dds as domain  # noqa: E402
from stepaside.drivers.ros2_dds import DdsParticipant  # noqa: E402

FAST_DDS = "1.15"  # vendor's number of Fast DDS, ROS 2's own DDS
OWN = "<CycloneDDS><Domain><General/></Domain></CycloneDDS>"
FILE = "file:///etc/cyclonedds.xml"


@pytest.mark.parametrize("before", [None, "", OWN, FILE, f"{FILE},{OWN}"])
@pytest.mark.parametrize("beyond", [False, True])
def test_type_information_of_fast_dds_is_ignored_always(
    before: str | None, beyond: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """CycloneDDS takes type information of Fast DDS 3 for invalid.

    Beyond this machine, the user's own configuration counts, too.
    """
    seen: list[str] = []

    def participant(number: int) -> None:
        seen.append(os.environ.get("CYCLONEDDS_URI", ""))

    monkeypatch.delenv("CYCLONEDDS_URI", raising=False)
    if before is not None:
        monkeypatch.setenv("CYCLONEDDS_URI", before)
    monkeypatch.setattr(domain, "DomainParticipant", participant)
    DdsParticipant(0, beyond=beyond)
    assert os.environ.get("CYCLONEDDS_URI") == before
    (told,) = seen
    config = ElementTree.fromstring(told[told.rindex("<CycloneDDS>") :])
    ignored = config.findtext("Domain/Compatibility/IgnoreTypeInformation")
    assert ignored == FAST_DDS
    if before:
        assert told.startswith(f"{before},") == beyond
        assert (before in told) == beyond
