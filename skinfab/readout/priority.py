"""Real-time priority for a loop that must not wait for other programs, where the system grants it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def real_time() -> Iterator[bool]:
    """Run before all ordinary programs: this thread, and those that it starts meanwhile.

    Linux grants that to root and to users with a limit on it (``rtprio`` in /etc/security/limits.conf). It is asked for the
    lowest such priority, in turn with others of that kind; the kernel itself keeps a twentieth of each core for the rest.

    Yields
    ------
    bool
        Was it granted? Where not, all goes on as usual.

    Examples
    --------
    >>> with real_time() as granted:
    ...     os.sched_getscheduler(0) == (os.SCHED_RR if granted else os.SCHED_OTHER)
    True
    """
    policy, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(os.sched_get_priority_min(os.SCHED_RR)))
    except OSError:  # not for this user, or not on this system
        yield False
        return
    try:
        yield True
    finally:
        os.sched_setscheduler(0, policy, parameters)
