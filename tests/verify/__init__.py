"""The comparison of targets with the interpreter."""
