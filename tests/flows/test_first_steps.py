"""What a new user tries first."""

from flows.calls import stepaside


def test_version_is_printed() -> None:
    assert stepaside("--version").out.split()[-1].count(".") == 2
