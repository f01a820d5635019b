"""What models of all languages may say: materials, cameras, lights, skies, grounds; and pictures to wrap round them."""
import struct
import zlib

from draw import number, numbers

NAMED = ['leaf', 'bark', 'stone', 'water', 'glass', 'gold', 'snow', 'wax']
PRIMITIVES = ['triangle', 'sphere', 'cube', 'cylinder', 'cone', 'torus']


def primitive(draw):
    return f'frustum({number(draw.uniform(0, 1))})' if draw.chance(0.15) else draw.pick(PRIMITIVES)


def colour(draw):
    return numbers([draw.random() for _ in range(3)])


def tint(draw):
    if draw.chance(0.5):
        return f'tint rgb <{colour(draw)}> {number(draw.random())}'
    return f'tint {colour(draw)}, {number(draw.random())}'


def transforms(draw, size=1.0, distance=1.0):
    """Of a thing that is placed once: a list of lines."""
    lines = []
    if draw.chance(0.8):
        factor = size * draw.log_uniform(0.05, 1)
        if draw.chance(0.3):
            lines.append('scale <' + numbers([factor * draw.log_uniform(0.02, 1) for _ in range(3)]) + '>')
        else:
            lines.append(f'scale {number(factor)}')
    if draw.chance(0.4):
        lines.append(f'rotate {draw.pick("xyz")}, {number(draw.uniform(-180, 180))}')
    if draw.chance(0.1):
        lines.append(f'shear {draw.pick(["xy", "yx", "xz", "yz"])} {number(draw.uniform(-1, 1))}')
    if draw.chance(0.6):
        lines.append('translate <' + numbers([distance * draw.uniform(-1, 1) for _ in range(3)]) + '>')
    return lines


def png(draw):
    """A small picture of two colours, with holes where its alpha is 0."""
    width, height = draw.whole(1, 40), draw.whole(1, 40)
    colours = [bytes(draw.whole(0, 255) for _ in range(3)) + alpha for alpha in (b'\xff', draw.pick([b'\xff', b'\0']))]
    rows = b''.join(b'\0' + b''.join(colours[draw.chance(0.4)] for _ in range(width)) for _ in range(height))

    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))

    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 6, 0, 0, 0)) + \
        chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b'')


def hdr(draw):
    """Light of all directions, of any proportions."""
    width, height = (draw.whole(1, 40), draw.whole(1, 40)) if draw.chance(0.5) else (32, 16)
    texels = b''.join(bytes(draw.whole(0, 255) for _ in range(3)) + bytes([draw.whole(110, 140)])
                      for _ in range(width * height))
    return f'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n'.encode() + texels


def environment(draw, model):
    """The fields of a sky."""
    name = draw.pick(['sky.hdr', 'sky.png'])
    model.files[name] = hdr(draw) if name == 'sky.hdr' else png(draw)
    fields = [f'environment: "{name}"']
    if draw.chance(0.5):
        fields.append(f'turn: {number(draw.uniform(-360, 360))}')
    return fields


def materials(draw, model, most=3):
    """Declares some, and returns their names; model.files gets their pictures."""
    names = []
    while len(names) < most and draw.chance(0.4):
        name = f'paint{len(names) + 1}'
        fields = []
        if draw.chance(0.15):
            picture = f'{name}.png'
            model.files[picture] = png(draw)
            fields.append(f'texture: "{picture}"')
            if draw.chance(0.3):
                fields.append(f'around: {draw.whole(1, 4)}')
        if not fields or draw.chance(0.5):
            fields.append(f'color: {colour(draw)}')
        for field in ('ambient', 'diffuse', 'specular', 'reflection'):
            if draw.chance(0.2):
                fields.append(f'{field}: {number(draw.random())}')
        if draw.chance(0.15):
            fields.append(f'translucency: {number(draw.random())}')
        if draw.chance(0.05):
            fields.append(f'emission: {number(draw.log_uniform(0.01, 100))}')
        if draw.chance(0.1):
            fields.append(f'roughness: {number(draw.log_uniform(0.001, 1))}')
        fields += optics(draw, not any(field.startswith('texture') for field in fields))
        model.say(f'material {name} {{ {"  ".join(fields)} }}')
        names.append(name)
    if draw.chance(0.2):
        names.append(draw.pick(NAMED))
    return names


def optics(draw, solid):
    """Of a material: one to start from, and of metal or of glass, each now and then. Pictures may have holes: they
    are no solids."""
    fields = []
    if draw.chance(0.15):
        fields.append(f'from: {draw.pick(["leaf", "bark", "stone", "snow"])}')
    if draw.chance(0.1):
        fields.append(f'metallic: {number(draw.random())}')
    elif solid and draw.chance(0.15):
        fields.append(f'ior: {number(draw.uniform(1, 3))}')
    if draw.chance(0.15):
        fields.append(f'transparency: {number(draw.random())}')
        if solid and draw.chance(0.4):
            fields.append(f'absorption: {number(draw.log_uniform(0.01, 100))}')
        elif draw.chance(0.5):
            fields.append(f'filter: {number(draw.random())}')
    if any(field.startswith(('ior', 'transparency')) for field in fields) and draw.chance(0.3):
        fields.append(f'blur: {number(draw.random())}')
    return fields


