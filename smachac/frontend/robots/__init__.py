"""The robot and the scene of a script, and robots of URDF files."""
