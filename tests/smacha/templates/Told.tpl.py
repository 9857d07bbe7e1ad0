{% from "Utils.tpl.py" import render_transitions, render_remapping %}

{% block class_defs %}
{% if 'class_told' not in defined_headers %}
class Told(smach.State):
    def __init__(self, name, outcome):
        smach.State.__init__(self, outcomes=['left','right'])
        self._name = name
        self._outcome = outcome

    def execute(self, userdata):
        rospy.loginfo('{} goes {}'.format(self._name, self._outcome))
        return self._outcome
{% do defined_headers.append('class_told') %}{% endif %}
{% endblock class_defs %}

{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Told('{{ name_param }}', '{{ outcome_param }}'){% if transitions is defined %},
{{ render_transitions(transitions) }}{% endif %}{% if remapping is defined %},
{{ render_remapping(remapping) }}{% endif %})
{% endblock body %}
