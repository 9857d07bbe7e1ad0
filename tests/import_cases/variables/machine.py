"""Outcomes and transitions in variables; a parameter with the name of a field of scripts."""
import smach

DONE, STOPPED = 'done', 'stopped'
COMMON = {STOPPED: STOPPED}


class Work(smach.State):
    def __init__(self, outcomes):
        smach.State.__init__(self, outcomes=outcomes + [STOPPED])
        self.first = outcomes[0]

    def execute(self, userdata):
        return self.first


def with_common(**own):
    table = dict(COMMON)
    table.update(own)
    return table


sm = smach.StateMachine(outcomes=[DONE, STOPPED])
to_check = {'dry': 'CHECK', STOPPED: STOPPED}
with sm:
    smach.StateMachine.add('PAINT', Work(['dry']), transitions=to_check)
    smach.StateMachine.add('CHECK', Work(['good', 'wet']),
                           transitions=with_common(good=DONE,
                                                   wet='PAINT'))
