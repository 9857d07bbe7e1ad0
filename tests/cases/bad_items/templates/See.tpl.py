{% block class_defs %}
class See(smach.State):
    def __init__(self):
        super().__init__(outcomes=["seen"], output_keys=["cup"])

    def execute(self, userdata):
        userdata.cup = "red"
        return "seen"
{% endblock %}
