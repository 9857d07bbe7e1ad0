{% extends "State.tpl.py" %}
{% block imports %}
{{ super() }}
{% if poll_rate is defined or timeout is defined %}
from smachac.runtime.smach_ros2.ros import duration
{% endif %}
{% endblock imports %}
{% block body %}
{% if poll_rate is defined and poll_rate is not none %}{% set period = ("duration(" ~ poll_rate | literal ~ ")") | code %}{% endif %}
{% if timeout is defined and timeout is not none %}{% set longest = ("duration(" ~ timeout | literal ~ ")") | code %}{% endif %}
{{ add("smach_ros.ConditionState", "node" | code, cond_cb | exptostr | code, input_keys=input_keys, poll_rate=period, timeout=longest, max_checks=max_checks) }}
{% endblock body %}
