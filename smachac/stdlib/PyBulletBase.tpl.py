{% extends "Program.tpl.py" %}
{%- block imports %}{{ super() }}
{%- if "from smachac import sim" not in imports %}
from smachac import sim
{%- endif %}
from smachac.runtime import signals
{%- endblock %}
{%- block stop_signals %}{% endblock %}
{%- block main %}
    """Run the state machine once in a simulated world and return its outcome."""
    with sim.World(robot={% block robot %}{{ robot | default("panda") | literal }}{% endblock %}{% if scene %}, scene={{ scene | literal }}{% endif %}) as world:
        {{ sm_name }} = build()
        world.attach({{ sm_name }}, {{ sm_name | tojson }})
        if __name__ == "__main__":
            signals.stop_at_signals({{ sm_name }})
        outcome = {{ sm_name }}.execute()
        print(f"simulated time: {world.time:.2f} s")
        for name in world.bodies:
            x, y, z = world.pose(name)[0]
            rest = "at rest" if world.at_rest(name) else "moving"
            print(f"{name}: x {x:.4f} m, y {y:.4f} m, z {z:.4f} m, {rest}")
    return outcome
{%- endblock %}
{%- block exit_code %}signals.exit_code(outcome is None){% endblock %}
