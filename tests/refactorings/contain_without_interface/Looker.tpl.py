{% block class_defs %}
class Looker(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["good", "bad"], input_keys=["where"])
{% endblock class_defs %}

{% block body %}
smach.{{ parent_type }}.add("{{ name }}", Looker(), transitions={{ transitions }}, remapping={{ remapping }})
{% endblock body %}
