{% extends "Container.tpl.py" %}
