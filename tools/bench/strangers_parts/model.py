"""A random model: its files, and the options that it is drawn with."""
import json

import foreign
import inst
import lsys
import mesh
import rifs
import scene
import words
from draw import Draw, number, numbers

LANGUAGES = {'rifs': rifs, 'lsys': lsys, 'inst': inst}
KINDS = {**LANGUAGES, 'mesh': mesh, 'foreign': foreign, 'words': words}
ENDINGS = {'mesh': 'inst', 'words': 'lsys'}   # of kinds that are not called as their language is


class Model:
    def __init__(self, language, name='model'):
        self.language = language
        self.main = f'{name}.{language}'
        self.content = None  # of the main file, text or bytes, in place of the lines
        self.name = None     # of the one among several in the main file
        self.work = None     # --work of all commands
        self.files = {}      # name -> text or bytes, besides the main file
        self.lines = []
        self.drawn = []      # options of the commands that draw: --zoom, --at, --camera
        self.options = []    # options of all commands: --steps, --seed, --exact
        self.visible_only = False
        self.used = []       # names that `use` has given

    def say(self, *lines):
        self.lines += lines

    def write(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        main = '\n'.join(self.lines) + '\n' if self.content is None else self.content
        for name, content in {**self.files, self.main: main}.items():
            (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        (folder / 'options.json').write_text(json.dumps(
            {'model': ':'.join(filter(None, [self.main, self.name])), 'options': self.options, 'drawn': self.drawn, 'work': self.work,
             'visible_only': self.visible_only}) + '\n')


def generate(seed, kind, index):
    """The model of this number; the same for ever, unless the generator itself is changed."""
    draw = Draw(seed, kind, index)
    model = Model(ENDINGS.get(kind, kind))
    model.work = draw.whole(1, 30)
    if kind == 'foreign':
        foreign.write(draw, model)
        view(draw, model, None)
        return model
    model.say(f'# tools/bench/strangers --seed {seed} --only {kind}-{index}')
    if draw.chance(0.15):
        other = draw.pick(list(LANGUAGES))
        part = Model(other, 'part')
        LANGUAGES[other].write(draw, part, small=True)
        model.files.update({part.main: '\n'.join(part.lines) + '\n', **part.files})
        model.say(f'use part = "{part.main}"')
        model.used.append('part')
    scene.surroundings(draw, model)
    address = KINDS[kind].write(draw, model, small=False)
    view(draw, model, address)
    return model


def view(draw, model, address):
    """From where it is looked at: mostly as a whole, else from near, or very deep."""
    if draw.chance(0.25) and address:
        model.drawn += ['--at', address]
        endless = address.endswith(')*')
        if endless or draw.chance(0.5):
            model.drawn += ['--zoom', number(draw.log_uniform(1, 1e100 if endless else 100))]
    elif draw.chance(0.25):
        model.drawn += ['--zoom', number(draw.log_uniform(1, 1e12 if draw.chance(0.9) else 1e100))]
    if draw.chance(0.08):
        model.drawn += ['--camera', f'location={numbers([draw.log_uniform(0.01, 5) * draw.sign() for _ in range(3)], ",")}'
                        f' look_at={numbers([draw.uniform(-0.5, 0.5) for _ in range(3)], ",")}']
    model.visible_only = draw.chance(0.1)
