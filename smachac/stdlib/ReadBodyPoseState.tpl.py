{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class ReadBodyPoseState(smach.State):
    """Reads the present pose of a body of the simulated world."""

    def __init__(self, body):
        super().__init__(outcomes=["succeeded", "aborted"], output_keys=["pose"])
        self.body = body

    def execute(self, userdata):
        world = sim.world()
        if self.body not in world.bodies:
            smach.logwarn(f"ReadBodyPoseState: there is no body `{self.body}`")
            return "aborted"
        userdata["pose"] = world.measured_pose(self.body)
        return "succeeded"
{% endblock %}
