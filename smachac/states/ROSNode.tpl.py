def start_node(name):
    """Make the program a node that a signal shuts down, and a second one ends.

    A thread does it: rospy's own handler waits for ever when what it interrupts holds a lock.
    """
    rospy.init_node(name, disable_signals=True)
    signals = queue.SimpleQueue()

    def note(number, frame):
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signals.put(number)

    def shut_down():
        reason = f"signal {signals.get()}"
        threading.Thread(target=rospy.signal_shutdown, args=[reason], daemon=False).start()

    threading.Thread(target=shut_down, daemon=True).start()
    signal.signal(signal.SIGINT, note)
    signal.signal(signal.SIGTERM, note)


def preempt_at_shutdown(machine):
    """Let a machine end by itself, for up to 5 s, before the node shuts down."""

    def preempt():
        end = time.monotonic() + 5.0
        machine.request_preempt()
        while machine.is_running():
            if time.monotonic() > end:
                smach.logwarn("the machine goes on for 5 s: the node shuts down")
                break
            time.sleep(0.02)

    rospy.on_shutdown(preempt)
