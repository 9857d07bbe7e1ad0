{% block class_defs %}
class ConditionalOutcomeState(smach.State):
    """Ends with the first of its outcomes whose condition holds, else the default."""

    def __init__(self, outcomes, callbacks, default_outcome, input_keys=()):
        super().__init__(outcomes=outcomes, input_keys=list(input_keys))
        self.conditions = [
            (name, callbacks[name]) for name in outcomes if name in callbacks
        ]
        self.default_outcome = default_outcome

    def execute(self, userdata):
        for outcome, holds in self.conditions:
            if holds(userdata):
                return outcome
        return self.default_outcome
{% endblock %}
