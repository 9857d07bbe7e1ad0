"""Remapped keys, and userdata with a mapping and an umlaut."""
import smach


class Weigh(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['weighed'], input_keys=['weight', 'scale'], output_keys=['weight'])

    def execute(self, userdata):
        userdata.weight = userdata.scale * 2.0
        return 'weighed'


class Sort(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['light', 'heavy'], input_keys=['weight'])

    def execute(self, ud):
        if ud.weight > 30:
            return 'heavy'
        return 'light' if ud.weight < 5 else 'heavy'


class Label(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['done'], input_keys=['address'])

    def execute(self, ud):
        print(ud.address)
        return 'done'


sm = smach.StateMachine(outcomes=['shipped'])
sm.userdata.scale = 1.5
sm.userdata.parcel_address = {'street': 'Hafenstraße', 'number': 7}
with sm:
    smach.StateMachine.add('WEIGH', Weigh(), transitions={'weighed': 'SORT'}, remapping={'weight': 'parcel_weight'})
    smach.StateMachine.add('SORT', Sort(), {'light': 'LABEL', 'heavy': 'LABEL'}, {'weight': 'parcel_weight'})
    smach.StateMachine.add('LABEL', Label(), {'done': 'shipped'}, {'address': 'parcel_address'})
