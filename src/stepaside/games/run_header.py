"""What a run folder says of itself: its format, its game, its players."""

import re
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError
from .duel_settings import PLAYERS

# Of a run folder. The first had no number and filled gaps with NaN; up to
# the second all were duels.
FORMAT = 3
OLDEST_GAME = "duel"
MOST_PLAYERS = 6
NAME = re.compile(r"[a-z][a-z0-9-]{0,31}")


class RunHeader(NamedTuple):
    """What stands above the figures of a run.

    Attributes:
        version: Of the folder.
        game: What was played.
        players: Who played, in the order in which they act.
    """

    version: int
    game: str
    players: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Plain values by name."""
        return {
            "format": self.version,
            "game": self.game,
            "players": list(self.players),
        }

    def without(self, plain: dict[str, Any]) -> dict[str, Any]:
        """Figures without what stands above them."""
        return {k: v for k, v in plain.items() if k not in self.to_json()}


def read_head(plain: Any, run: str, games: tuple[str, ...]) -> RunHeader:
    """Read what a summary says of its folder.

    Args:
        plain: The summary, as JSON.
        run: Name of the run, for messages.
        games: That are known.

    Raises:
        ConfigurationError: If it is of a later format, or of no game that
            is known.
    """
    told = plain if isinstance(plain, dict) else {}
    version = told.get("format", 1)
    if type(version) is not int or version not in range(1, FORMAT + 1):
        raise ConfigurationError(
            f"run {run} has format {version!r}; this version reads 1 to "
            f"{FORMAT}: a later stepaside wrote it"
        )
    if version < 3:
        return RunHeader(version, OLDEST_GAME, PLAYERS)
    game, players = told.get("game"), told.get("players")
    if game not in games:
        raise ConfigurationError(
            f"game of run {run} must be one of {', '.join(games)}, got "
            f"{game!r:.40}"
        )
    if not isinstance(players, list) or not _are_names(players):
        raise ConfigurationError(
            f"players of run {run} must be 1 to {MOST_PLAYERS} names of "
            f"small letters, each once, got {players!r:.80}"
        )
    return RunHeader(version, game, tuple(players))


def _are_names(players: list[Any]) -> bool:
    named = all(isinstance(n, str) and NAME.fullmatch(n) for n in players)
    once = named and len(set(players)) == len(players)
    return once and 1 <= len(players) <= MOST_PLAYERS
