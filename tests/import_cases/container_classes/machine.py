"""Container classes of each kind, used twice with other arguments."""
import parts
import smach
from parts import Do


def build():
    sm = smach.StateMachine(outcomes=['ok', 'bad'], input_keys=['both'])
    sm.userdata.x = [1, {'a': None}]
    sm.userdata.k = 'x.y'
    with sm:
        sm.add('A', parts.Both('one'), {'ok': 'B'})
        sm.add('B', parts.Both('two'), {'ok': 'C', 'bad': 'C'})
        sm.add('C', parts.Row('r'), {'ok': 'D', 'bad': 'D'})
        sm.add('D', parts.Row('s', 3), {'ok': 'E', 'bad': 'E'})
        sm.add('E', parts.Each([1, 2]), {'ok': 'F', 'bad': 'F'})
        sm.add('F', parts.Each(['u', 'v']), {'ok': 'G', 'bad': 'G'})
        sm.add('G', Do(ok='fine'), {'fine': 'H'}, {'x': 'k'})
        sm.add('H', parts.Both('one'))
    return sm
