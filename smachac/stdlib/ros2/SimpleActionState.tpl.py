{% extends "State.tpl.py" %}
{% set callback = goal_cb if goal_cb is defined else none %}
{% set is_set_later = callback is not none or goal_slots is defined and goal_slots is not none or goal is defined and goal is not none and goal is not mapping %}
{% block imports %}
{{ super() }}
{{ action | ros_import("action") }}
{% if goal is mapping %}
from smachac.runtime.smach_ros2.message_fields import filled
{% endif %}
{% if is_set_later %}
from smachac.runtime.smach_ros2.message_fields import checking
{% endif %}
{% if exec_timeout is not none and exec_timeout is defined or server_wait_timeout is not none and server_wait_timeout is defined %}
from smachac.runtime.smach_ros2.ros import duration
{% endif %}
{% endblock imports %}
{% block body %}
{% if exec_timeout is defined and exec_timeout is not none %}{% set longest = ("duration(" ~ exec_timeout | literal ~ ")") | code %}{% endif %}
{% if server_wait_timeout is defined and server_wait_timeout is not none %}{% set wait = ("duration(" ~ server_wait_timeout | literal ~ ")") | code %}{% endif %}
{% set class = action | ros_class("action") %}
{% if is_set_later %}{% set checks = callback | checking(class ~ ".Goal") %}{% endif %}
{{ add("smach_ros.SimpleActionState", "node" | code, action_server_namespace, class,
       goal=goal | ros_fields(action, "action", "Goal") | ros_code(action, "action"), goal_slots=goal_slots,
       goal_cb=checks, result_slots=result_slots, result_cb=result_cb | exptostr | code,
       input_keys=input_keys | besides(goal_slots, goal_cb, result_cb),
       output_keys=output_keys | besides(result_slots, goal_cb, result_cb), exec_timeout=longest, server_wait_timeout=wait) }}
{% endblock body %}
