"""LoLA: the language of NAO V6, frames of joints every 12 ms."""
