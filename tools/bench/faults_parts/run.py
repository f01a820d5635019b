"""One run of a command with a fault in it."""
import os
import resource
import shutil
import struct
import subprocess
from pathlib import Path

from left_over import orphans, tree

RECORD_BYTES = 4096
LIMIT_CPU_S, LIMIT_WALL_S = 30, 300  # other work may keep the machine busy
OLD, PNG_END = b'old', b'IEND\xaeB`\x82'


def kinds_of(record):
    """The names and the calls of all kinds, and the number of calls that failed."""
    calls, at = {}, 8
    while record[at:at + 1] != b'\0':
        name, count = struct.unpack_from('8sQ', record, at)
        calls[name.rstrip(b'\0').decode()] = count
        at += 16
    return calls, struct.unpack_from('Q', record)[0]


class Run:
    def __init__(self, status, over, message, outputs, temporaries, calls, struck, orphans):
        self.status, self.over, self.message, self.outputs = status, over, message, outputs
        self.temporaries, self.calls, self.struck, self.orphans = temporaries, calls, struck, orphans

    def findings(self, good, kind):
        said = self.message[-300:]
        if self.over:
            yield 'no end'
            return
        if self.status < 0:
            yield f'signal {-self.status}: {said}'
        elif self.status not in (0, 1, 3):
            yield f'status {self.status}: {said}'
        elif self.status == 0 and self.different(good, kind) and not self.coarser():
            yield f'status 0 with other outputs: {self.different(good, kind)}: {said}'
        elif self.status != 0 and not self.message.strip():
            yield f'status {self.status} without a message'
        if self.status != 0 and (torn := self.torn(good)):
            yield f'status {self.status} leaves {torn}: {said}'
        # What cannot be removed stays.
        if kind != 'unlink' and self.temporaries:
            yield f'status {self.status} leaves the temporaries {self.temporaries}: {said}'
        if self.orphans:
            yield f'status {self.status} leaves the processes {self.orphans}'

    def coarser(self):
        """Where the memory does not suffice for a cut, a coarser one is tried, and said."""
        return 'of memory allow an error of' in self.message

    def different(self, good, kind):
        names = {*self.outputs, *good.outputs}
        if kind == 'unlink':  # the frames of an animation too
            names = {name for name in names if not name.startswith('out.frames/')}
        return sorted(name for name in names if self.outputs.get(name) != good.outputs.get(name))

    def torn(self, good):
        """Files under final names that are not what was there before. Frames of an animation stay for the next run."""
        return [name for name, data in self.outputs.items() if name != 'stdout' and data != OLD
                and not (name.startswith('out/') and data == good.outputs[name])
                and not (name.startswith('out.frames/') and data.endswith(PNG_END))]


class Place:
    """A folder for one run after the other."""

    def __init__(self, folder, models, program, shim):
        folder.mkdir()
        self.program, self.shim = program, shim
        self.here, self.temporary, self.record = folder / 'here', folder / 'tmp', folder / 'record'
        self.stdout, self.stderr = folder / 'stdout', folder / 'stderr'
        self.models = models

    def prepare(self, output):
        for fresh in (self.here, self.temporary):
            shutil.rmtree(fresh, ignore_errors=True)
            fresh.mkdir()
        (self.here / 'models').symlink_to(self.models)
        if output and not output.endswith('/'):
            (self.here / output).write_bytes(OLD)
        self.record.write_bytes(bytes(RECORD_BYTES))

    def run(self, command, fault=None):
        words, output = command
        self.prepare(output)
        environment = {**os.environ, 'TMPDIR': str(self.temporary), 'LD_PRELOAD': self.shim,
                       'FAULTS_RECORD': str(self.record)}
        if fault:
            environment['FAULTS'] = fault
        over = False
        with open(self.stdout, 'wb') as out, open(self.stderr, 'wb') as err:
            process = subprocess.Popen(
                [self.program, *words, *(['-o', output] if output else [])], cwd=self.here, env=environment,
                stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_CPU_S, LIMIT_CPU_S)))
            try:
                process.wait(LIMIT_WALL_S)
            except subprocess.TimeoutExpired:
                over = True
                os.killpg(process.pid, 9)
                process.wait()
        calls, struck = kinds_of(self.record.read_bytes())
        files = tree(self.here)
        temporaries = [name for name in files if Path(name).name.startswith('.')] + os.listdir(self.temporary)
        outputs = {name: data for name, data in files.items()
                   if not name.startswith('models/') and not Path(name).name.startswith('.')}
        outputs['stdout'] = self.stdout.read_bytes()
        return Run(process.returncode, over, self.stderr.read_text(errors='replace').strip(), outputs, temporaries,
                   calls, struck, orphans(process.pid))
