"""Random texts of objects and instances: shared parts, cycles that contract, parameters, scatters, repeats,
chance, hues."""
import scene
from draw import number, numbers


def write(draw, model, small):
    paints = scene.materials(draw, model)
    count = draw.whole(1, 4) if small else draw.ranged(
        {(1, 5): 4, (4, 15): 3, (15, 40): 2, (40, draw.log_whole(40, 2000)): 0.5})
    cyclic = draw.chance(0.6)
    back = draw.uniform(0.3, 0.98)           # what an edge against the order contracts by, at the most
    ahead = draw.uniform(0.3, 0.98) if draw.chance(0.8) else 1
    group_count = draw.pick([1, 2, 2, 3, 4, 6]) if count < 100 else 2
    text = Text(draw, model, paints, count, cyclic, back, ahead)
    if draw.chance(0.25):
        text.parametric()
    if draw.chance(0.25):
        text.random()
    for index in range(count):
        text.object(index, draw.whole(1, group_count), small)
    text.top()
    if draw.chance(0.25):
        model.options += ['--steps', str(draw.log_whole(1, 60))]
    return text.address()


class Text:
    def __init__(self, draw, model, paints, count, cyclic, back, ahead):
        self.draw, self.model, self.paints = draw, model, paints
        self.names = [f'o{i}' for i in range(count)]
        self.cyclic, self.back, self.ahead = cyclic, back, ahead
        # Turns that soon add up to a circle, and now and then any: the graph has an object for each sum.
        self.hues = draw.weighted({(): 4, (15, 30, -45): 3, (360 / 7,): 1, (draw.uniform(-180, 180),): 1})
        self.inked = draw.chance(0.2)
        self.calls = []          # objects with parameters, as they may be called
        self.parts = {}          # name of an object -> those that it has instances of

    def transforms(self, most):
        """Lines whose product contracts by `most` at least, whatever else they do."""
        draw = self.draw
        factor = most * (draw.uniform(0.5, 1) if draw.chance(0.7) else draw.log_uniform(0.01, 1))
        if draw.chance(0.15):
            lines = [f'scale: {numbers([factor * draw.log_uniform(0.2, 1) * draw.sign() for _ in range(3)])}']
        elif draw.chance(0.1):
            lines = [f'scale: {number(-factor)}']
        else:
            lines = [f'scale: {number(factor)}'] if factor != 1 else []
        for _ in range(draw.pick([0, 1, 1, 2])):
            lines.append(f'rotate: {draw.pick("xyz")}, {number(draw.pick([90, 45, 120, draw.uniform(-180, 180)]))}')
        if draw.chance(0.85):
            size = draw.pick([1, 1, 1, 0.3, 0.01, 5])
            lines.append(f'translate: {numbers([size * draw.uniform(-1, 1) for _ in range(3)])}')
        return lines

    def look(self):
        draw, lines = self.draw, []
        if draw.chance(0.2):
            lines.append(scene.tint(draw))
        if self.paints and draw.chance(0.3):
            lines.append(f'material: {draw.pick(self.paints)}')
        if self.hues and draw.chance(0.3):
            lines.append(f'hue: {number(draw.pick(self.hues))}')
        if self.inked and draw.chance(0.3):
            lines.append(self.ink())
        return lines

    def ink(self):
        """A colour that is handed down, or changes to it."""
        draw = self.draw
        if draw.chance(0.3):
            return f'ink: hsv({draw.whole(0, 360)}, {number(draw.random())}, {number(draw.random())})'
        changes = []
        for _ in range(draw.pick([1, 1, 2, 3])):
            part = draw.pick(['hue', 'saturation', 'value', 'alpha'])
            if draw.chance(0.3):
                most = 360 if part == 'hue' else 1
                changes.append(f'{part} to {number(draw.uniform(0, most))} by {number(draw.random())}')
            else:
                by = draw.pick([12, 45, draw.uniform(-180, 180)]) if part == 'hue' else draw.uniform(0.3, 1.2)
                changes.append(f'{part} {number(by)}')
        return f'ink {{ {"  ".join(changes)} }}'

    def leaf(self):
        draw = self.draw
        if self.model.used and draw.chance(0.3):
            return draw.pick(self.model.used)
        if self.calls and draw.chance(0.3):
            return draw.pick(self.calls)()
        return scene.primitive(draw)

    def object(self, index, groups, small):
        draw = self.draw
        self.model.say(f'canonical object {self.names[index]} {{')
        for group in range(groups):
            later = self.names[index + 1:]
            kind = draw.weighted({'later': 5 if later else 0, 'earlier': 3 if self.cyclic else 0, 'leaf': 2})
            # Every way must end in something that is seen.
            if group == 0 and index + 1 == len(self.names):
                kind = 'leaf'
            if kind == 'leaf' and draw.chance(0.12) and not small:
                self.scatter(later)
                continue
            if kind == 'later':
                masters, most = [draw.pick(later) for _ in range(draw.pick([1, 1, 2]))], self.ahead
            elif kind == 'earlier':
                masters, most = [draw.pick(self.names[:index + 1])], self.back
            else:
                masters, most = [self.leaf() for _ in range(draw.pick([1, 1, 2]))], 0.8
            lines = self.transforms(most) if kind != 'leaf' else scene.transforms(draw)
            self.parts.setdefault(self.names[index], []).extend(masters if kind != 'leaf' else [])
            if kind == 'leaf' and draw.chance(0.15):
                self.model.say(*('  ' + repeat for repeat in self.repeats()))
            self.model.say(f'  union: {", ".join(masters)}', *('    ' + line for line in lines + self.look()))
        if draw.chance(0.2):
            self.model.say(f'  terminal: {scene.primitive(draw)}', *('    ' + line for line in scene.transforms(draw)))
            if draw.chance(0.4):
                self.model.say(f'    below: {draw.whole(1, 60)}')
        self.model.say('}')

    def scatter(self, later):
        draw = self.draw
        masters = [draw.pick(later) if later and draw.chance(0.7) else self.leaf() for _ in range(draw.pick([1, 1, 2, 3]))]
        half = draw.log_uniform(0.3, 50)
        area = f'disc {number(half)}' if draw.chance(0.5) else numbers([-half, -half, half, half])
        by = draw.pick(['poisson', 'uniform', 'jitter', 'spiral'])
        lines = [f'  scatter: {", ".join(masters)}', f'    count: {draw.log_whole(1, 3000)}', f'    over: {area}',
                 f'    by: {by}']
        if draw.chance(0.5):
            lines.append(f'    size: {number(draw.uniform(0.1, 0.6))} .. {number(draw.uniform(0.6, 1.4))}')
        if draw.chance(0.5):
            lines.append('    turn: y')
        if draw.chance(0.3):
            lines.append(f'    lean: {number(draw.uniform(0, 40))}')
        if draw.chance(0.2):
            lines.append(f'    tint: {scene.colour(draw)}, 0.2 .. {scene.colour(draw)}, 0.6')
        lines.append(f'    scale: {number(draw.uniform(0.05, 0.8))}')
        self.model.say(*lines)

    def repeats(self):
        """One in another, now and then."""
        draw = self.draw
        for _ in range(draw.pick([1, 1, 2, 3])):
            steps = [*self.transforms(draw.pick([1, 1, 0.9])), *(line for line in self.look() if not line.startswith('material'))]
            count = draw.log_whole(1, 40)
            yield f'{draw.pick([f"repeat {count}", f"{count} *"])} {{ {"  ".join(steps)} }}'

    def random(self):
        """Objects that chance chooses among, or that have random numbers."""
        draw = self.draw
        for name in ('any', 'some')[:draw.whole(1, 2)]:
            for _ in range(draw.pick([1, 2, 3])):
                most = draw.uniform(0.2, 1)
                self.model.say(f'canonical object {name} weight {draw.whole(1, 5)} {{', f'  union: {scene.primitive(draw)}',
                               f'    scale: random({number(most / 2)}, {number(most)})')
                if draw.chance(0.5):
                    self.model.say(f'    rotate: {draw.pick("xyz")}, normal(0, {draw.whole(1, 60)})')
                if draw.chance(0.5):
                    self.model.say(f'    tint: hsv(random(0, 360), {number(draw.random())}, 0.8), 0.7')
                if draw.chance(0.3):
                    self.model.say(f'  union: {name}', *('    ' + line for line in self.transforms(0.8)))
                self.model.say('}')
            if draw.chance(0.3):
                self.model.say(f'canonical object {name} weight {draw.whole(1, 5)} {{ nothing }}')
            self.calls.append(lambda name=name: name)

    def parametric(self):
        """An object that counts down, or halves, until its base case."""
        draw = self.draw
        for name in ('tip', 'fork')[:draw.whole(1, 2)]:
            last = draw.ranged({(1, 8): 3, (8, 40): 1})
            self.model.say(f'canonical object {name}(0) {{ union: {scene.primitive(draw)} scale: 0.2 }}',
                           f'canonical object {name}(n) {{')
            for _ in range(draw.pick([1, 2, 2, 3])):
                lines = self.transforms(draw.pick([self.back, 1]))
                if draw.chance(0.3):
                    lines.append(f'rotate: z, {number(draw.uniform(1, 30))}*n')
                group = [f'  union: {name}(n - 1)', *('    ' + line for line in lines)]
                self.model.say(*(self.conditional(group) if draw.chance(0.2) else group))
            self.model.say(f'  union: {scene.primitive(draw)}', *('    ' + line for line in scene.transforms(draw)), '}')
            self.calls.append(lambda name=name, last=last: f'{name}({draw.whole(0, last)})')

    def conditional(self, group):
        draw = self.draw
        condition = draw.pick([f'mod(n, {draw.whole(2, 4)}) == 0', f'n > {draw.whole(0, 6)}', f'n != {draw.whole(0, 9)}'])
        yield f'  when {condition} {{'
        yield from ('  ' + line for line in group)
        yield f'  }} else {{ union: {scene.primitive(draw)} scale: 0.1 }}' if draw.chance(0.5) else '  }'

    def address(self):
        """A walk down from the root; for ever, if it meets itself again."""
        walk, ahead = [], ['o0#1']
        while ahead and len(walk) < 30:
            at = self.draw.pick(ahead)
            if at in walk and self.draw.chance(0.6):
                first = walk.index(at)
                return '.'.join([*walk[:first], '(' + '.'.join(walk[first:]) + ')*'])
            walk.append(at)
            parts = self.parts.get(at.split('#')[0], [])
            ahead = [part if parts.count(part) == 1 else f'{part}#1' for part in parts]
        return '.'.join(walk)

    def top(self):
        draw = self.draw
        self.model.say('object top {', f'  union: {self.names[0]}')
        for _ in range(draw.pick([0, 0, 0, 1, 3])):
            self.model.say(f'  union: {draw.pick(self.names)}', *('    ' + line for line in self.transforms(1) + self.look()))
        if draw.chance(0.08):
            self.model.say(f'  union: plane', f'    translate: 0, {number(draw.uniform(-2, 0))}, 0')
        self.model.say('}')
