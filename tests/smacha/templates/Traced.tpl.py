{% block meta %}
name: Traced
description: A container of one's own, printed whole by its template.
type: Container
variables:
- outcomes: {description: Its outcomes., type: list of str}
{% endblock meta %}
{% from "Utils.tpl.py" import render_outcomes, render_userdata, render_transitions, render_remapping %}
{% set sm_name = ['sm_', name | lower()] | join() %}

{% block upper_comments %}
# BEGIN {{ name }}
{% endblock upper_comments %}

{% block class_defs %}
class Traced(smach.StateMachine):
    pass
{{ class_defs }}
{% endblock class_defs %}

{% block body %}
{{ sm_name }} = Traced({{ render_outcomes(outcomes) }})

{% if name in header %}{{ header[name] }}{% endif %}

{% if userdata is defined %}{{ render_userdata('sm_' + (name | lower()), userdata) }}{% endif %}
{% if name in header_userdata %}{{ header_userdata[name] }}{% endif %}

with {{ sm_name }}:

    {{ body | indent(4) }}

smach.{{ parent_type }}.add('{{ name }}', {{ sm_name }}{% if transitions is defined and parent_type != 'Concurrence' %},
{{ render_transitions(transitions) }}{% endif %}{% if remapping is defined %},
{{ render_remapping(remapping) }}{% endif %})
{% endblock body %}
