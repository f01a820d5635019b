"""L-Parser's files, derived as its program does: character by character, numbers and parentheses too."""
import math
import re

from exchange_in_parts.turtle import Box, TooLong, along, cross, dot, unit

WORDS = ('recursion', 'mutation', 'angle', 'thickness', 'min_thickness', 'switch_yz', 'trace', 'no_wait', 'poly_limit',
         'shape', 'color', 'axiom', 'rule')


def system(text):
    values, rules, axiom, place = {}, {}, '', 0
    lines = [line.split('#')[0].strip() for line in text.replace('\r\n', '\n').replace('\r', '\n').split('\n')]
    lines = [line for line in lines if line]
    new = bool(lines) and lines[0].split()[0] in WORDS
    for line in lines:
        head, _, rest = line.partition(' ') if ' ' in line.expandtabs(1) else (line, '', '')
        if new:
            head, rest = line.split(None, 1) if len(line.split()) > 1 else (line, '')
            packed = ''.join(rest.split())
            if head == 'axiom':
                axiom = packed
            elif head == 'rule':
                rules.setdefault(packed[0], packed.split('=', 1)[1] if packed[1:2] == '=' else packed[2:])
            else:
                values[head] = rest
            continue
        token = line.split()[0]
        if place < 3:
            values[('recursion', 'angle', 'thickness')[place]] = token
        elif place == 3:
            axiom = token
        elif token.startswith('@'):
            break
        else:
            rules.setdefault(token[0], token[2:])
        place += 1
    return values, axiom, rules, 1.0 if new else 100.0


def word(axiom, rules, steps, most):
    for _ in range(steps):
        after = []
        length = 0
        for letter in axiom:
            part = rules.get(letter, letter)
            after.append(part)
            length += len(part)
            if length > most:
                raise TooLong
        axiom = ''.join(after)
    return axiom


def rotated(vector, axis, angle):
    cosine, sine = math.cos(angle), math.sin(angle)
    across, share = cross(axis, vector), dot(axis, vector) * (1 - cosine)
    return tuple(cosine * v + sine * c + share * a for v, c, a in zip(vector, across, axis))


def is_random(text):
    _, axiom, rules, _ = system(text)
    return '~' in axiom or any('~' in rule for rule in rules.values())


def draw(text, steps, most):
    """The box of the blocks' axes after so many steps (None: the file's), in graftal's axes."""
    values, axiom, rules, length = system(text)
    steps = int(float(values.get('recursion', 1))) if steps is None else steps
    string = word(axiom, rules, steps, most)
    angle = math.radians(float(values.get('angle', 45)))
    place, ahead, left, up = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)
    full, half = length, length / 2
    box, saved, at = Box(), [], 0
    while at < len(string):
        letter = string[at]
        at += 1
        value = None
        if letter in "+-&^<>t!?:;'\"FfgZzc~" and string[at:at + 1] == '(':
            end = string.index(')', at)
            match = re.match(r'[-+]?\d*\.?\d*(e[-+]?\d+)?', string[at + 1:end])
            value = float(match.group()) if match.group().strip('+-.') else 0.0
            at = end + 1
        turn = angle if value is None else math.radians(value)
        if letter in '+-':
            turn = -turn if letter == '+' else turn
            ahead, left = rotated(ahead, up, turn), rotated(left, up, turn)
        elif letter in '&^':
            turn = -turn if letter == '^' else turn
            ahead, up = rotated(ahead, left, turn), rotated(up, left, turn)
        elif letter in '<>':
            turn = -turn if letter == '<' else turn
            left, up = rotated(left, ahead, turn), rotated(up, ahead, turn)
        elif letter == '%':
            left, up = rotated(left, ahead, math.pi), rotated(up, ahead, math.pi)
        elif letter == '|':
            ahead, left = rotated(ahead, up, math.pi), rotated(left, up, math.pi)
        elif letter == '$':
            if abs(ahead[2]) < 1 - 1e-12:
                left = unit(cross(ahead, (0.0, 0.0, 1.0)))
                up = cross(ahead, left)
                if up[2] < 0:
                    up, left = tuple(-x for x in up), tuple(-x for x in left)
        elif letter == 't':
            level = (ahead[0] ** 2 + ahead[1] ** 2) ** 0.5
            bend = (0.2 if value is None else value) * level
            ahead, up = rotated(ahead, left, bend), rotated(up, left, bend)
        elif letter == ':':
            angle *= 0.9 if value is None else value
        elif letter == ';':
            angle *= 1 / 0.9 if value is None else value
        elif letter in "'\"":
            factor = value if value is not None else 0.9 if letter == "'" else 1 / 0.9
            full, half = full * factor, half * factor
        elif letter in 'FfgZz':
            way = value if value is not None else full if letter in 'Ffg' else half
            end = along(place, ahead, way)
            if letter in 'FZ':
                box.add((-place[1], place[2], -place[0]), (-end[1], end[2], -end[0]))
            place = end
        elif letter == '{':
            box.has_polygons = True
        elif letter == '[':
            saved.append((place, ahead, left, up, angle, full, half))
        elif letter == ']' and saved:
            place, ahead, left, up, angle, full, half = saved.pop()
    if values.get('switch_yz', '').strip() == '1' and box.low:
        box.low[0], box.high[0] = -box.high[0], -box.low[0]
    if is_random(text):
        box.low = None  # only how many there are is no chance
    return box
