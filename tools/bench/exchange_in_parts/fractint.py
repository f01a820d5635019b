"""Fractint's L-systems, derived as its program does: symbol by symbol, each rule by itself."""
import math
import re

from exchange_in_parts.turtle import Box, TooLong

NUMBERED = '\\/@c<>'


def models(text):
    """Name -> lines of each block; the first of a name counts."""
    text = '\n'.join(line.split(';')[0] for line in text.replace('\r\n', '\n').replace('\r', '\n').split('\n'))
    found = {}
    for match in re.finditer(r'([^{}]*)\{([^}]*)\}', text):
        lines = [line for line in match.group(1).split('\n') if line.strip()]
        name = re.split(r'[\s(]', lines[-1].strip())[0] if lines else ''
        if name and name.lower() != 'comment' and name.lower() not in (known.lower() for known in found):
            found[name] = match.group(2).split('\n')
    return found


def symbols(text):
    """[(letter, number)] of a string; brackets pair up within it."""
    found, at, depth = [], 0, 0
    while at < len(text):
        letter = text[at]
        at += 1
        number = ''
        if letter in NUMBERED:
            match = re.compile(r'[qi]{0,2}[0-9.]*').match(text, at)
            number, at = match.group(), match.end()
        if letter == ']' and depth == 0:
            break
        depth += (letter == '[') - (letter == ']')
        found.append((letter, number))
    return found + [(']', '')] * depth


class Refused(Exception):
    """A model that Fractint refuses too."""


def system(lines):
    axiom, angle, rules = '', 0, {}
    for line in lines:
        words = re.split(r'[ =\t]+', line.lower().strip(' \t='))
        if not words[0]:
            continue
        if words[0] == 'axiom':
            axiom = line.lower().split()[1] if len(line.split()) > 1 else ''
        elif words[0] == 'angle':
            angle = int((re.match(r'\d+', words[1]) if len(words) > 1 else None or re.match('0', '0')).group())
        elif len(words[0]) == 1:
            if words[0] in '+-/\\@|!c<>][':
                raise Refused(f"a rule for '{words[0]}'")
            rules[words[0]] = rules.get(words[0], '') + (words[1] if len(words) > 1 else '')
        else:
            raise Refused(f"'{words[0]}' begins no statement")
    if not axiom or not 3 <= angle <= 50:
        raise Refused('no axiom, or no angle from 3 to 50')
    return symbols(axiom), angle, {letter: symbols(text) for letter, text in rules.items()}


def number(text):
    digits = text.lstrip('qi')
    match = re.match(r'\d*\.?\d*', digits).group()
    value = float(match) if match.strip('.') else 0.0
    if value <= 0:
        return 0.0
    value = value ** 0.5 if 'q' in text[:len(text) - len(digits)] else value
    return 1 / value if 'i' in text[:len(text) - len(digits)] else value


def word(axiom, rules, steps, most):
    for _ in range(steps):
        after = []
        for symbol in axiom:
            after.extend(rules.get(symbol[0], [symbol]))
            if len(after) > most:
                raise TooLong
        axiom = after
    return axiom


def draw(lines, steps, most):
    """The box of the lines, in a plane with y up, after so many steps."""
    axiom, angle, rules = system(lines)
    box, saved = Box(), []
    x = y = 0.0
    turns, degrees, size, reverse = 0, 0.0, 1.0, False
    for letter, text in word(axiom, rules, steps, most):
        if letter in 'fgdm':
            heading = math.radians(turns * 360 / angle if letter in 'fg' else degrees)
            end = (x + size * math.cos(heading), y + size * math.sin(heading))
            if letter in 'fd':
                box.add((x, y), end)
            x, y = end
        elif letter in '+-':
            turns += 1 if (letter == '+') != reverse else -1
        elif letter in '\\/':
            degrees += number(text) if (letter == '\\') != reverse else -number(text)
        elif letter == '|':
            turns -= angle // 2
        elif letter == '!':
            reverse = not reverse
        elif letter == '@':
            size *= number(text)
        elif letter == '[':
            saved.append((x, y, turns, degrees, size, reverse))
        elif letter == ']':
            x, y, turns, degrees, size, reverse = saved.pop()
    return box
