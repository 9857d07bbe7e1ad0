def start_node(name):
    """Make the program a node that a signal shuts down, and a second one ends.

    A thread does it: rospy's own handler waits for ever when what it interrupts holds a lock. It
    reads the signal from a pipe, for the main thread may go on waiting and run no handler.
    """
    rospy.init_node(name, disable_signals=True)
    read, write = os.pipe()
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write)

    def note(number, frame):
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)

    def shut_down():
        number = 0
        while number not in (signal.SIGINT, signal.SIGTERM):
            number = os.read(read, 1)[0]
        reason = f"signal {number}"
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
