{% block meta %}
name: Utils
description: Macros for templates in the style of SMACHA, with the names of SMACHA.
language: Python
framework: SMACH
type: None
{% endblock meta %}

{#- Macros that print lists and mappings as arguments of calls. -#}

{%- macro _names(argument, values, indent) -%}
{{ argument | indent(indent, true) }}{{ values | list | literal }}
{%- endmacro %}

{%- macro _pairs(argument, mapping, indent) -%}
{{ argument | indent(indent, true) }}{
{%- for key, value in mapping.items() | sort %}
{{- key | string | literal }}: {{ value | literal }}
{%- if not loop.last %},
{{ "" | indent(indent + argument | length + 1, true) }}{% endif %}
{%- endfor %}}
{%- endmacro %}

{%- macro render_outcomes(outcomes, indent=0) %}{{ _names("outcomes=", outcomes, indent) }}{% endmacro %}
{%- macro render_input_keys(input_keys, indent=37) %}{{ _names("input_keys=", input_keys, indent) }}{% endmacro %}
{%- macro render_output_keys(output_keys, indent=37) %}{{ _names("output_keys=", output_keys, indent) }}{% endmacro %}
{%- macro render_goal_slots(goal_slots, indent=51) %}{{ _names("goal_slots=", goal_slots, indent) }}{% endmacro %}
{%- macro render_result_slots(result_slots, indent=51) %}{{ _names("result_slots=", result_slots, indent) }}{% endmacro %}
{%- macro render_request_slots(request_slots, indent=51) %}{{ _names("request_slots=", request_slots, indent) }}{% endmacro %}
{%- macro render_response_slots(response_slots, indent=51) %}{{ _names("response_slots=", response_slots, indent) }}{% endmacro %}
{%- macro render_transitions(transitions, indent=23) %}{{ _pairs("transitions=", transitions, indent) }}{% endmacro %}
{%- macro render_remapping(remapping, indent=23) %}{{ _pairs("remapping=", remapping, indent) }}{% endmacro %}
{%- macro render_outcome_map(outcome_map, indent=35) %}{{ _pairs("outcome_map=", outcome_map, indent) }}{% endmacro %}

{#- Userdata of a container, one line per key. -#}

{%- macro render_userdata(namespace, userdata) -%}
{% for key, value in userdata.items() | sort(attribute="0") %}
{{ namespace | lower }}.userdata.{{ key }} = {{ value | literal }}
{% endfor %}
{%- endmacro %}

{#- Callbacks: a lambda becomes a function that writes its output key; a name refers to a function
    of the template. The functions run in alphabetical order and use the keys that they declare. -#}

{%- macro _callback_name(key, state_name, uuid) -%}
{{ key | lower | word }}_{{ state_name | lower | word }}_{{ uuid }}_lambda_cb
{%- endmacro %}

{#- Arguments: (defined_headers, class_name, state_name, uuid, input_keys, outcomes, callbacks);
    calls of older templates omit outcomes, class_name or uuid. -#}
{%- macro render_def_lambda_callbacks(defined_headers) -%}
{% set callbacks = varargs[-1] %}
{% set outcomes = varargs[4] if varargs | length > 5 and varargs[4] is defined and varargs[4] else ["succeeded"] %}
{% set input_keys = varargs[3] if varargs | length > 4 else varargs[-2] %}
{% set state_name = varargs[1] if varargs | length > 4 else varargs[0] %}
{% set uuid = (varargs[2] if varargs | length > 4 else varargs[1]) if varargs | length > 3 else "" %}
{% for key, callback in callbacks.items() if callback is expression %}
{% set function = _callback_name(key, state_name, uuid) %}
{% if function not in defined_headers %}
@smach.cb_interface(input_keys={{ input_keys | list | literal }}, output_keys=[{{ key | literal }}], outcomes={{ outcomes | list | literal }})
def {{ function }}(userdata):
    userdata[{{ key | literal }}] = ({{ callback | exptostr }})(userdata)
    return {{ outcomes | first | literal }}


{% do defined_headers.append(function) %}
{% endif %}
{% endfor %}
{%- endmacro %}

{#- Arguments: (state_name, uuid, callbacks), in older templates (state_name, callbacks). -#}
{%- macro render_callbacks(state_name, uuid, callbacks, indent=51) -%}
{% if callbacks is not mapping %}{% set callbacks, uuid = uuid, "" %}{% endif -%}
{{ "callbacks=" | indent(indent, true) }}{
{%- for key, callback in callbacks.items() %}
{%- set function = _callback_name(key, state_name, uuid) if callback is expression else callback %}
{{- function | quoted }}: {{ function if callback is expression or "." in function else function | quoted }}{% if not loop.last %}, {% endif %}
{%- endfor %}}
{%- endmacro %}

{%- macro render_init_callbacks() %}
        named = callbacks if isinstance(callbacks, dict) else {name: name for name in callbacks or ()}
        self._cbs = [named[name] for name in sorted(named)]
        for index, cb in enumerate(self._cbs):
            if isinstance(cb, str):  # name of a function or of a method of this class
                self._cbs[index] = cb = globals()[cb] if cb in globals() else getattr(self, cb)
            if smach.has_smach_interface(cb):
                self.register_input_keys(cb.get_registered_input_keys())
                self.register_output_keys(cb.get_registered_output_keys())
                self.register_outcomes(cb.get_registered_outcomes())
{%- endmacro %}

{%- macro render_execute_callbacks() %}
        for cb in self._cbs:
            view, function = userdata, getattr(cb, "_cb", cb)  # function inside smach.cb_interface
            if smach.has_smach_interface(cb):
                inputs, outputs = cb.get_registered_input_keys(), cb.get_registered_output_keys()
                view = smach.Remapper(userdata, inputs, outputs, {})
            code = getattr(function, "__code__", None)
            if getattr(function, "__self__", None) is None and code and code.co_argcount == 2:
                cb(self, view)  # function (self, userdata)
            else:
                cb(view)
{%- endmacro %}

{#- Imports; each import is printed once. -#}

{%- macro _once(defined_headers, header, line) -%}
{%- if header not in defined_headers -%}
{{ line }}
{%- do defined_headers.append(header) -%}
{%- endif -%}
{%- endmacro %}

{%- macro import_module(defined_headers, module) -%}
{{ _once(defined_headers, "import_" ~ module, "import " ~ module) }}
{%- endmacro %}

{%- macro import_module_as(defined_headers, module, new_name) -%}
{{ _once(defined_headers, "import_" ~ module ~ "_as_" ~ new_name, "import " ~ module ~ " as " ~ new_name) }}
{%- endmacro %}

{%- macro from_import(defined_headers, module, name) -%}
{{ _once(defined_headers, "from_" ~ module ~ "_import_" ~ name, "from " ~ module ~ " import " ~ name) }}
{%- endmacro %}

{%- macro from_import_as(defined_headers, module, name, new_name) -%}
{{ _once(defined_headers, "from_" ~ module ~ "_import_" ~ name ~ "_as_" ~ new_name, "from " ~ module ~ " import " ~ name ~ " as " ~ new_name) }}
{%- endmacro %}
