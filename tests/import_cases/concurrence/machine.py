"""A Concurrence with an outcome map, and one with functions that select the outcome."""
import smach


class Move(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['ready', 'stuck'])

    def execute(self, userdata):
        return 'ready'


def first(outcomes):
    return 'fast' if outcomes['ARM'] == 'ready' else 'slow'


both = smach.Concurrence(outcomes=['prepared', 'unprepared'], default_outcome='unprepared',
                         outcome_map={'prepared': {'ARM': 'ready', 'HEAD': 'ready'}})
with both:
    smach.Concurrence.add('ARM', Move())
    smach.Concurrence.add('HEAD', Move())

either = smach.Concurrence(outcomes=['fast', 'slow'], default_outcome='slow', outcome_cb=first,
                           child_termination_cb=lambda ended: True)
with either:
    smach.Concurrence.add('ARM', Move())
    smach.Concurrence.add('HEAD', Move())


ENDED = []


def noted(userdata, active, outcome):
    ENDED.append(outcome)


sm = smach.StateMachine(outcomes=['end', 'failed'])
sm.register_termination_cb(noted)
with sm:
    smach.StateMachine.add('BOTH', both, {'prepared': 'EITHER', 'unprepared': 'failed'})
    smach.StateMachine.add('EITHER', either, {'fast': 'end', 'slow': 'failed'})
