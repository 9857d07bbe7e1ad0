{% block meta %}
name: Recorder
description: Uses a helper class, and an object that is made once for all.
language: Python
framework: SMACH
type: State
tags: [core]
includes: [Shared]
extends: [State]
variables:
- action:
    description: What to do.
    type: str
- - recorder:
      description: The class of the recorder.
      type: str
input_keys:
- topic:
    description: Where from.
    type: str
- - rate:
      description: How often.
      type: float
outcomes:
- succeeded
- aborted
{% endblock meta %}

{% from "Utils.tpl.py" import import_module, from_import, render_transitions, render_remapping %}

{% extends "State.tpl.py" %}

{% if recorder is not defined %}
{% set recorder = 'Shared' %}
{% endif %}
{% include "Shared.tpl.py" %}

{% block imports %}
{{ super() }}
{{ import_module(defined_headers, 'threading') }}
{{ from_import(defined_headers, 'os', 'path') }}
{% endblock imports %}

{% block class_defs %}
{{ super() }}
{% if 'class_Recorder' not in defined_headers %}
class Recorder(smach.State):
    def __init__(self, name, recorder, action):
        smach.State.__init__(self, outcomes=['succeeded', 'aborted'], input_keys=['topic'])
        self.name = name
        self.recorder = recorder
        self.action = action

    def execute(self, userdata):
        self.recorder.items.append((self.name, self.action, userdata.topic))
        return 'succeeded'
{% do defined_headers.append('class_Recorder') %}{% endif %}
{% endblock class_defs %}

{% block main_def %}
{{ super() }}
{% if 'shared_recorder' not in defined_headers %}
shared_recorder = {{ recorder }}()
{% do defined_headers.append('shared_recorder') %}{% endif %}
{% endblock main_def %}

{% block header %}
{{ super() }}
{% if mandatory_userdata is not defined %}{% set mandatory_userdata = dict() %}{% endif %}
{% if 'rate' not in mandatory_userdata.keys() %}{% set _dummy = mandatory_userdata.update({'rate': 100.0}) %}{% endif %}
{% for key, value in mandatory_userdata.iteritems() %}
{{ parent_sm_name }}.userdata.{{ key }} = {{ value }}
{% endfor %}
{% endblock header %}

{% block body %}
# {{ class_name }} {{ uuid }} in {{ parent_name }} ({{ parent_type }}), params {{ params | default('none') }}
smach.{{ parent_type }}.add('{{ name }}',
        {{ '' | indent(23, true) }}{{ class_name }}('{{ name }}', shared_recorder, '{{ action }}'){% if transitions is defined %},
{{ render_transitions(transitions) }}{% endif %}{% if remapping is defined %},
{{ render_remapping(remapping) }}{% endif %})
{% endblock body %}

{% block footer %}
footer_of_{{ name | lower }} = 1
{% endblock footer %}

{% block execute %}
before_{{ name | lower }} = shared_recorder
{% endblock execute %}

{% block base_footer %}
after_{{ name | lower }} = 1
{% endblock base_footer %}
