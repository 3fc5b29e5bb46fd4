"""Equations of the paper and the games of unicycles that follow from them."""
