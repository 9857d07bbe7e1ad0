{#- Imported from ../machine.py by smachac; the lines below have the sha256 51fa9247b7d63c26 -#}
{% extends "ROSProgram.tpl.py" %}
{%- block imports %}{{ super() }}
import machine
{%- endblock %}
