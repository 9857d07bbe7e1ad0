"""The pages in docs/: their examples are run, their links are followed."""
