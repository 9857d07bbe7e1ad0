{% extends "Base.tpl.py" %}
{% set is_node = true %}
