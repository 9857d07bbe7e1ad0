"""Tests: one folder for each room of smachac, and families of scripts with expected output."""
