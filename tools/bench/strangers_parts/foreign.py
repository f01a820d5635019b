"""Random files of other programs, in the shape that people write them and in the bytes that their editors leave."""
import re

import foreign_shapes
from draw import number, numbers


def write(draw, model):
    ending, text_of = draw.weighted(FORMATS)
    text = text_of(draw)
    if draw.chance(0.03):
        text = text[:int(draw.random() * len(text))]
    text = text.replace('\n', draw.weighted({'\n': 8, '\r\n': 2, '\r': 0.5}))
    encoding = draw.weighted({'utf-8': 8, 'utf-8-sig': 2, 'utf-16': 1, 'utf-16-le': 0.1, 'utf-16-be': 0.1, 'cp1252': 1})
    model.main = 'model.' + (ending if draw.chance(0.95) else 'txt')
    model.content = text.encode(encoding)
    if many := NAMES.get(text_of):
        model.name = draw.pick(re.findall(many, text)) if len(re.findall(many, text)) > 1 else None
    if ending == 'l' and draw.chance(0.2):
        model.files['model.v'] = f'angle factor: 20\nline width: {draw.whole(1, 9)} pixel\nscale factor: 0.9\n'
    if draw.chance(0.2):
        model.options += ['--steps', str(draw.log_whole(1, 60))]


def word(draw, symbols, most=9):
    """A successor of brackets, turns and symbols."""
    text = ''
    for _ in range(draw.whole(1, most)):
        text += draw.pick(symbols) if not draw.chance(0.15) else f'[{draw.pick("+-")}{word(draw, symbols, 3)}]'
    return text


def fractint(draw):
    systems = []
    for index in range(draw.pick([1, 1, 1, 2, 30])):
        letters = draw.some('FGXYABWZ', draw.whole(1, 5))
        symbols = [*letters, 'F', '+', '-', '|', '!', '@.5', '@I1.2', '@Q2', r'\30', '/45.5', 'D', 'M', 'C3', '<1', '>2']
        rules = [f'  {draw.pick([letter, letter.lower()])}={word(draw, symbols, draw.pick([4, 9, 40]))}' for letter in letters]
        if draw.chance(0.2):
            rules += [f'  {letters[0]}={word(draw, symbols)}', '  F=']
        systems.append('\n'.join([f'System{index or ""} {{ ; by somebody\xe9' if draw.chance(0.2) else f'System{index or ""} {{',
                                  f'  Angle {2 * draw.whole(2, 20) if draw.chance(0.9) else 7}', f'  Axiom {word(draw, symbols)}', *rules,
                                  '  }' if draw.chance(0.9) else '']))
    return '\n'.join(systems) + '\n'


def fractint_ifs(draw):
    flat = draw.chance(0.7)
    maps = draw.pick([1, 2, 4, 7, draw.log_whole(1, 500)])
    scale = draw.uniform(0.1, 1.05) if draw.chance(0.1) else draw.uniform(0.1, 0.7)
    lines = [' ' + numbers([*(scale * draw.uniform(-1, 1) for _ in range(4 if flat else 9)),
                            *(draw.pick([1, 1, 50]) * draw.uniform(-2, 2) for _ in range(2 if flat else 3)),
                            draw.pick([1 / maps, draw.random(), 0])], ' ') for _ in range(maps)]
    return '\n'.join([f'fern{"" if flat else " (3D)"} {{ ; a comment', *lines, '}']) + '\n'


def lparser(draw):
    letters = draw.some('ABCDEXYPQ', draw.whole(1, 5))
    symbols = [*letters, 'F', 'Z', 'f', '+', '-', '&', '^', '>', '<', "'", '"(1.1)', '!', '?(1.2)', 't(0.1)', ':', 'c', 'c(4)',
               '|', '%', '$', '~(30)', '+(22)', '&(40)', '{-f+f+f|-f+f+f}', 'z', 'g', '.']
    rules = [f'{letter}={word(draw, symbols, draw.pick([5, 12, 40]))}' for letter in letters]
    if draw.chance(0.2):
        rules.append(f'{letters[0]}(0.3)={word(draw, symbols)}')
    return '\n'.join(['# a plant \xb0', f'{draw.log_whole(1, 40)}  # depth', number(draw.pick([20, 36, draw.uniform(1, 120)])),
                      f'{draw.whole(0, 100)}', word(draw, [*letters, 'F']), '', *rules, '@']) + '\n'


