{% block imports %}
import random
{% endblock %}
{% block class_defs %}
class RandomOutcomeState(smach.State):
    """Ends with one of its outcomes by chance; with a seed, in the same order in each run."""

    def __init__(self, outcomes, seed=None, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.tells = "outcome" in output_keys
        self.choices = list(outcomes)
        # Without a seed each state has random numbers of its own, which `random.seed` repeats.
        self.random = random.Random(random.getrandbits(64) if seed is None else seed)

    def execute(self, userdata):
        outcome = self.random.choice(self.choices)
        if self.tells:
            userdata["outcome"] = outcome
        return outcome
{% endblock %}
