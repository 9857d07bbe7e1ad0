"""The machines of bench/cpp.py: scripts, and the same machines as loops written by hand.

The state types are in bodies.hpp and bodies.cpp, the program around a machine is main.hpp.
"""

from __future__ import annotations

HITS = {
    "Hit": {"count": "int"},
    "HitPose": {"pose": "PoseStamped"},
    "HitNames": {"names": "list[str]", "count": "int"},
}
"""The state types, with their keys: each is read and written."""

PRESETS = {
    "count": "0",
    "pose": "{frame_id: base_link, stamp: 0.0}",
    "names": "[the door of the kitchen, the window, the shelf on the left]",
}


def interface(name: str, header: str = "bodies.hpp") -> str:
    """The interface of a state type, whose class is in a header."""
    keys = ", ".join(f"{key}: '{type_}'" for key, type_ in HITS[name].items())
    return f"""
name: {name}
input_keys: {{{keys}}}
output_keys: {{{keys}}}
outcomes: {{again: {{}}, done: {{}}}}
code: {{cpp: {{header: {header}, class: bench::{name}}}}}
"""


def _head(hit: str) -> str:
    presets = ", ".join(f"{key}: {PRESETS[key]}" for key in HITS[hit])
    return f"name: sm\noutcomes: [done]\nuserdata: {{{presets}}}\nstates:\n"


def ring(count: int) -> str:
    """So many states in a circle."""
    return _head("Hit") + "".join(
        f"  - S{at}: {{template: Hit, transitions: {{again: S{(at + 1) % count}, done: done}}}}\n"
        for at in range(count)
    )


def ring_by_hand(count: int) -> str:
    """The same as a loop around a switch."""
    names = [f"S{at}" for at in range(count)]
    cases = "\n".join(
        f"    case State::{name}: switch (states.{name}.execute(data)) {{\n"
        f"      case Outcome::again: state = State::S{(at + 1) % count}; break;\n"
        f"      case Outcome::done: return; }} break;"
        for at, name in enumerate(names)
    )
    return f"""
namespace hand {{
using bench::by_hand::Data, bench::by_hand::Outcome;
struct States {{ bench::by_hand::Hit {", ".join(names)}; }};
enum class State {{ {", ".join(names)} }};
void run(Data &data) {{
  States states;
  State state = State::S0;
  for (;;) switch (state) {{
{cases}
  }}
}}
}}
"""


def levels(hit: str) -> str:
    """Three levels of machines; every key crosses every border, in and out."""
    keys = f"[{', '.join(HITS[hit])}]"
    return f"""{_head(hit)}  - OUTER:
      template: StateMachine
      outcomes: [again, done]
      input_keys: {keys}
      output_keys: {keys}
      transitions: {{again: OUTER, done: done}}
      states:
        - INNER:
            template: StateMachine
            outcomes: [again, done]
            input_keys: {keys}
            output_keys: {keys}
            transitions: {{again: LAST, done: done}}
            states:
              - A: {{template: {hit}, transitions: {{again: B, done: done}}}}
              - B: {{template: {hit}, transitions: {{again: again, done: done}}}}
        - LAST: {{template: {hit}, transitions: {{again: again, done: done}}}}
"""


def levels_by_hand(hit: str) -> str:
    """The same by hand: all levels use one object by reference."""
    return f"""
namespace hand {{
using bench::by_hand::Data, bench::by_hand::Outcome;
struct Inner {{
  bench::by_hand::{hit} A, B;
  Outcome run(Data &data) {{
    enum class State {{ A, B }} state = State::A;
    for (;;) switch (state) {{
      case State::A: switch (A.execute(data)) {{
        case Outcome::again: state = State::B; break;
        case Outcome::done: return Outcome::done; }} break;
      case State::B: return B.execute(data);
    }}
  }}
}};
struct Outer {{
  Inner INNER;
  bench::by_hand::{hit} LAST;
  Outcome run(Data &data) {{
    enum class State {{ INNER, LAST }} state = State::INNER;
    for (;;) switch (state) {{
      case State::INNER: switch (INNER.run(data)) {{
        case Outcome::again: state = State::LAST; break;
        case Outcome::done: return Outcome::done; }} break;
      case State::LAST: return LAST.execute(data);
    }}
  }}
}};
void run(Data &data) {{
  Outer outer;
  for (;;) if (outer.run(data) == Outcome::done) return;
}}
}}
"""


