{% extends "Program.tpl.py" %}
{%- block imports %}{% endblock %}
{%- block stop_signals %}{% endblock %}
{%- block main %}
{%- if ros_action %}
    """Offer the state machine as an action until a signal ends the node."""
{%- elif ros_lifecycle %}
    """Run a managed node until it is shut down, and return the outcome of the last run."""
{%- else %}
    """Run the state machine once in a ROS node and return its outcome."""
{%- endif %}
{%- if ros_once %}
    return {{ ros_once }}
{%- else %}
{%- if ros_lifecycle %}
    kind = lifecycle.LifecycleMachineNode
    node = program.start_node({{ node_name | default(name) | literal }}, arguments, kind, build={{ "configured" if ros_values else "build" }})
{%- else %}
    node = program.start_node({{ node_name | default(name) | literal }}, arguments)
{%- endif %}
    try:
{%- if ros_lifecycle %}
        return program.run(node, node)
{%- else %}
{%- if ros_values %}
        values = {{ ros_values | indent(8) }}
{%- endif %}
        {{ sm_name }} = build(node{% if ros_values %}, **values{% endif %})
{%- if introspection %}
        server = smach_ros.IntrospectionServer({{ node_name | default(name) | literal }}, {{ sm_name }}, {{ ("/" ~ name) | literal }})
        server.start()
        try:
            {{ ros_run | indent(12) }}
        finally:
            server.stop()
{%- else %}
        {{ ros_run | indent(8) }}
{%- endif %}
{%- endif %}
    finally:
        program.stop_node(node)
{%- endif %}
{%- endblock %}
{%- block end -%}
{%- if ros_lifecycle and ros_values -%}
def configured(node):
    """Build the state machine with the parameters of a node."""
    values = {{ ros_values | indent(4) }}
    return build(node, **values)


{% endif -%}
{%- set start = "program.run_main(" ~ (function_name | default("main")) ~ ", failures=" ~ ros_failures ~ ")" -%}
{%- if ros_action -%}
def run_node():
    """Run the node and return the exit code."""
{%- if ros_values %}
    try:
        {{ function_name | default("main") }}()
    except parameters.ParameterError as error:
        raise SystemExit(str(error)) from None
{%- else %}
    {{ function_name | default("main") }}()
{%- endif %}
    return program.stop_code()


{% set start = "run_node()" -%}
{%- elif ros_package -%}
def run_node():
    """Run the node, print the outcome and return the exit code for it."""
    return {{ start }}


{% set start = "run_node()" -%}
{%- endif -%}
if __name__ == "__main__":
    raise SystemExit({{ start }})
{%- endblock %}
