"""Message definitions of ROS: files .msg, .srv and .action, and those of the common packages."""
