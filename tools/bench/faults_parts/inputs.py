"""The commands that are tried, and what they read."""
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent.parent

MODELS = {
    'tree.lsys': '''lsys tree {
  angle 25
  steps 4
  seed 3
  axiom !(0.1)A
  A -> F[+A][-A]/(120)A : 0.7
  A -> F[+A]A           : 0.3
}
''',
    'fern.rifs': '''rifs fern {
  map a { scale 1/2 tint 1,0,0,0.5 }
  map b { scale 1/2 translate <1,0,0> tint 0,1,0,0.5 }
  map c { scale 1/2 translate <0,1,0> tint 0,0,1,0.5 }
}
''',
    'flat.rifs': '''rifs flat {
  codes 2d {
    0.5 0 0 0.5 0   0
    0.5 0 0 0.5 0.5 0
    0.5 0 0 0.5 0   0.5
  }
}
''',
    # Other models, pictures that go beside the scene, and parts by chance.
    'grove.inst': '''use tree = "tree.lsys"
use fern = "fern.rifs"
material bark { texture: "bark.png" }
material moss { texture: "moss.png" }
camera { location: 0,3,12, look_at: 0,1,0 }
ground { height: 0 }
canonical object stones { scatter: cone over: disc 4 count: 20 material: bark }
canonical object stump { cylinder material: moss }
object grove {
  tree
  fern translate: 3,0,0
  stones
  stump translate: -2,0,0
}
''',
}
SIZE = ['--size', '48x28', '-q']  # even, as videos need it
NATIVE = ['--engine', 'native', '--threads', '2']
TURN = ['animate', 'models/flat.rifs', *SIZE, '--frames', '2', '--antialias', 'off']

# Name -> the arguments, and the output, if it is no standard output.
COMMANDS = {
    'check': (['check', 'models/grove.inst'], None),
    'stats': (['stats', '--json', 'models/grove.inst'], None),
    'print': (['print', 'models/grove.inst'], None),
    'compile': (['compile', 'models/grove.inst', *SIZE], 'out.pov'),
    'compile -o -': (['compile', 'models/flat.rifs', *SIZE, '-o', '-'], None),
    'render': (['render', '--engine', 'povray', 'models/grove.inst', *SIZE, '--plain-light'], 'out.png'),
    'render, .exr': (['render', '--engine', 'povray', 'models/flat.rifs', *SIZE, '--plain-light'], 'out.exr'),
    'render, native': (['render', '--no-progressive', 'models/grove.inst', *SIZE, *NATIVE], 'out.png'),
    'render, native, .exr': (['render', '--no-progressive', 'models/flat.rifs', *SIZE, *NATIVE], 'out.exr'),
    'points': (['points', 'models/flat.rifs', *SIZE, '--points', '300000', '--threads', '2'], 'out.png'),
    'points, .ply': (['points', 'models/flat.rifs', *SIZE, '--points', '300000', '--threads', '2'], 'out.ply'),
    'points, --card': (['points', 'models/flat.rifs', *SIZE, '--points', '1000', '--card', 'out.inst'], None),
    'animate': ([*TURN, '--engine', 'povray'], 'out/'),
    'animate, native, .gif': ([*TURN, *NATIVE], 'out.gif'),
    'animate, native, .png': ([*TURN, *NATIVE], 'out.png'),
    'compare': (['compare', 'models/a.png', 'models/a.png'], None),
    'compare, .exr': (['compare', 'models/a.exr', 'models/a.exr'], None),
    'collage': (['collage', 'models/target.png', 'models/flat.rifs'], None),
    'fit': (['fit', 'models/target.png', '--work', '0.2', '--threads', '2'], 'out.rifs'),
    'fit, --blocks': (['fit', '--blocks', 'models/target.png', '--work', '0.2', '--threads', '2'], 'out.pifs'),
}
if shutil.which('ffmpeg'):
    COMMANDS['animate, native, .mp4'] = ([*TURN, *NATIVE], 'out.mp4')
SMOKE = ['check', 'compile', 'render', 'render, native', 'points, .ply']


def write(folder, program):
    folder.mkdir()
    for name, text in MODELS.items():
        (folder / name).write_text(text)
    for name in ('bark.png', 'moss.png'):
        shutil.copy(ROOT / 'tests/golden/textured/leaf.png', folder / name)
    for name, words in {'a.png': ['render'], 'a.exr': ['render'], 'target.png': ['points', '--transparent']}.items():
        more = NATIVE if words[0] == 'render' else ['--points', '5000']
        subprocess.run([program, words[0], 'flat.rifs', *words[1:], *more, *SIZE, '-o', name], cwd=folder, check=True)
