"""Rules over the properties of a script."""
