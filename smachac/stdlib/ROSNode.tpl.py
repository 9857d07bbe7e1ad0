def start_node(name):
    """Start a ROS node. The first signal shuts it down; the second ends the program.

    A thread performs the shutdown: the signal handler of rospy can cause a deadlock if
    the interrupted code holds a lock. The thread reads the signal number from a pipe,
    because Python runs no signal handler while the main thread is blocked.
    """
    rospy.init_node(name, disable_signals=True)
    read, write = os.pipe()
    os.set_blocking(write, False)
    signal.set_wakeup_fd(write)

    def handle_signal(number, frame):
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)

    def shut_down():
        number = 0
        while number not in (signal.SIGINT, signal.SIGTERM):
            number = os.read(read, 1)[0]
        reason = f"signal {number}"
        threading.Thread(target=rospy.signal_shutdown, args=[reason], daemon=False).start()

    threading.Thread(target=shut_down, daemon=True).start()
    signal.signal(signal.SIGINT, handle_signal)
    signal.signal(signal.SIGTERM, handle_signal)


def preempt_at_shutdown(machine):
    """Preempt a state machine before the node shuts down and wait up to 5 s."""

    def preempt():
        end = time.monotonic() + 5.0
        machine.request_preempt()
        while machine.is_running():
            if time.monotonic() > end:
                smach.logwarn(
                    "the state machine did not end within 5 s: the node shuts down"
                )
                break
            time.sleep(0.02)

    rospy.on_shutdown(preempt)
