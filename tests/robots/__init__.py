"""Tests of the descriptions of robots and scenes."""
