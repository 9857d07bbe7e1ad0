{% extends "State.tpl" %}
{% from "Utils.tpl.py" import render_callbacks %}
{% block body %}
{% if callbacks is defined %}
{% set functions = render_callbacks(name, uuid, callbacks, indent=0) | replace("callbacks=", "", 1) | code %}
{% endif %}
{{ add(class_name, input_keys=input_keys, output_keys=output_keys, callbacks=functions, outcomes=outcomes) }}
{% endblock body %}
