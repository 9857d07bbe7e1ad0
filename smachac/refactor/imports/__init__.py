"""Scripts made of machines in Python, SCXML and the XML of YASMIN (docs/existing.md).

A reader for each format makes a graph; scripts.py writes it, proof.py compares the two.
"""
