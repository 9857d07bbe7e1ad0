{% extends "Base.tpl.py" %}
{% block imports %}
{{ imports }}

try:
    import smach
{%- if smach_ros or introspection %}
    import smach_ros
{%- endif %}

except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach
{%- if smach_ros or introspection %}
    from smachac.runtime import smach_ros2 as smach_ros
{%- endif %}
{% endblock imports %}
{% block node %}
    node = program.start_node({{ node_name | default(name) | literal }})
{% endblock node %}
{% block execute %}
    {{ execute | indent(4) }}
    outcome = program.run(node, {{ sm_name }})
    program.stop_node(node)
    print(f"outcome: {outcome}")
{% endblock execute %}
{% block defs %}
{{ defs }}
{% endblock defs %}
{% block exit_code %}
    raise SystemExit(program.stop_code())
{% endblock exit_code %}
