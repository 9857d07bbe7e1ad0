"""The commands of the command line; the only room that prints."""
