{% extends "SimSkill.tpl.py" %}
{% block class_defs %}
class CheckPlacedState(smach.State):
    """Checks that a body lies upright and at rest at its goal pose."""

    def __init__(self, body, tolerance=0.002):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=["pose"],
            output_keys=["error"],
        )
        self.body = body
        self.tolerance = tolerance

    def execute(self, userdata):
        world = sim.world()
        result = sim.check_placed(world, self.body, userdata["pose"], self.tolerance)
        userdata["error"] = result.value
        if result.value is not None:
            print(f"placing error of {self.body}: {1000 * result.value:.2f} mm")
        return outcome_of(self, result)
{% endblock %}
