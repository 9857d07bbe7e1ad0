"""Carry: what it does."""

try:
    import smach
except ImportError:  # a machine without ROS
    from smachac.runtime import smach


class Carry(smach.State):
    def __init__(self, speed):
        super().__init__(
            outcomes=['done', 'not-found', 'preempted'],
            input_keys=['from', 'into', 'gently'],
            output_keys=['metres', 'seconds'],
        )
        self.speed = speed

    def execute(self, userdata):
        # userdata['from']: Pose
        # userdata.into: Pose
        # userdata.gently: bool?
        userdata.metres = None  # float
        userdata.seconds = None  # float
        return 'done'
