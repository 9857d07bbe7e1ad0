{% block class_defs %}
class Drive(smach.State):
    """Drives on."""

    def __init__(self, speed, input_keys=()):
        super().__init__(outcomes=["done"], input_keys=list(input_keys))
        self.speed = speed

    def execute(self, userdata):
        return "done"
{% endblock %}
