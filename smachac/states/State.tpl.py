{% extends "State.tpl" %}
{% from "Utils.tpl.py" import render_input_keys, render_output_keys, render_outcomes, render_callbacks, render_transitions, render_remapping %}
{% block body %}
smach.{{ parent_type }}.add({{ name | quoted }}, {{ class_name }}(
{%- if input_keys is defined %}{{ render_input_keys(input_keys, indent=0) }}, {% endif %}
{%- if output_keys is defined %}{{ render_output_keys(output_keys, indent=0) }}, {% endif %}
{%- if callbacks is defined %}{{ render_callbacks(name, uuid, callbacks, indent=0) }}, {% endif %}
{%- if outcomes is defined %}{{ render_outcomes(outcomes, indent=0) }}{% endif %})
{%- if transitions is defined %},
{{ render_transitions(transitions) }}{% endif %}
{%- if remapping is defined %},
{{ render_remapping(remapping) }}{% endif %})
{% endblock body %}
