"""Games of several unicycles: batches, cyclic pursuit, Apollonius cells."""
