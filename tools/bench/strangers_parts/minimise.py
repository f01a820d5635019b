"""Makes a model smaller, line by line, while a command ends in the same finding."""
import json
import shutil

import trial


def smallest(program, folder, command, limits, say):
    """Rewrites the model in `folder`; returns the finding, or None if there is none to begin with."""
    model = json.loads((folder / 'options.json').read_text())
    main = folder / model['model'].split(':')[0]
    work = folder.parent / (folder.name + '.smaller')

    def finding(lines, chosen):
        shutil.rmtree(work, ignore_errors=True)
        shutil.copytree(folder, work)
        (work / main.name).write_text('\n'.join(lines) + '\n')
        (work / 'options.json').write_text(json.dumps({**model, **chosen}))
        found = trial.attempt(program, command, work, limits)['findings']
        return found[0].split(' ')[0] if found else None

    lines, chosen = main.read_text(errors='replace').splitlines(), {key: model[key] for key in ('options', 'drawn')}
    wanted = finding(lines, chosen)
    if wanted is None:
        return None
    size = max(1, len(lines) // 2)
    while True:
        at, shrank = 0, False
        while at < len(lines):
            fewer = lines[:at] + lines[at + size:]
            if finding(fewer, chosen) == wanted:
                lines, shrank = fewer, True
                say(f'{len(lines)} lines')
            else:
                at += size
        if size == 1 and not shrank:
            break
        size = max(1, size // 2)
    for key in chosen:
        if chosen[key] and finding(lines, {**chosen, key: []}) == wanted:
            chosen = {**chosen, key: []}
    shutil.rmtree(work, ignore_errors=True)
    main.write_text('\n'.join(lines) + '\n')
    (folder / 'options.json').write_text(json.dumps({**model, **chosen}) + '\n')
    return wanted
