{{ made_by }}
"""{{ title }}"""
{%- if base_header %}

{{ base_header }}
{%- endif %}
{%- if imports %}

{{ imports }}
{%- endif %}
{%- block imports %}

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach
{%- endblock %}
{%- for part in definitions %}


{{ part }}
{%- endfor %}


def build({{ build_parameters }}):
    """Build the state machine `{{ name | docstring }}`."""
{%- if main_def %}
    {{ main_def | indent(4) }}
{%- endif %}
{{ machine }}
    return {{ sm_name }}
{%- if functions %}


{{ functions }}
{%- endif %}
{%- block stop_signals %}
{%- if standalone %}


{% include "StopSignals.tpl.py" %}
{%- endif %}
{%- endblock %}


def {{ function_name | default("main") }}({{ main_parameters }}):
{%- block main %}
    """Run the state machine once and return its outcome."""
    {{ sm_name }} = build()
    if __name__ == "__main__":
        {{ ("stop_at_signals(" ~ sm_name ~ ".request_preempt)") if standalone else ("signals.stop_at_signals(" ~ sm_name ~ ")") }}
    return {{ sm_name }}.execute()
{%- endblock %}


{% block end -%}
if __name__ == "__main__":
    outcome = {{ function_name | default("main") }}()
    print(f"outcome: {outcome}")
    raise SystemExit({% block exit_code %}{% if standalone %}128 + stop_signals[0] if stop_signals else outcome is None{% else %}signals.exit_code(outcome is None){% endif %}{% endblock %})
{%- endblock %}
