{% extends "StateMachine.tpl.py" %}
