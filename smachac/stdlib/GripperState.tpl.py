{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class GripperState(smach.State):
    """Opens or closes a gripper."""

    def __init__(self, command, limb=None):
        super().__init__(
            outcomes=["succeeded", "aborted", "preempted"],
            output_keys=["width"],
        )
        self.command = command
        self.limb = limb

    def execute(self, userdata):
        result = sim.world().arm(self.limb).grip(self.command, self.preempt_requested)
        userdata["width"] = result.value
        return outcome_of(self, result)
{% endblock %}
