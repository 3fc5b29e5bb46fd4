"""Keeping clear of what stands around, whatever a strategy wants."""
