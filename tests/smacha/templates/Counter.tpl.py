{% from "Utils.tpl.py" import render_transitions, render_remapping %}

{% block class_defs %}
# One class for each use, as scripts of the tutorials have it.
class Counter(smach.State):
    def __init__(self):
        smach.State.__init__(self,
                             outcomes=['again','enough']{% if remapping is defined %},
                             input_keys=['count_in'],
                             output_keys=['count_out']){% else %})
        self.count = 0{% endif %}

    def execute(self, userdata):
        rospy.loginfo('Executing state {{ name }}'){% if remapping is defined %}
        if userdata.count_in < 3:
            userdata.count_out = userdata.count_in + 1{% else %}
        if self.count < 3:
            self.count += 1{% endif %}
            return 'again'
        else:
            return 'enough'
{% endblock class_defs %}

{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Counter(){% if transitions is defined %},
{{ render_transitions(transitions) }}{% endif %}{% if remapping is defined %},
{{ render_remapping(remapping) }}{% endif %})
{% endblock body %}
