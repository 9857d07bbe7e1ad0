{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class CheckGraspState(smach.State):
    """Looks whether the gripper holds something."""

    def __init__(self, limb=None, body=None):
        super().__init__(outcomes=["succeeded", "aborted"])
        self.limb = limb
        self.body = body

    def execute(self, userdata):
        return outcome_of(self, sim.world().arm(self.limb).check_grasp(self.body))
{% endblock %}
