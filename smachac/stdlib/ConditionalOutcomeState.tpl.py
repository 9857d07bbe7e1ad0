{% block class_defs %}
class ConditionalOutcomeState(smach.State):
    """Ends with the first of its outcomes whose condition holds, else the default."""

    def __init__(
        self, outcomes, callbacks, default_outcome, input_keys=(), output_keys=()
    ):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.tells = "outcome" in output_keys
        self.conditions = [
            (name, callbacks[name]) for name in outcomes if name in callbacks
        ]
        self.default_outcome = default_outcome

    def execute(self, userdata):
        holding = (name for name, holds in self.conditions if holds(userdata))
        outcome = next(holding, self.default_outcome)
        if self.tells:
            userdata["outcome"] = outcome
        return outcome
{% endblock %}
