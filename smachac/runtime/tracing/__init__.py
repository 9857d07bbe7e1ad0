"""Traces of a running machine: its events, recorded, compared and shown."""
