"""Feedback that keeps a walking robot up."""
