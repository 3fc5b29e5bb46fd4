"""Names of players: in game files, run folders and bodies of a world."""

import re

MOST_PLAYERS = 32  # of one game
PLAYER_NAME = re.compile(r"[a-z][a-z0-9-]{0,31}")
