"""The repository itself: imports, layout, files for continuous integration."""
