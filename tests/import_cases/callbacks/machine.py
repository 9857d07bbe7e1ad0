"""Functions as states: one can be imported, a method and a nested function cannot."""
import smach


@smach.cb_interface(outcomes=['asked'], output_keys=['answer'])
def ask(userdata):
    userdata.answer = 'tea'
    return 'asked'


class Waiter(object):
    def __init__(self):
        self.menu = ['tea', 'milk']
        self.machine = smach.StateMachine(outcomes=['served', 'sorry'])
        with self.machine:
            @smach.cb_interface(outcomes=['stored'], input_keys=['choice'])
            def store(userdata):
                self.menu.remove(userdata.choice)
                return 'stored'

            smach.StateMachine.add('ASK', smach.CBState(ask), {'asked': 'CHOOSE'})
            smach.StateMachine.add('CHOOSE', smach.CBState(self.choose, outcomes=['chosen', 'unknown'],
                                                           input_keys=['answer'], output_keys=['choice']),
                                   {'chosen': 'STORE', 'unknown': 'sorry'})
            smach.StateMachine.add('STORE', smach.CBState(store), {'stored': 'served'})

    def choose(self, userdata):
        if userdata.answer not in self.menu:
            return 'unknown'
        userdata.choice = userdata.answer
        return 'chosen'


if __name__ == '__main__':
    Waiter().machine.execute()
