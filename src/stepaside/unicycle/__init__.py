"""Pursuit and evasion with unicycles (paper, Sec. II)."""
