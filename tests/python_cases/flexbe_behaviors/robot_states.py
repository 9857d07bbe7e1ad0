from flexbe_core import EventState, Logger
from flexbe_core.proxy import ProxyActionClient


class Grasp(EventState):
    """Grasps a part."""

    def __init__(self):
        super().__init__(outcomes=['held', 'lost'], input_keys=['part', 'speed'])
        self._client = ProxyActionClient({'grasp': object})
        self._failed = False

    def execute(self, userdata):
        if self._failed:
            return 'lost'
        if self._client.has_result('grasp'):
            return 'held'

    def on_enter(self, userdata):
        self._failed = False
        try:
            self._client.send_goal('grasp', (userdata.part, userdata.speed))
        except Exception as error:
            Logger.logwarn(str(error))
            self._failed = True


class Place(EventState):
    def __init__(self, time):
        super(Place, self).__init__(outcomes=['placed'], input_keys=['shelf'])
        self._time = time

    def execute(self, userdata):
        return 'placed' if self._time else None

    def on_enter(self, userdata):
        Logger.loginfo(userdata.shelf)

    def on_exit(self, userdata):
        Logger.loginfo(userdata.part)


class Watch(EventState):
    def __init__(self):
        super().__init__(outcomes=['near'])

    def execute(self, userdata):
        return None
