{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class ReadEndpointPoseState(smach.State):
    """Reads the present pose of the tool of an arm."""

    def __init__(self, limb=None):
        super().__init__(outcomes=["succeeded"], output_keys=["pose"])
        self.limb = limb

    def execute(self, userdata):
        userdata["pose"] = sim.world().arm(self.limb).tip_pose()
        return "succeeded"
{% endblock %}