def cpfg(draw):
    letters = draw.some('ABCDE', draw.whole(1, 4))
    symbols = [*[f'{letter}(r*x)' for letter in letters], 'F(x)', 'f', '+', '-', '&(30)', '/(137.5)', '!(x/9)', ';', '@O(0.2)',
               '|', '_(0.1)', '{.f+f+f.}', '?P(0,0)', '@Gs F @Ge', '%', '~l(1)', '@M(0,0,0)']
    rules = []
    for letter in letters:
        way = draw.weighted({'plain': 4, 'condition': 3, 'block': 2, 'chance': 2, 'context': 1})
        text = word(draw, symbols, draw.pick([4, 9, 25]))
        if way == 'condition':
            rules += [f'{letter}(x) : x > {number(draw.random())} --> {text}', f'{letter}(x) : * --> F(x)']
        elif way == 'block':
            rules.append(f'{letter}(x) : {{ y = x*n; while (y > 2) {{ y = y/2; }} }} y > 0 {{ n = n+1; }} --> F(y) {text}')
        elif way == 'chance':
            share = draw.random()
            rules += [f'{letter}(x) --> {text} : {number(share)}', f'{letter}(x) --> F(ran(1)) : {number(1 - share)}']
        elif way == 'context':
            rules += [f'{draw.pick(letters)}(y) < {letter}(x) > {draw.pick(letters)}(z) --> {text}', f'{letter}(x) --> {letter}(x)']
        else:
            rules.append(f'{letter}(x) --> {text}')
    return '\n'.join([f'#define r {number(draw.uniform(0.3, 1.1))}', f'#define STEPS {draw.log_whole(1, 40)} /* caf\xe9 */', 'Lsystem: 1',
                      f'seed: {draw.whole(1, 99)}', 'derivation length: STEPS', *(['ignore: F+-/&'] if draw.chance(0.3) else []),
                      'Start: { n = 1; }', *(['EndEach: { n = n*0.9; }'] if draw.chance(0.3) else []),
                      f'Axiom: {letters[0]}(1)', *rules,
                      *(['homomorphism', f'maximum depth: {draw.whole(1, 9)}', f'{letters[-1]}(x) --> F(x)@o(x)'] if draw.chance(0.3)
                        else []), 'endlsystem']) + '\n'


VARIATIONS = ['linear', 'sinusoidal', 'spherical', 'swirl', 'horseshoe', 'polar', 'handkerchief', 'heart', 'disc', 'spiral',
              'hyperbolic', 'diamond', 'ex', 'julia', 'bent', 'waves', 'fisheye', 'popcorn', 'exponential', 'power', 'cosine',
              'rings', 'fan', 'eyefish', 'bubble', 'cylinder', 'noise', 'blur', 'gaussian_blur', 'julian', 'curl', 'pdj']


def flame(draw):
    flames = []
    for index in range(draw.pick([1, 1, 1, 2, 20])):
        maps = draw.pick([1, 2, 3, 5, draw.log_whole(1, 100)])
        lines = []
        for tag in ['xform'] * maps + ['finalxform'] * draw.chance(0.03):
            chosen = {} if draw.chance(0.3) else {name: draw.uniform(-1, 1) for name in draw.some(VARIATIONS, draw.whole(1, 4))}
            words = ' '.join(f'{name}="{number(value)}"' for name, value in (chosen or {'linear': 1}).items())
            if 'julian' in chosen:
                words += f' julian_power="{draw.whole(-5, 9)}" julian_dist="1"'
            if draw.chance(0.05):
                words += f' chaos="{numbers([draw.pick([0, 1, 2.5]) for _ in range(maps)], " ")}"'
            if draw.chance(0.2):
                words += f' post="{numbers([draw.uniform(-1, 1) for _ in range(6)], " ")}"'
            size = draw.pick([0.6, 0.6, 1.5])
            weight = f' weight="{number(draw.random())}"' if tag == 'xform' else ''
            lines.append(f'  <{tag}{weight} color="{number(draw.random())}" {words} '
                         f'coefs="{numbers([size * draw.uniform(-1, 1) for _ in range(6)], " ")}"/>')
        if draw.chance(0.2):
            lines.append(f'  <symmetry kind="{draw.whole(-8, 8)}"/>')
        lines += [f'  <color index="{i}" rgb="{draw.whole(0, 255)} {draw.whole(0, 255)} 30"/>' for i in range(0, 256, draw.pick([1, 51]))]
        flames.append('\n'.join([f'<flame name="it{index}" size="640 480" center="0 0" scale="{number(draw.log_uniform(1, 500))}">',
                                 *lines, '</flame>']))
    return '<flames>\n' * (len(flames) > 1) + '\n'.join(flames) + '\n</flames>' * (len(flames) > 1) + '\n'


# The names of the models of a file that may hold several.
NAMES = {fractint: r'(System\d*) \{', flame: r'name="([^"]*)"'}
FORMATS = {('cfdg', foreign_shapes.cfdg): 5, ('es', foreign_shapes.eisenscript): 3, ('flame', flame): 2.5, ('l', fractint): 2,
           ('l', cpfg): 3, ('ls', lparser): 2, ('ifs', fractint_ifs): 1}
