"""What is wrong is refused in one line that names it; nothing is written."""

import pytest

import stepaside as sa


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"duration": float("nan")}, "duration"),
        ({"duration": -1.0}, "duration"),
        ({"evader": {"strategy": "nobody"}}, "nobody"),
        ({"start": (0.0, 0.0, 0.0)}, "start"),
    ],
)
def test_what_is_bad_is_refused_in_python(
    changes: dict[str, object], words: str
) -> None:
    with pytest.raises(sa.StepAsideError, match=words) as refused:
        sa.run_game(sa.duel(**changes))
    assert "\n" not in str(refused.value)
