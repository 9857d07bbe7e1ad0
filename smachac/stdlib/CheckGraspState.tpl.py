{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class CheckGraspState(smach.State):
    """Checks that the gripper holds a body."""

    def __init__(self, limb=None, body=None):
        super().__init__(outcomes=["succeeded", "aborted"])
        self.limb = limb
        self.body = body

    def execute(self, userdata):
        return outcome_of(self, sim.world().arm(self.limb).check_grasp(self.body))
{% endblock %}
