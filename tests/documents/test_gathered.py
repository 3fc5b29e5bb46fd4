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


def test_files_and_compiled_code_are_groups(
    request: pytest.FixtureRequest,
) -> None:
    """Unless a test names another one."""
    groups: dict[str, set[str]] = {}
    for item in request.session.items:
        mark = item.get_closest_marker("xdist_group")
        assert mark is not None
        name = f"{item.path.parent.name}/{item.path.stem}"
        groups.setdefault(name, set()).add(mark.args[0])
    assert groups["documents/test_gathered"] == {"gathered", "test_gathered"}
    for name, found in groups.items():
        if name.startswith("theory/"):
            assert found <= {"unicycle", "bound"}
