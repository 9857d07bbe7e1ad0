{% extends "ParseMessages.tpl.py" %}
