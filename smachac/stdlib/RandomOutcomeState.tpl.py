{% block imports %}
import random
{% endblock %}
{% block class_defs %}
class RandomOutcomeState(smach.State):
    """Ends with a random outcome; a seed makes the sequence the same in each run."""

    def __init__(self, outcomes, seed=None, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.writes_outcome = "outcome" in output_keys
        self.choices = list(outcomes)
        # Without a seed, each state has its own generator with a seed from `random`.
        self.random = random.Random(random.getrandbits(64) if seed is None else seed)

    def execute(self, userdata):
        outcome = self.random.choice(self.choices)
        if self.writes_outcome:
            userdata["outcome"] = outcome
        return outcome
{% endblock %}
