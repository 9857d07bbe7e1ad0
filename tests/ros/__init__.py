"""The runtime and generated programs against live ROS nodes."""
