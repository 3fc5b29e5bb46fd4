"""Test the progress of long work."""

import pytest

from stepaside.core import progress
from stepaside.core.progress import ProgressLine


def test_the_time_before_the_first_report_is_not_extrapolated(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A solver compiles for 50 s, then advances by 1 % a second."""
    clock = [0.0]
    monkeypatch.setattr(progress, "monotonic", lambda: clock[0])
    line = ProgressLine("bound", 1.0)
    for clock[0], done in ((50.0, 0.02), (60.0, 0.12)):
        line.show(done)
    first, second = capsys.readouterr().err.splitlines()
    assert first.endswith("50 s so far")
    assert second.endswith("60 s so far, about 88 s left")
