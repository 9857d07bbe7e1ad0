{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class MoveToJointPositionsState(smach.State):
    """Moves one arm to joint positions along a straight line in joint space."""

    def __init__(self, limb=None, speed=1.0):
        super().__init__(
            outcomes=["succeeded", "aborted", "preempted"],
            input_keys=["positions"],
        )
        self.limb = limb
        self.speed = speed

    def execute(self, userdata):
        arm = sim.world().arm(self.limb)
        positions = userdata["positions"]
        result = arm.move_to_joints(positions, self.speed, self.preempt_requested)
        return outcome_of(self, result)
{% endblock %}
