"""Tools of the developers: measurements, documents, faults, bad input."""
