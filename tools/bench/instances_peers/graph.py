"""graph.py nested|declared|eisenscript DEPTH PLACEMENT LIMIT < GRAPH >> SCENE: reads the graph that `graftal print`
writes, and writes it as the peers of tools/bench/instances want it; but no nested unions of more bytes than LIMIT."""
import io
import re
import sys

IDENTITY = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)
# What the primitives of a graph are in POV-Ray's language.
SDL_OF_PRIMITIVE = {
    'cube': 'box { -1, 1',
    'sphere': 'sphere { 0, 1',
    'cylinder': 'cylinder { 0, y, 1',
    'cone': 'cone { 0, 1, y, 0',
    'triangle': 'triangle { y, <-0.8660254037844386,-0.5,0>, <0.8660254037844386,-0.5,0>',
}


class Instance:
    def __init__(self, master):
        self.master, self.matrix, self.material = master, IDENTITY, None


class Graph:
    """objects: name -> (instances, what stands for it where recursion ends, or None)."""

    def __init__(self, text):
        self.objects, self.colours, self.root = {}, {}, None
        name = material = role = None
        current = []  # the instances that the next line's properties belong to
        for line in text.splitlines():
            words = line.strip().rstrip('{').strip()
            if match := re.match(r'(canonical )?object (\S+) \{', line):
                name, material = match[2], None
                self.objects[name] = ([], [])
                self.root = self.root if match[1] else name
            elif match := re.match(r'material (\S+) \{', line):
                name, material = None, match[1]
            elif line.rstrip() in ('camera {', 'light {', 'background {', 'ground {'):
                name = material = None
            elif match := re.match(r'(union|instance|terminal): (.*)', words):
                if name:
                    role = self.objects[name][match[1] == 'terminal']
                    current = [Instance(master.strip()) for master in re.split(r', (?![^(]*\))', match[2])]
                    role.extend(current)
            elif match := re.match(r'(matrix|material|color): (.*)', words):
                if match[1] == 'color' and material:
                    self.colours[material] = match[2]
                for instance in current if name else ():
                    if match[1] == 'matrix':
                        instance.matrix = tuple(float(x) for x in match[2].split(','))
                    elif match[1] == 'material':
                        instance.material = match[2]

    def parts(self, name, depth):
        """The instances that `name` is made of with `depth` levels of recursion left, and what they have left."""
        instances, terminal = self.objects[name]
        if terminal:
            return (instances, depth - 1) if depth > 0 else (terminal, 0)
        return instances, depth


def identifier(name, depth, recursive):
    word = re.sub(r'\W+', '_', name).strip('_')
    return f'{word}_level_{depth}' if recursive else f'{word}_part'


def sdl_matrix(m):
    if m == IDENTITY:
        return ''
    return ' matrix <%s>' % ','.join('%.12g' % m[i] for i in (0, 4, 8, 1, 5, 9, 2, 6, 10, 3, 7, 11))


def primitive(graph, instance):
    """Its text, except the brace that ends it."""
    look = ''
    if instance.material:
        look = ' texture { pigment { rgb <%s> } finish { F_%s } }' % (
            graph.colours[instance.material], instance.material)
    return SDL_OF_PRIMITIVE[instance.master] + look + sdl_matrix(instance.matrix)


def single_look(graph):
    """Models without materials take one texture as a whole; where there are materials, each part has its own."""
    return '' if graph.colours else ' texture { pigment { rgb 0.8 } finish { F_default } }'


