"""Modules of the user: their text, their names, their imports."""
