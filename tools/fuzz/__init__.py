"""Fuzzing with invalid input: ``python -m tools.fuzz``.

Inputs are generated from the package itself: options from the command tree,
ranges from the settings, names from the registries, functions from the public
interface. New options are therefore covered without further work. ``BASES`` in
``commands.py`` only lists arguments that keep commands short.
"""

import sys
from pathlib import Path

# What stands beside us is found as pytest finds it, too.
sys.path.append(str(Path(__file__).parents[1]))