def containers(count: int, size: int) -> str:
    """So many states in a circle of containers of one size."""
    text = [_head("Hit")]
    number = count // size
    for at in range(number):
        text.append(f"""  - C{at}:
      template: StateMachine
      outcomes: [again, done]
      input_keys: [count]
      output_keys: [count]
      transitions: {{again: C{(at + 1) % number}, done: done}}
      states:
""")
        for state in range(size):
            following = f"S{state + 1}" if state + 1 < size else "again"
            text.append(
                f"        - S{state}: {{template: Hit, "
                f"transitions: {{again: {following}, done: done}}}}\n"
            )
    return "".join(text)


def stepped_ring_by_hand(count: int) -> str:
    """The ring as a switch that is called at each step."""
    names = [f"S{at}" for at in range(count)]
    cases = "\n".join(
        f"    case State::{name}: switch (states.{name}.step(data)) {{\n"
        f"      case Outcome::running: return true;\n"
        f"      case Outcome::again: state = State::S{(at + 1) % count}; return true;\n"
        f"      case Outcome::done: state = State::S0; return false; }} return false;"
        for at, name in enumerate(names)
    )
    return f"""
namespace hand {{
using bench::by_hand::Data, bench::by_hand::Outcome;
struct States {{ bench::by_hand::Hit {", ".join(names)}; }};
enum class State : std::uint16_t {{ {", ".join(names)} }};
struct Machine {{
  Data data;
  States states;
  State state = State::S0;
  bool step(std::int64_t now) {{
    data.now = now;
    switch (state) {{
{cases}
    }}
    return false;
  }}
}};
}}
"""


def stepped_levels_by_hand(hit: str) -> str:
    """The three levels as switches that are called at each step; they use one object."""
    return f"""
namespace hand {{
using bench::by_hand::Data, bench::by_hand::Outcome;
struct Inner {{
  enum class State : std::uint16_t {{ A, B }} state = State::A;
  bench::by_hand::{hit} A, B;
  Outcome step(Data &data) {{
    switch (state) {{
      case State::A: switch (A.step(data)) {{
        case Outcome::running: return Outcome::running;
        case Outcome::again: state = State::B; return Outcome::running;
        case Outcome::done: state = State::A; return Outcome::done; }} break;
      case State::B: switch (B.step(data)) {{
        case Outcome::running: return Outcome::running;
        case Outcome::again: state = State::A; return Outcome::again;
        case Outcome::done: state = State::A; return Outcome::done; }} break;
    }}
    return Outcome::done;
  }}
}};
struct Outer {{
  enum class State : std::uint16_t {{ INNER, LAST }} state = State::INNER;
  Inner INNER;
  bench::by_hand::{hit} LAST;
  Outcome step(Data &data) {{
    switch (state) {{
      case State::INNER: switch (INNER.step(data)) {{
        case Outcome::running: return Outcome::running;
        case Outcome::again: state = State::LAST; return Outcome::running;
        case Outcome::done: state = State::INNER; return Outcome::done; }} break;
      case State::LAST: switch (LAST.step(data)) {{
        case Outcome::running: return Outcome::running;
        case Outcome::again: state = State::INNER; return Outcome::again;
        case Outcome::done: state = State::INNER; return Outcome::done; }} break;
    }}
    return Outcome::done;
  }}
}};
struct Machine {{
  Data data;
  Outer outer;
  bool step(std::int64_t now) {{
    data.now = now;
    return outer.step(data) != Outcome::done;
  }}
}};
}}
"""
