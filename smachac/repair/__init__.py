"""Repairs of faults: operators propose edits, and a search proves them by a new check."""
