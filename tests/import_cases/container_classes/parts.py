import smach
class Do(smach.State):
    """Moves a part."""
    def __init__(self, what='a', *, ok='ok'):
        smach.State.__init__(self, outcomes=[ok, 'bad'], input_keys=['k', 'x'], output_keys=['k'], io_keys=['both'])
        self.value = what
    def execute(self, ud):
        ud.k = ud.x
        return 'ok'
class Both(smach.Concurrence):
    def __init__(self, what):
        smach.Concurrence.__init__(self, outcomes=['ok', 'bad'], default_outcome='bad', outcome_map={'ok': {'L': 'ok', 'R': 'ok'}}, input_keys=['x'])
        with self:
            smach.Concurrence.add('L', Do(what))
            smach.Concurrence.add('R', Do(), remapping={'k': 'k2'})
class Row(smach.Sequence):
    def __init__(self, what, n=2):
        smach.Sequence.__init__(self, outcomes=['ok', 'bad'], connector_outcome='ok')
        with self:
            for i in range(n):
                smach.Sequence.add('D%d' % i, Do(what))
class Each(smach.Iterator):
    def __init__(self, items):
        smach.Iterator.__init__(self, outcomes=['ok', 'bad'], input_keys=[], output_keys=[], it=items, it_label='x', exhausted_outcome='ok')
        with self:
            smach.Iterator.set_contained_state('BODY', Row('in', n=1), loop_outcomes=['ok'], final_outcome_map={'bad': 'bad'})
