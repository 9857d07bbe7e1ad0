{% block meta %}
name: State
description: Blocks and macros for templates in the style of SMACHA, without the line that adds the state.
language: Python
framework: SMACH
type: None
{% endblock meta %}
{#- Templates that extend this template use the macros without an import, as in SMACHA. -#}
{% from "Utils.tpl.py" import render_input_keys, render_output_keys, render_outcomes, render_callbacks %}
{% from "Utils.tpl.py" import render_transitions, render_remapping, render_def_lambda_callbacks, render_userdata %}
{% block base_header %}{% endblock base_header %}
{% block imports %}{% endblock imports %}
{% block defs %}{% endblock defs %}
{% block class_defs %}{% endblock class_defs %}
{% block cb_defs %}
{% if callbacks is defined %}
{{ render_def_lambda_callbacks(defined_headers, class_name, name, uuid, input_keys | default([]), outcomes, callbacks) }}
{% endif %}
{% endblock cb_defs %}
{% block main_def %}{% endblock main_def %}
{% block header %}{% endblock header %}
{% block header_userdata %}
{% if userdata is defined %}{{ render_userdata(parent_sm_name, userdata) }}{% endif %}
{% endblock header_userdata %}
{% block footer %}{% endblock footer %}
{% block introspection_server %}{% endblock introspection_server %}
{% block execute %}{% endblock execute %}
{% block spin %}{% endblock spin %}
{% block base_footer %}{% endblock base_footer %}
{% block main %}{% endblock main %}
