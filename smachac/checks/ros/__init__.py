"""Rules over messages of ROS."""
