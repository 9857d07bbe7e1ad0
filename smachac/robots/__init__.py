"""Descriptions of robots as data: arms, grippers, tools and bases; several robots are built in.

A description is a YAML file that names a URDF file. This room reads YAML and needs no PyBullet; the
checker and the simulation use the same descriptions.
"""
