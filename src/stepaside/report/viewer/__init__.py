"""The duel as a page in a browser: live, or replayed."""
