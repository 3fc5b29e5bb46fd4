"""Header of the summary of a run folder: format, game and players."""

import re
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError

FORMAT = 3  # of a run folder
MAX_PLAYERS = 6
NAME = re.compile(r"[a-z][a-z0-9-]{0,31}")


class RunHeader(NamedTuple):
    """Format, game and players of a run folder.

    Attributes:
        version: Format of the folder.
        game: Name of the game.
        players: Names of the players, in the order in which they act.
    """

    version: int
    game: str
    players: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Return plain values by name."""
        return {
            "format": self.version,
            "game": self.game,
            "players": list(self.players),
        }

    def without(self, plain: dict[str, Any]) -> dict[str, Any]:
        """Return the entries of a summary without those of the header."""
        return {k: v for k, v in plain.items() if k not in self.to_json()}


def read_head(plain: Any, run: str, games: tuple[str, ...]) -> RunHeader:
    """Parse the header of a summary.

    Args:
        plain: Summary, as JSON.
        run: Name of the run, for messages.
        games: Known games.

    Raises:
        ConfigurationError: If format, game or players are invalid.
    """
    entries = plain if isinstance(plain, dict) else {}
    version = entries.get("format")
    if type(version) is not int or version != FORMAT:
        raise ConfigurationError(
            f"format of run {run} must be {FORMAT}, got {version!r:.40}"
        )
    game, players = entries.get("game"), entries.get("players")
    if game not in games:
        raise ConfigurationError(
            f"game of run {run} must be one of {', '.join(games)}, got "
            f"{game!r:.40}"
        )
    if not isinstance(players, list) or not _are_names(players):
        raise ConfigurationError(
            f"players of run {run} must be 1 to {MAX_PLAYERS} unique names in "
            f"lower case, got {players!r:.80}"
        )
    return RunHeader(version, game, tuple(players))


def _are_names(players: list[Any]) -> bool:
    valid = all(isinstance(n, str) and NAME.fullmatch(n) for n in players)
    unique = valid and len(set(players)) == len(players)
    return unique and 1 <= len(players) <= MAX_PLAYERS
