"""Refactoring: scripts are formatted, fixed, renamed and restructured. Text in, text out."""
