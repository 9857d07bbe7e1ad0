{% extends "State.tpl.py" %}
{% block imports %}
{{ super() }}
{{ action | ros_import("action") }}
{% if goal is mapping %}
from smachac.runtime.smach_ros2.message_fields import filled
{% endif %}
{% if exec_timeout is not none and exec_timeout is defined or server_wait_timeout is not none and server_wait_timeout is defined %}
import rclpy.duration
{% endif %}
{% endblock imports %}
{% block body %}
{% if exec_timeout is defined and exec_timeout is not none %}{% set longest = ("rclpy.duration.Duration(seconds=" ~ exec_timeout | literal ~ ")") | code %}{% endif %}
{% if server_wait_timeout is defined and server_wait_timeout is not none %}{% set wait = ("rclpy.duration.Duration(seconds=" ~ server_wait_timeout | literal ~ ")") | code %}{% endif %}
{% set class = action | ros_class("action") %}
{{ add("smach_ros.SimpleActionState", "node" | code, action_server_namespace, class,
       goal=goal | ros_fields(action, "action", "Goal") | ros_code(action, "action"), goal_slots=goal_slots,
       goal_cb=goal_cb | exptostr | code, result_slots=result_slots, result_cb=result_cb | exptostr | code,
       input_keys=input_keys, output_keys=output_keys, exec_timeout=longest, server_wait_timeout=wait) }}
{% endblock body %}
