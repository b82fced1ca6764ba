# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests in ParaView's own window share: `paraview --script=...` under xvfb-run.

Such a script only sets things up; Qt's events come after it. ParaView sends what scripts print to its own console, so
these write to the file descriptor."""
import os


def say(text):
    os.write(1, (text + "\n").encode())


def finish(check):
    """Ends ParaView with the check's result: else its window would stay open."""
    try:
        passed = check()
    except Exception as error:
        say(repr(error))
        passed = False
    say("passed" if passed else "FAILED")
    os._exit(0 if passed else 1)


class Steps:
    """Runs a generator by timers of an interactor, between Qt's other events. It yields a function whenever it is to
    wait until that answers true; then it goes on."""

    MILLISECONDS = 20

    def __init__(self, interactor, generator, failed):
        self.generator, self.failed = generator, failed
        self.is_due = lambda: True
        self.is_running = False
        interactor.AddObserver("TimerEvent", self.on_timer)
        interactor.CreateRepeatingTimer(self.MILLISECONDS)

    def on_timer(self, *_):
        if self.is_running:
            return
        self.is_running = True
        try:
            if self.is_due():
                self.is_due = next(self.generator)
        except StopIteration:
            finish(lambda: not self.failed)
        except Exception as error:
            say(repr(error))
            finish(lambda: False)
        self.is_running = False
