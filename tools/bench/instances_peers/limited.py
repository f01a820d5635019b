"""Runs programs under limits, and says what they took."""
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


def resident_mib(pid):
    try:
        with open(f'/proc/{pid}/statm') as file:
            return int(file.read().split()[1]) * PAGE / 2**20
    except (OSError, IndexError, ValueError):
        return 0


def run(command, limits, log, folder, environment=None, finished=None):
    """Runs `command`, its output into the file `log`; ends it when it is over a limit, or when `finished` (called
    again and again, if given) says that its work is done. Memory is what is resident, watched fifty times a second:
    a limit on addresses would stop programs that reserve more than they use."""
    start = time.monotonic()
    with open(log, 'wb') as output:
        child = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=output, stderr=output, cwd=folder, env=environment,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limits.cpu_s, limits.cpu_s + 5)))
    over = done = False
    pause = 0.001
    while True:
        pid, status, used = os.wait4(child.pid, os.WNOHANG)
        if pid:
            break
        if not (over or done):
            if resident_mib(child.pid) > limits.memory_mib:
                over = 'memory'
            elif time.monotonic() - start > limits.wall_s:
                over = 'time (it hangs)'
            elif finished and finished():
                done = True
            if over or done:
                child.kill()
        time.sleep(pause)
        pause = min(0.02, pause * 2)
    child.returncode = status
    usage = Usage(time.monotonic() - start, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)
    if over:
        raise Died(over)
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU:
        raise Died('time')
    if done:
        return usage
    if status:
        raise Died(reason(status, log))
    return usage


def reason(status, log):
    with open(log, errors='replace') as file:
        text = re.sub(r'\r', '\n', file.read()[-200_000:])
    lines = [line.strip() for line in text.splitlines()]
    for line in lines:
        if match := re.search(r'error: (.*)', line):
            return match[1]
    for line in lines:
        if re.search(r'Error|bad_alloc|[Tt]oo many|exceed', line):
            return line[:100]
    if os.WIFSIGNALED(status):
        return f'signal {os.WTERMSIG(status)}'
    return f'exit status {os.waitstatus_to_exitcode(status)}'
