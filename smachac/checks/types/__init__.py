"""Rules over values and their types, limits and units."""
