{% extends "Program.tpl.py" %}
{%- block imports %}

try:
    import smach
{%- if smach_ros or introspection %}
    import smach_ros
{%- endif %}
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach
{%- if smach_ros or introspection %}
    from smachac.runtime import smach_ros
{%- endif %}
{%- endblock %}
{%- block stop_signals %}


{% include "ROSNode.tpl.py" %}
{%- endblock %}
{%- block main %}
    """Run the state machine once as a ROS node and return its outcome."""
    start_node({{ node_name | default(name) | literal }})
    {{ sm_name }} = build()
    preempt_at_shutdown({{ sm_name }})
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
