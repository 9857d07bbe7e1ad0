"""The live view: a page on loopback that shows a machine and its run, and controls the run."""
