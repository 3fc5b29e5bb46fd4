"""Options, each declared once, and settings built from them."""
