"""From what a player knows to where it wants to go."""
