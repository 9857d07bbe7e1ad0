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
    from smachac.runtime import smach_ros2 as smach_ros
{%- endif %}
{%- endblock %}
{%- block main %}
    """Run the state machine once in a ROS node and return its outcome."""
    node = program.start_node({{ node_name | default(name) | literal }}, arguments)
    try:
{%- if ros_values %}
        values = {{ ros_values | indent(8) }}
{%- endif %}
        {{ sm_name }} = build(node{% if ros_values %}, **values{% endif %})
{%- if introspection %}
        server = smach_ros.IntrospectionServer({{ node_name | default(name) | literal }}, {{ sm_name }}, {{ ("/" ~ name) | literal }})
        server.start()
        try:
            return program.run(node, {{ sm_name }})
        finally:
            server.stop()
{%- else %}
        return program.run(node, {{ sm_name }})
{%- endif %}
    finally:
        program.stop_node(node)
{%- endblock %}
{%- block end -%}
def run_node():
    """Run the node, print the outcome and return the exit code for it."""
{%- if ros_values %}
    try:
        outcome = {{ function_name | default("main") }}()
    except parameters.ParameterError as error:
        raise SystemExit(str(error)) from None
{%- else %}
    outcome = {{ function_name | default("main") }}()
{%- endif %}
    print(f"outcome: {outcome}")
    return program.exit_code(outcome, failures={{ ros_failures }})


if __name__ == "__main__":
    raise SystemExit(run_node())
{%- endblock %}
