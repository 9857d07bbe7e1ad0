"""The formatter, the refactorings and the automatic fixes."""