def surroundings(draw, model):
    """Camera, lights, background and ground, each now and then."""
    if draw.chance(0.12):
        distance = draw.log_uniform(0.1, 30)
        at = [distance * draw.normal() for _ in range(3)]
        fields = [f'location: {numbers(at)}', f'look_at: {numbers([0.3 * draw.normal() for _ in range(3)])}']
        if draw.chance(0.3):
            fields += ['orthographic', f'width: {number(draw.log_uniform(0.01, 30))}']
            if draw.chance(0.3):
                fields.append(f'height: {number(draw.log_uniform(0.01, 30))}')
            if draw.chance(0.3):
                fields[0] = f'direction: {numbers([draw.normal() for _ in range(3)])}'
        else:
            fields.append(f'angle: {number(draw.uniform(5, 120))}')
            if draw.chance(0.2):
                fields.append(f'aperture: {number(draw.log_uniform(0.001, 1))}')
        model.say(f'camera {{ {"  ".join(fields)} }}')
    while draw.chance(0.15):
        if draw.chance(0.5):
            model.say(f'light {{ location: {numbers([10 * draw.normal() for _ in range(3)])}  color: {colour(draw)}'
                      f'{lamp_fields(draw)} }}')
        else:
            model.say(f'light {{ sun: {numbers([draw.uniform(-1, 1), draw.uniform(0.1, 1), draw.uniform(-1, 1)])}'
                      f'  color: {colour(draw)}{sun_fields(draw)} }}')
    soft_light(draw, model)
    if draw.chance(0.15):
        model.say(f'background {{ zenith: {colour(draw)}  horizon: {colour(draw)} }}' if draw.chance(0.5) else
                  f'background: {colour(draw)}')
    if draw.chance(0.1):
        model.say(f'ground {{ height: {number(draw.uniform(-2, 0.2))}  color: {colour(draw)} }}')


def lamp_fields(draw):
    """An area, or no shadows, now and then."""
    if draw.chance(0.3):
        return '  shadowless'
    if draw.chance(0.5):
        return ''
    sides = [draw.log_uniform(0.01, 30) for _ in range(2)]
    shape = f'size: {numbers(sides)}' if draw.chance(0.5) else f'radius: {number(sides[0])}'
    return f'  {shape}  look_at: {numbers([draw.normal() for _ in range(3)])}'


def sun_fields(draw):
    """Angle, temperature and brightness, each now and then."""
    text = ''
    if draw.chance(0.3):
        text += f'  angle: {number(draw.log_uniform(0.01, 90))}'
    if draw.chance(0.2):
        text += f'  temperature: {number(draw.log_uniform(1000, 40000))}'
    if draw.chance(0.2):
        text += f'  brightness: {number(draw.log_uniform(0.01, 100))}'
    return text


def soft_light(draw, model):
    """Sky, haze and film, each now and then."""
    if draw.chance(0.15):
        if draw.chance(0.4):
            model.say(f'light {{ sun: {numbers([draw.uniform(-1, 1), draw.uniform(-0.2, 1), draw.uniform(-1, 1)])}'
                      f'{sun_fields(draw)} }}')
            fields = [f'clear: {number(draw.uniform(2, 10))}']
        elif draw.chance(0.4):
            fields = environment(draw, model)
        else:
            fields = [f'{name}: {colour(draw)}' for name in ('zenith', 'horizon', 'below') if draw.chance(0.6)]
            fields = fields or ['zenith: 1, 1, 1']
        if draw.chance(0.2) and not fields[0].startswith('environment'):
            fields.append(f'clouds: {number(draw.uniform(0, 1))}  turn: {number(draw.uniform(-360, 360))}')
        if draw.chance(0.3):
            fields.append(f'brightness: {number(draw.log_uniform(0.01, 100))}')
        if draw.chance(0.3):
            fields.append(f'bounces: {draw.whole(0, 8)}')
        model.say(f'sky {{ {"  ".join(fields)} }}')
    if draw.chance(0.06):
        fields = [f'distance: {number(draw.log_uniform(0.01, 1000))}']
        if draw.chance(0.5):
            fields += [f'base: {number(draw.normal())}', f'height: {number(draw.log_uniform(0.001, 100))}']
        model.say(f'haze {{ {"  ".join(fields)} }}')
    if draw.chance(0.06):
        model.say(f'film {{ exposure: {number(draw.log_uniform(0.01, 100))}'
                  f'  white: {number(draw.log_uniform(1000, 40000))}  {"soft" if draw.chance(0.5) else "hard"} }}')
