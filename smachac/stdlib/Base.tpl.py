{% block base_header %}
{{ made_by }}
"""{{ title }}"""

{{ base_header }}
{% endblock base_header %}

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
    from smachac.runtime import smach_ros
{%- endif %}
{% endblock imports %}


{% block defs %}
{{ defs }}


{% if is_node %}
{% include "ROSNode.tpl.py" %}
{% elif standalone %}
{% include "StopSignals.tpl.py" %}
{% endif %}
{% endblock defs %}


{% block class_defs %}
{{ class_defs }}
{% endblock class_defs %}


{% block cb_defs %}
{{ cb_defs }}
{% endblock cb_defs %}


{{ functions }}


{% block main_def %}
def {{ function_name | default("main") | lower }}():
    """Build the state machine, run it once and print its outcome."""
{% block node %}
{% if is_node %}
    start_node({{ node_name | default(name) | literal }})
{% endif %}
{% endblock node %}
    {{ main_def | indent(4) }}
{% endblock main_def %}

{% block body %}
{{ machine }}
{% endblock body %}

{% block footer %}
{% if footer %}
    with {{ sm_name }}:
        {{ footer | indent(8) }}
{% endif %}
{% endblock footer %}

{% block introspection_server %}
    sis = smach_ros.IntrospectionServer({{ node_name | default(name) | literal }}, {{ sm_name }}, {{ ("/" ~ name) | literal }})
    sis.start()
{% endblock introspection_server %}

{% block execute %}
{% if is_node %}
    preempt_at_shutdown({{ sm_name }})
{% else %}
    if __name__ == "__main__":
{% if standalone %}
        stop_at_signals({{ sm_name }}.request_preempt)
{% else %}
        signals.stop_at_signals({{ sm_name }})
{% endif %}
{% endif %}
    {{ execute | indent(4) }}
    outcome = {{ sm_name }}.execute()
    print(f"outcome: {outcome}")
{% endblock execute %}

{% block spin %}
{% endblock spin %}

{% block base_footer %}
    {{ base_footer | indent(4) }}
{% endblock base_footer %}

{% block main %}
{{ main }}

if __name__ == "__main__":
    {{ function_name | default("main") | lower }}()
{% block exit_code %}
{% if standalone %}
    raise SystemExit(128 + stop_signals[0] if stop_signals else 0)
{% else %}
    raise SystemExit(signals.exit_code())
{% endif %}
{% endblock exit_code %}
{% endblock main %}
