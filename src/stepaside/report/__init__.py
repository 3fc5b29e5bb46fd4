"""Figures, pages, films and run folders."""
