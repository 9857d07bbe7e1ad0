"""What generated programs need to run: SMACH's names for machines without ROS, and traces."""
