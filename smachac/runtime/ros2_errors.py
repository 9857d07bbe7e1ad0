"""The exceptions of nodes of ROS 2 that a program or a command reports; rclpy is not needed."""


class ParameterError(ValueError):
    """The value of a parameter is not valid; the message names it."""
