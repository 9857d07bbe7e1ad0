{% block class_defs %}
class Solver(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["found", "none"], input_keys=["pose"], output_keys=["joints"])
{% endblock class_defs %}

{% block body %}
smach.{{ parent_type }}.add("{{ name }}", Solver(), transitions={{ transitions }}, remapping={{ remapping }})
{% endblock body %}
