"""Every scene as glTF, through Khronos' gltf-validator."""
import concurrent.futures
import json
import re
import sys
import time
from pathlib import Path

# What does not fit into the first at any --error may be as large as the second with the largest one.
LIMIT, LAST_LIMIT = '64M', '512M'


class Known:
    """What was found of scenes before, one line of JSON each, so that a run that was ended can go on. Only what the same
    commit found counts."""

    def __init__(self, path, commit):
        self.path, self.commit, self.found = path, commit, {}
        if path and path.exists():
            for line in path.read_text().splitlines():
                row = json.loads(line)
                if row['commit'] == commit:
                    self.found[row['scene']] = row

    def add(self, row):
        self.found[row['scene']] = row
        if self.path:
            with self.path.open('a') as file:
                file.write(json.dumps({**row, 'commit': self.commit}) + '\n')


def examined(study, scene):
    """The words with which a file of the scene could be written, what was said of a larger one, and what the validator
    finds in it."""
    begin, name = time.monotonic(), scene.replace('/', '_') + '.glb'
    words, said, refused = study.export(scene, '', name, '--limit', LIMIT)
    if words is None:
        words, said, _ = study.export(scene, '--error 1024', name, '--limit', LAST_LIMIT)
    row = {'scene': scene, 'words': words, 'refused': refused, 'said': said}
    if words is not None:
        row.update(json.loads(study.run('node', 'validate.js', name).stdout))
        (study.folder / name).unlink()
    row['seconds'] = round(time.monotonic() - begin, 1)
    return row


def every_scene(study, scenes, jobs, known):
    """A row of each scene, in their order; says on stderr how far it is."""
    waiting = [scene for scene in scenes if scene not in known.found]
    done = len(scenes) - len(waiting)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for future in concurrent.futures.as_completed([pool.submit(examined, study, scene) for scene in waiting]):
            row, done = future.result(), done + 1
            known.add(row)
            verdict = (f'{row["errors"]} errors, {row["warnings"]} warnings' if row['words'] is not None
                       else f'not written: {row["said"]}')
            print(f'{done}/{len(scenes)} {row["scene"]} {row["words"]}: {verdict}, {row["seconds"]} s', file=sys.stderr, flush=True)
    return [known.found[scene] for scene in scenes]


def told(said):
    """How large the file would be; else all that was said, without the names of files."""
    size = re.search(r'about ([\d.e+]+) bytes', said)
    if size:
        return f'{float(size[1]) / 2**20:.3g} MiB'
    return said.split('error: ')[-1].removeprefix('graftal: ').replace('|', '\\|')


def table(rows, fallen_short):
    written = [row for row in rows if row['words'] is not None]
    for row in rows:
        if row['words'] is None:
            fallen_short.append(f'{row["scene"]}: not written: {row["said"]}')
        elif row['errors'] or row['warnings']:
            fallen_short.append(f'{row["scene"]}: gltf-validator: {row["errors"]} errors, {row["warnings"]} warnings, {row["says"]}')
    yield '| scenes | written | without an error | without a warning |'
    yield '|---|---|---|---|'
    yield (f'| {len(rows)} | {len(written)} | {sum(row["errors"] == 0 for row in written)} | '
           f'{sum(row["warnings"] == 0 for row in written)} |')
    yield ''
    coarse = [row for row in written if row['refused']]
    yield f'{len(written) - len(coarse)} of them are written as they are. The others would be larger than {LIMIT[:-1]} MiB, and have'
    yield f'a larger `--error`; with the largest, a file may have {LAST_LIMIT[:-1]} MiB.'
    yield ''
    yield '| scene | without `--error` | written with |'
    yield '|---|---|---|'
    for row in rows:
        if row['refused']:
            yield f'| `{row["scene"]}` | {told(row["refused"])} | {"" if row["words"] is None else "`" + row["words"] + "`"} |'


def study(study, scenes, jobs, kept, commit):
    """The lines of the table."""
    return table(every_scene(study, scenes, jobs, Known(Path(kept) if kept else None, commit)), study.fallen_short)
