"""How a command ends before it is done: Ctrl-C, SIGTERM (kill, timeout, batch systems) and SIGHUP (a terminal that closes) each
end it with one line, its cleaning done and status 128 + the signal's number. Signals that the caller ignores (nohup) stay so.

`wait_for_imports` comes before imports that take long, `listen` after them. Of the main thread alone.
"""
import os
import signal
import time

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
# `timeout` sends its signal to the program and to its group, a terminal to all of its group: that is one wish.
SAME_WISH_S = 0.5


class Ended(KeyboardInterrupt):
    """A signal ends the command."""

    def __init__(self, number):
        super().__init__()
        self.status = 128 + number


def _heard():
    return [s for s in SIGNALS if signal.getsignal(s) != signal.SIG_IGN]


def wait_for_imports(line):
    """Until listen(): a signal prints the line and ends at once. Nothing has begun that would have to be cleaned. Signals that the
    program held back while Python started (tools/neritic/experiment.cpp) are let through."""
    def end(number, _):
        os.write(2, f"{line}\n".encode())
        os._exit(128 + number)
    for number in _heard():
        signal.signal(number, end)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)


def listen():
    """From here on a signal raises Ended; a later one raises it again, which cuts the cleaning short."""
    first_s, process = [], os.getpid()

    def end(number, _):
        if os.getpid() != process:
            os._exit(128 + number)  # a child that has not set handlers of its own
        now_s = time.monotonic()
        if first_s and now_s - first_s[0] < SAME_WISH_S:
            return
        first_s.append(now_s)
        raise Ended(number)
    for number in _heard():
        signal.signal(number, end)
