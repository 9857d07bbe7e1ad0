{% extends "ROSBase.tpl.py" %}
