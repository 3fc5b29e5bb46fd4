"""Bad input, made up from what takes input: ``python -m tools.fuzz``.

Nothing is listed here that the package knows itself: options come from the
command tree, ranges from settings, names from registries, functions from the
door. So whatever is added is tried without anyone thinking of it. ``BASES``
in ``commands.py`` only says what makes a command short.
"""

import sys
from pathlib import Path

# What stands beside us is found as pytest finds it, too.
sys.path.append(str(Path(__file__).parents[1]))
