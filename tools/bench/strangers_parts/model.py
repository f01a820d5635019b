"""A random model: its files, and the options that it is drawn with."""
import json

import inst
import lsys
import rifs
import scene
from draw import Draw, number, numbers

LANGUAGES = {'rifs': rifs, 'lsys': lsys, 'inst': inst}


class Model:
    def __init__(self, language, name='model'):
        self.language = language
        self.main = f'{name}.{language}'
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
        for name, content in {**self.files, self.main: '\n'.join(self.lines) + '\n'}.items():
            (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        (folder / 'options.json').write_text(json.dumps(
            {'model': self.main, 'options': self.options, 'drawn': self.drawn,
             'visible_only': self.visible_only}) + '\n')


def generate(seed, language, index):
    """The model of this number; the same for ever, unless the generator itself is changed."""
    draw = Draw(seed, language, index)
    model = Model(language)
    model.say(f'# tools/bench/strangers --seed {seed} --only {language}-{index}')
    if draw.chance(0.15):
        other = draw.pick(list(LANGUAGES))
        part = Model(other, 'part')
        LANGUAGES[other].write(draw, part, small=True)
        model.files.update({part.main: '\n'.join(part.lines) + '\n', **part.files})
        model.say(f'use part = "{part.main}"')
        model.used.append('part')
    scene.surroundings(draw, model)
    address = LANGUAGES[language].write(draw, model, small=False)
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
