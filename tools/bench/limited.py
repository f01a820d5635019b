"""Runs programs under limits, and says what they took."""
import contextlib
import os
import re
import resource
import signal
import subprocess
import time

PAGE = os.sysconf('SC_PAGE_SIZE')


class Died(Exception):
    """A contender stopped: over a limit of ours, or by itself."""


class Usage:
    """What programs took, one after the other: seconds add up, the peak is the largest."""

    def __init__(self, wall=0.0, cpu=0.0, peak=0.0):
        self.wall, self.cpu, self.peak = wall, cpu, peak  # seconds, seconds, MiB

    def add(self, other):
        self.wall += other.wall
        self.cpu += other.cpu
        self.peak = max(self.peak, other.peak)


class Limits:
    def __init__(self, cpu_s, memory_mib):
        self.cpu_s, self.memory_mib = cpu_s, memory_mib
        self.wall_s = 3 * cpu_s  # for what hangs without working


class Outcome:
    """How a program ended. `over` is None, 'time', 'memory' or 'time (it hangs)'; `signal` is None unless one ended it."""

    def __init__(self, usage, over, code, ended_by, done):
        self.usage, self.over, self.code, self.signal, self.done = usage, over, code, ended_by, done


def family(pid):
    """The process and all below it."""
    found = [pid]
    for parent in found:
        try:
            for thread in os.listdir(f'/proc/{parent}/task'):
                with open(f'/proc/{parent}/task/{thread}/children') as file:
                    found += map(int, file.read().split())
        except OSError:
            pass
    return found


def resident_mib(pid):
    total = 0
    for member in family(pid):
        try:
            with open(f'/proc/{member}/statm') as file:
                total += int(file.read().split()[1]) * PAGE / 2**20
        except (OSError, IndexError, ValueError):
            pass
    return total


def observe(command, limits, output, errors, folder, environment=None, finished=None):
    """Runs `command` and says how it ended. Ends it, with all that it has started, when it is over a limit, or when
    `finished` (called again and again, if given) says that its work is done. The limit of CPU seconds holds for each of
    its processes. Memory is what is resident in all of them, watched fifty times a second: a limit on addresses would
    stop programs that reserve more than they use; the peak is at least that of the largest, by the kernel's account."""
    start = time.monotonic()
    with open(output, 'wb') as out, open(errors, 'wb') if errors != output else contextlib.nullcontext() as err:
        child = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=out, stderr=err or out, cwd=folder, env=environment,
            start_new_session=True,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limits.cpu_s, limits.cpu_s + 5)))
    over, done, pause, most = None, False, 0.001, 0
    while True:
        pid, status, used = os.wait4(child.pid, os.WNOHANG)
        if pid:
            break
        if not (over or done):
            now = resident_mib(child.pid)
            most = max(most, now)
            if now > limits.memory_mib:
                over = 'memory'
            elif time.monotonic() - start > limits.wall_s:
                over = 'time (it hangs)'
            elif finished and finished():
                done = True
            if over or done:
                os.killpg(child.pid, signal.SIGKILL)
        time.sleep(pause)
        pause = min(0.02, pause * 2)
    child.returncode = status
    usage = Usage(time.monotonic() - start, used.ru_utime + used.ru_stime, max(used.ru_maxrss / 1024, most))
    ended_by = os.WTERMSIG(status) if os.WIFSIGNALED(status) else None
    if ended_by == signal.SIGXCPU:
        over = over or 'time'
    return Outcome(usage, over, None if ended_by else os.waitstatus_to_exitcode(status), ended_by, done)


def run(command, limits, log, folder, environment=None, finished=None):
    """As `observe`, its output into the file `log`; raises Died unless it did its work."""
    outcome = observe(command, limits, log, log, folder, environment, finished)
    if outcome.over:
        raise Died(outcome.over)
    if (outcome.signal or outcome.code) and not outcome.done:
        raise Died(reason(outcome, log))
    return outcome.usage


def reason(outcome, log):
    with open(log, errors='replace') as file:
        text = re.sub(r'\r', '\n', file.read()[-200_000:])
    lines = [line.strip() for line in text.splitlines()]
    for line in lines:
        if match := re.search(r'error: (.*)', line):
            return match[1]
    for line in lines:
        if re.search(r'Error|bad_alloc|[Tt]oo many|exceed', line):
            return line[:100]
    if outcome.signal:
        return f'signal {outcome.signal}'
    return f'exit status {outcome.code}'
