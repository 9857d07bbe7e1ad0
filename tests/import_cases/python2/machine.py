"""Python 2."""
import smach


class Beep(smach.State):
    def __init__(self, times):
        smach.State.__init__(self, outcomes=['quiet'], input_keys=['volume'])
        self.times = times

    def execute(self, userdata):
        for i in xrange(self.times):
            print "beep %d at %s" % (i, userdata.volume)
        return 'quiet'


if __name__ == '__main__':
    sm = smach.StateMachine(outcomes=['over'])
    sm.userdata.volume = 0x0f
    try:
        with sm:
            smach.StateMachine.add('BEEP', Beep(03), transitions={'quiet': 'over'})
    except smach.InvalidStateError, error:
        print error
