{% extends "Base.tpl" %}

{% block imports %}
{{ super() }}
import string

{% if 'import_message' not in defined_headers %}
from collections import (
    deque,
)
{% do defined_headers.append('import_message') %}
{% endif %}
{% endblock imports %}

{% block main_def %}
{{ super () }}
    robot = []
    robot.append('enabled')
{% endblock main_def %}

{% block execute %}
    {{ execute | indent(4) }}

    # Disable robot
    rospy.on_shutdown(robot.clear)

    try:
        outcome = sm.execute()

        print("Complete. Ctrl-C to exit.")

        rospy.spin()
    except Exception as e:
        rospy.logerr('Error when executing state machine: ' + repr(e))
        rospy.signal_shutdown('Error when executing state machine: ' + repr(e))
{% endblock execute %}

{% block spin %}
{% endblock spin %}
