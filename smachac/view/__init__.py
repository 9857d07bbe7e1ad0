"""The live view: a page on loopback that shows a machine, the run that goes on, and its control."""
