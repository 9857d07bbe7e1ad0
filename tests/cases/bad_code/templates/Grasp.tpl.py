{% block class_defs %}
class {{ class_name }}(smach.State):
    def __init__(self):
        super().__init__(outcomes=["held", "missed", "preempted"], input_keys=["target"])

    def execute(self, userdata):
        print(userdata.target)
        return "preempted" if self.preempt_requested() else "held"
{% endblock %}
