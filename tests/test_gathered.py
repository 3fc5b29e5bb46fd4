"""Test that tests that share what is dear to make run in one worker."""

import os

import pytest


@pytest.mark.xdist_group("gathered")
def test_tests_of_a_group_share_a_worker(
    request: pytest.FixtureRequest,
) -> None:
    """Versions of the two packages that disagree ignore groups silently."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        pytest.skip("there is only one worker")
    assert request.node.nodeid.endswith("@gathered")


def test_compiled_code_of_one_room_is_a_group(
    request: pytest.FixtureRequest,
) -> None:
    marked = {
        item.path.name
        for item in request.session.items
        if item.get_closest_marker("xdist_group")
    }
    wanted = {
        item.path.name
        for item in request.session.items
        if item.path.name.startswith("test_unicycle_")
    }
    assert wanted <= marked
