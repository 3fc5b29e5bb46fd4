"""What each role of a game looks for."""

from ..sensing.colour_detector import BLUE, RED

LOOKS = {"pursuer": BLUE, "evader": RED}  # by who looks
