{% extends "Program.tpl.py" %}
{%- block imports %}
{%- if "import threading" not in imports %}

import threading
{%- endif %}
{%- if "import rospy" not in imports %}

import rospy
{%- endif %}

try:
    import smach
{%- if smach_ros or introspection %}
    import smach_ros
{%- endif %}
except ImportError:  # ROS without SMACH, as Debian has it
    from smachac.runtime import smach
{%- if smach_ros or introspection %}
    from smachac.runtime import smach_ros
{%- endif %}
{%- endblock %}
{%- block main %}
    """Run the state machine once as a node and return its outcome."""
    rospy.init_node({{ node_name | default(name) | literal }})
    {{ sm_name }} = build()
    # rospy takes Ctrl-C in the main thread, which may hold what a request to stop needs.
    rospy.on_shutdown(threading.Thread(target={{ sm_name }}.request_preempt, daemon=True).start)
{%- if introspection %}
    server = smach_ros.IntrospectionServer({{ node_name | default(name) | literal }}, {{ sm_name }}, {{ ("/" ~ name) | literal }})
    server.start()
    try:
        return {{ sm_name }}.execute()
    finally:
        server.stop()
{%- else %}
    return {{ sm_name }}.execute()
{%- endif %}
{%- endblock %}
