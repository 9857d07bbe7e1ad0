{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class GripperInterfaceState(smach.State):
    """Opens or closes a gripper."""

    def __init__(self, command, limb=None):
        super().__init__(outcomes=["succeeded", "aborted", "preempted"])
        self.command = command
        self.limb = limb

    def execute(self, userdata):
        result = sim.world().arm(self.limb).grip(self.command, self.preempt_requested)
        return outcome_of(self, result)
{% endblock %}
