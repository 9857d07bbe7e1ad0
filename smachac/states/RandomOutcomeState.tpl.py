{% block imports %}
import random
{% endblock %}
{% block class_defs %}
class RandomOutcomeState(smach.State):
    """Ends with one of its outcomes by chance; a seed makes the row repeatable."""

    def __init__(self, outcomes, seed=0):
        super().__init__(outcomes=outcomes)
        self.choices = list(outcomes)
        self.random = random.Random(seed)

    def execute(self, userdata):
        return self.random.choice(self.choices)
{% endblock %}
