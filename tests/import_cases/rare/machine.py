"""Iterator, Sequence, add_auto, an empty target, arguments without names."""
import smach


class Do(smach.State):
    def __init__(self, *outcomes):
        smach.State.__init__(self, outcomes=list(outcomes) or ['done'])

    def execute(self, userdata):
        return 'done'


pack = smach.Iterator(outcomes=['packed', 'halted'], input_keys=[], output_keys=[], it=['cup', 'fork', 'plate'],
                      it_label='item', exhausted_outcome='packed')
with pack:
    one = smach.StateMachine(outcomes=['next', 'halted'], input_keys=['item'])
    with one:
        smach.StateMachine.add('WRAP', Do('done', 'halted'), {'done': 'next', 'halted': ''})
    smach.Iterator.set_contained_state('ONE', one, loop_outcomes=['next'])

box = smach.Sequence(outcomes=['done'], connector_outcome='done')
with box:
    smach.Sequence.add('FILL', Do())
    smach.Sequence.add('CLOSE', Do())

sm = smach.StateMachine(outcomes=['done', 'halted'])
with sm:
    smach.StateMachine.add_auto('A', Do(), ['done'])
    smach.StateMachine.add('B', Do(), {'done': 'PACK'})
    smach.StateMachine.add('PACK', pack, {'packed': 'BOX', 'halted': 'halted'})
    smach.StateMachine.add('BOX', box, {'done': 'done'})
sm.set_initial_state(['A'])
