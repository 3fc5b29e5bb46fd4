"""What several flows need."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from flows.running import Running


@pytest.fixture
def start() -> Iterator[Callable[..., Running]]:
    """Function that watches over a command."""
    made: list[Running] = []

    def watch(process: Any) -> Running:
        made.append(Running(process))
        return made[-1]

    yield watch
    for each in made:
        each.close()
