try:
    import smach
except ImportError:  # a machine without ROS
    from smachac.runtime import smach


class Look(smach.State):
    def __init__(self):
        super().__init__(
            outcomes=["found", "none"],
            input_keys=["count", "speed"],
            output_keys=["count"],
        )

    def execute(self, userdata):
        userdata.count += 1
        return "found"
