"""Options of the commands, declared once, and settings built from them."""