def write_nested(graph, depth, placement, most_text, out):
    """Nested unions, written out in full: the text of a part is repeated wherever the part occurs."""
    sizes, short = {}, {}  # sizes of the texts of parts, without their ends; the texts themselves where short

    def size(name, levels):
        key = name, levels
        if key not in sizes:
            instances, left = graph.parts(name, levels)
            sizes[key] = 8 + sum(
                len(primitive(graph, part)) if part.master in SDL_OF_PRIMITIVE
                else size(part.master, left) + len(sdl_matrix(part.matrix)) for part in instances)
        return sizes[key]

    def write(name, levels, to):
        """But for the brace that ends it: so transforms can follow."""
        key = name, levels
        if key in short:
            to.write(short[key])
            return
        target = io.StringIO() if size(name, levels) < 1_000_000 else to
        instances, left = graph.parts(name, levels)
        if len(instances) > 1:
            target.write('union {\n')
        for part in instances:
            if part.master in SDL_OF_PRIMITIVE:
                target.write(primitive(graph, part))
            else:
                write(part.master, left, target)
                target.write(sdl_matrix(part.matrix))
            if len(instances) > 1:
                target.write(' }\n')
        if target is not to:
            short[key] = target.getvalue()
            to.write(short[key])

    if size(graph.root, depth) > most_text:
        sys.exit('error: a text of %.3g GB' % (size(graph.root, depth) / 1e9))
    write(graph.root, depth, out)
    out.write(single_look(graph) + placement + ' }\n')


def write_declared(graph, depth, placement, out):
    """Hart's levels: each part is declared once, from the parts one level down."""
    done = {}

    def declare(name, levels):
        if (name, levels) in done:
            return done[name, levels]
        instances, left = graph.parts(name, levels)
        parts = [primitive(graph, part) if part.master in SDL_OF_PRIMITIVE else 'object { ' + declare(
            part.master, left) + sdl_matrix(part.matrix) for part in instances]
        label = done[name, levels] = identifier(name, levels, bool(graph.objects[name][1]))
        whole = parts[0] if len(parts) == 1 else 'union {\n%s' % ''.join(part + ' }\n' for part in parts)
        out.write('#declare %s = %s }\n' % (label, whole))
        return label

    out.write('object { %s%s%s }\n' % (declare(graph.root, depth), single_look(graph), placement))


def write_eisenscript(graph, depth, out):
    """Structure Synth: a rule for each part and level. It scales about the middle of the unit cube, which therefore
    stands for the origin; it has no cylinders and no cones, and its parts are scaled evenly here."""
    done = {}

    def action(instance):
        m = instance.matrix
        scale = [m[0], m[5], m[10]]
        assert not any(m[i] for i in (1, 2, 4, 6, 8, 9)), 'not a scale and a translation'
        move = ' '.join('%s %.12g' % (axis, m[i]) for axis, i in zip('xyz', (3, 7, 11)) if m[i])
        if instance.master == 'cube':
            scale = [2 * s for s in scale]
        return '{ %s s %s }' % (move, ' '.join('%.12g' % s for s in scale))

    def triangle(m):
        corners = ((0, 1), (-0.8660254037844386, -0.5), (0.8660254037844386, -0.5))
        return 'triangle[%s]' % ';'.join(
            ','.join('%.12g' % (m[i] * x + m[i + 1] * y + m[i + 3] + 0.5) for i in (0, 4, 8)) for x, y in corners)

    def rule(name, levels):
        if (name, levels) in done:
            return done[name, levels]
        label = done[name, levels] = identifier(name, levels, True).replace('_', '')
        instances, left = graph.parts(name, levels)
        body = ''
        for instance in instances:
            if instance.master == 'cube':
                body += action(instance) + ' box\n'
            elif instance.master == 'triangle':
                body += '{ x 0 } %s\n' % triangle(instance.matrix)
            else:
                body += '%s %s\n' % (action(instance), rule(instance.master, left))
        out.write('rule %s {\n%s}\n' % (label, body))
        return label

    # Of all its limits the largest that it takes.
    out.write('set maxobjects 2000000000\nset maxdepth 1000\nset maxsize 1000000\nset minsize 0\n')
    out.write('rule whole {\n{ x 0 } %s\n}\n{ x 0 } whole\n' % rule(graph.root, depth))


def main():
    form, depth, placement, most_text = sys.argv[1:]
    graph = Graph(sys.stdin.read())
    if form == 'nested':
        write_nested(graph, int(depth), placement, int(most_text), sys.stdout)
    elif form == 'declared':
        write_declared(graph, int(depth), placement, sys.stdout)
    else:
        write_eisenscript(graph, int(depth), sys.stdout)


if __name__ == '__main__':
    main()
