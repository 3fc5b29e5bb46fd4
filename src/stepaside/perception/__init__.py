"""From percepts to sightings, and where the head looks."""
