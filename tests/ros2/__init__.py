"""Tests of the ROS 2 runtime against live nodes."""
