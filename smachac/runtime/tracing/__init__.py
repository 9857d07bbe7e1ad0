"""Traces of a running machine: recording its events, comparing and showing them."""
