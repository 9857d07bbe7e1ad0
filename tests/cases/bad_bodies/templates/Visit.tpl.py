{% block class_defs %}
class Visit(smach.State):
    """Moves to a pose."""

    def __init__(self):
        super().__init__(outcomes=["ok"])

    def execute(self, userdata):
        move_to(userdata.pose)
{% endblock %}
