"""Runs the libFuzzer programs of tests/fuzz for a while, and makes what they find smaller; and floods their targets."""
import os
import re
import resource
import shutil
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BUILT = ROOT / 'build/fuzz/tests/fuzz'
KEPT = ROOT / 'tests/fuzz/corpus'

# An input may be so long, and take so many seconds under sanitizers, on a machine that does other things too.
MOST_BYTES = {'command_line': 600, 'picture': 3000}
TIMEOUT_S = 60
SLOW_S = 5
SEEDS = {'inst': '**/*.inst', 'rifs': '**/*.rifs', 'lsys': '**/*.lsys', 'lsys_lower': '**/*.lsys'}


def targets():
    return sorted(path.name.removesuffix('_fuzzer.cpp') for path in (ROOT / 'tests/fuzz').glob('*_fuzzer.cpp'))


def kept(name):
    """The folder of what is kept for a target, as tests/fuzz/replay_test.cpp has it."""
    own = KEPT / name
    return own if own.exists() else KEPT / name.split('_')[0]


def corpus(name, out):
    """The folder in which a fuzzer keeps what it comes to; new ones begin with what is kept, and with small scenes."""
    folder = out / 'corpus' / name
    if folder.exists():
        return folder
    folder.mkdir(parents=True)
    for path in sorted(kept(name).iterdir()):
        shutil.copy(path, folder / path.name)
    for path in sorted((ROOT / 'scenes').glob(SEEDS[name])) if name in SEEDS else []:
        if path.stat().st_size <= most_bytes(name):
            shutil.copy(path, folder / path.name)
    return folder


def most_bytes(name):
    return MOST_BYTES.get(name, 2000)


def environment():
    return {**os.environ, 'UBSAN_OPTIONS': 'halt_on_error=1:print_stacktrace=1',
            'ASAN_OPTIONS': 'detect_leaks=1:allocator_may_return_null=0'}


def call(name, words, log):
    """Runs a fuzzer; returns its CPU seconds, status and text."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(log, 'wb') as file:
        status = subprocess.run([BUILT / f'{name}_fuzzer', *words], stdin=subprocess.DEVNULL, stdout=file, stderr=file,
                                env=environment()).returncode
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return cpu, status, Path(log).read_text(errors='replace')


def statistic(text, name):
    found = re.search(rf'stat::{name}:\s+(\d+)', text)
    return int(found[1]) if found else 0


def run(name, options, seconds, seed, book):
    """Goes on for so many seconds, also after findings. An input that takes long is one too."""
    folder = corpus(name, options.out)
    found = options.out / 'findings' / name
    found.mkdir(parents=True, exist_ok=True)
    deadline = time.monotonic() + seconds
    while (left := deadline - time.monotonic()) >= 1:
        log = options.out / f'{name}.log'
        cpu, status, text = call(name, [
            f'-seed={seed % 2**31 + 1}', f'-max_total_time={int(left)}', f'-max_len={most_bytes(name)}',
            f'-timeout={TIMEOUT_S}', '-rss_limit_mb=3000', '-malloc_limit_mb=1500', '-print_final_stats=1',
            '-close_fd_mask=3', '-reload=0', '-print_funcs=0', '-entropic=0', f'-artifact_prefix={found}/', folder], log)
        executions = statistic(text, 'number_of_executed_units')
        book.count(name, executions, cpu, statistic(text, 'peak_rss_mb'), statistic(text, 'slowest_unit_time_sec'))
        if status != 0:
            keep(name, text, found, book)
            if executions == 0:
                return  # it falls over what is kept: no use in trying again
        seed += 1000


def keep(name, text, found, book):
    """Minimises what was found, and names it by where it happened."""
    written = re.findall(r'Test unit written to (\S+)', text)
    if not written:
        book.find(name, 'it ended without an input', text.strip().splitlines()[-1][:200] if text.strip() else '')
        return
    artifact = Path(written[-1])
    _, _, said = call(name, ['-timeout=60', '-rss_limit_mb=3000', '-malloc_limit_mb=1500', artifact], f'{artifact}.log')
    where = signature(said) or signature(text) or artifact.name.split('-')[0]
    smaller = found / (re.sub(r'[^A-Za-z0-9_]+', '_', where)[:80] or 'finding')
    if smaller.exists():
        artifact.unlink()
        Path(f'{artifact}.log').unlink()
        book.find(name, where, str(smaller))
        return
    shutil.copy(artifact, smaller)
    Path(f'{artifact}.log').rename(f'{smaller}.log')
    if artifact.name.startswith('crash'):
        call(name, ['-minimize_crash=1', '-max_total_time=20', '-close_fd_mask=3', f'-exact_artifact_path={smaller}', artifact],
             found / 'minimise.log')
    artifact.unlink(missing_ok=True)
    book.find(name, where, str(smaller))


def signature(text):
    """What went wrong, and in which function of ours."""
    what = re.search(r'what\(\):\s+(.{0,120})|runtime error: (.{0,80})|ERROR: (?:Address|Leak)Sanitizer: (\S+)|'
                     r'ERROR: libFuzzer: (\S+)', text)
    where = re.search(r'#\d+ 0x\w+ in (?:\S+ )?((?:graftal::)[\w:~]+)', text)
    parts = [next(filter(None, what.groups()))] if what else []
    return ' in '.join(parts + ([where[1]] if where else []))


def flood(name, program, options, seconds, seed, book):
    """Changes to what the fuzzers came to, for so many seconds, through the release build; goes on after findings."""
    found = options.out / 'findings' / f'{name} (flood)'
    found.mkdir(parents=True, exist_ok=True)
    deadline = time.monotonic() + seconds
    while (left := deadline - time.monotonic()) >= 1:
        artifact = found / 'input'
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        ended = subprocess.run([program, name, str(left), str(seed), artifact, corpus(name, options.out)],
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, errors='replace')
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        said = dict(line.split(' ', 1) for line in ended.stdout.splitlines() if ' ' in line)
        book.count(f'{name} (flood)', int(said.get('executions', 0)), cpu, after.ru_maxrss / 1024,
                   float(said.get('slowest_ms', 0)) / 1000)
        if 'found' in said or ended.returncode != 0:
            what = said.get('found', f'status {ended.returncode}')[:160]
            kept_as = found / (re.sub(r'[^A-Za-z0-9_]+', '_', re.sub(r'.*does not hold', '', what))[:80] or 'finding')
            if artifact.exists():
                artifact.replace(kept_as)
            book.find(f'{name} (flood)', what, str(kept_as))
        seed += 1000
