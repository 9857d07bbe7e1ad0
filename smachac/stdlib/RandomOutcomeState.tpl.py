{% block imports %}
import random
{% endblock %}
{% block class_defs %}
class RandomOutcomeState(smach.State):
    """Ends with one of its outcomes by chance; a seed makes the row repeatable."""

    def __init__(self, outcomes, seed=0, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.tells = "outcome" in output_keys
        self.choices = list(outcomes)
        self.random = random.Random(seed)

    def execute(self, userdata):
        outcome = self.random.choice(self.choices)
        if self.tells:
            userdata["outcome"] = outcome
        return outcome
{% endblock %}
