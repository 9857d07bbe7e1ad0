{% from "Utils.tpl" import render_input_keys, render_transitions, render_remapping %}

{% include "State.tpl" %}

{% block imports %}
{% if 'import_message' not in defined_headers %}
from collections import (
    OrderedDict,
    deque,
)
{% do defined_headers.append('import_message') %}
{% endif %}
{% endblock imports %}

{% block class_defs %}
{% if 'class_OldMove' not in defined_headers %}
class OldMove(smach.State):
    def __init__(self, limbs, timeout=15.0, input_keys = ['limb', 'positions'], positions_cb = None):
        smach.State.__init__(self, outcomes=['succeeded', 'aborted'], input_keys=input_keys)
        self._limbs = limbs
        self._timeout = timeout
        self._positions_cb = positions_cb

    def execute(self, userdata):
        try:
            limb = self._limbs[userdata.limb]
        except (KeyError, AttributeError), e:
            print 'no such limb: %s' % e
            return 'aborted'
        limb.append((userdata.positions, self._timeout))
        return 'succeeded'
{% do defined_headers.append('class_OldMove') %}
{% endif %}
{% endblock class_defs %}

{% block main_def %}
{% if 'limbs' not in defined_headers %}
print("Initializing interfaces for each limb... ")
limbs = dict()
limbs['left'] = deque()
limbs['right'] = deque()
{% do defined_headers.append('limbs') %}
{% endif %}
{% endblock main_def %}

{% block header %}
{% endblock header %}

{% block body %}
smach.{{ parent_type }}.add('{{ name }}',
{{ '' | indent(23, true) }}OldMove(limbs{% if timeout is defined %}, timeout = {{ timeout }}{% endif %}{% if input_keys is defined %},
{{ render_input_keys(input_keys) }}{% endif %}{% if positions_cb is defined %}, positions_cb = {{ positions_cb }}{% endif %}){% if transitions is defined %},
{{ render_transitions(transitions) }}{% endif %}{% if remapping is defined %},
{{ render_remapping(remapping) }}{% endif %})
{% endblock body %}
