"""The runtime of generated programs: SMACH without ROS, its ROS states, traces, C++ headers."""
