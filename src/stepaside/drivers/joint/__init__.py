"""Control of robots by their joints, independent of the protocol."""
