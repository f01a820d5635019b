#!/usr/bin/env python3
"""tools/bench/exchange_sheets: contact sheets of random models of a format, each beside the picture of its own program:
`cfdg` draws Context Free (package contextfree), and Structure Synth EisenScript (package structure-synth, under Xvfb).
Models of other formats stand alone. Prints the model of each place, and how alike the two pictures are: 1 less the mean
difference of what both show, cut to its edges and shrunk to 32 x 32. Chance draws another picture in each program."""
import argparse
import random
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
import programs  # noqa: E402
from exchange_shapes_parts import likeness, names_in, synth_picture  # noqa: E402

FORMATS = {'ifs': ['ifs'], 'flame': ['flame', 'flam3'], 'es': ['es'], 'cfdg': ['cfdg']}
NEEDS = {'cfdg': 'need cfdg contextfree',
         'es': 'need structure-synth structure-synth; need Xvfb xvfb; need xdotool xdotool'}
SECONDS = 500


def run(command, folder=None):
    try:
        return subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL, timeout=SECONDS, cwd=folder)
    except subprocess.TimeoutExpired:
        return None


def models(kind, folder):
    """Each file once; of a file of many models, each by its name."""
    seen, found = set(), []
    for path in sorted(folder.rglob('*')):
        if path.suffix.lower().lstrip('.') not in FORMATS[kind] or not path.stat().st_size or path.read_bytes() in seen:
            continue
        seen.add(path.read_bytes())
        found += names_in.models(path)
    return found


def original(kind, model, picture, size):
    path = Path(model)
    if kind == 'cfdg':
        run(['cfdg', '-q', '-s', str(size), '-v', 'ABC', path.name, str(picture)], path.parent)
    elif kind == 'es':
        synth_picture.draw(path, picture, size, SECONDS)
    return picture.exists()


def own(program, model, picture, size):
    drawn = run([program, 'render', model, '--engine', 'native', '--quality', 'draft', '--size', f'{size}x{size}', '-o',
                 str(picture)])
    if drawn is not None and drawn.returncode and b'orbit' in drawn.stderr:
        drawn = run([program, 'points', model, '--size', f'{size}x{size}', '-o', str(picture)])
    return drawn is not None and drawn.returncode == 0 and picture.exists()


def sheet(pictures, output, cell, columns):
    """Pictures in rows, each in a square with a grey edge; None is black."""
    inputs, filters, places = [], '', []
    for i, picture in enumerate(pictures):
        inputs += ['-i', str(picture)] if picture else ['-f', 'lavfi', '-i', f'color=black:s={cell}x{cell}']
        filters += (f'[{i}]trim=end_frame=1,scale={cell - 8}:{cell - 8}:force_original_aspect_ratio=decrease,'
                    f'pad={cell}:{cell}:-1:-1:gray,format=rgb24[v{i}];')
        places.append(f'{i % columns * cell}_{i // columns * cell}')
    stack = ''.join(f'[v{i}]' for i in range(len(pictures))) + f'xstack=inputs={len(pictures)}:layout={"|".join(places)}'
    done = subprocess.run(['ffmpeg', '-v', 'error', '-y', *inputs, '-filter_complex', f'{filters}{stack}:fill=black',
                           '-frames:v', '1', str(output)], capture_output=True)
    if done.returncode:
        sys.exit(done.stderr.decode(errors='replace'))


def smoke(program):
    """0 if a sheet of two pictures shows both, and a picture is like itself and unlike the other."""
    with tempfile.TemporaryDirectory() as name:
        folder, pictures = Path(name), []
        for shape in ('SQUARE', 'TRIANGLE'):
            (folder / f'{shape}.cfdg').write_text(f'startshape A\nshape A {{ {shape} [] }}\n')
            pictures.append(folder / f'{shape}.png')
            if not own(program, str(folder / f'{shape}.cfdg'), pictures[-1], 64):
                return 1
        sheet(pictures, folder / 'sheet.png', 64, 2)
        width, height, data = likeness.pixels(folder / 'sheet.png')
        print(f'a sheet of {width}x{height}, like itself {likeness.of(*2 * pictures[:1]):.2f}, '
              f'the two {likeness.of(*pictures):.2f}')
        shown = all(0 in data[3 * (32 * width + at):3 * (32 * width + at + 8)] for at in (28, 92))
        return 0 if (width, height) == (128, 64) and shown and likeness.of(*2 * pictures[:1]) == 1 > likeness.of(*pictures) else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--collections', type=Path, metavar='FOLDER', help='with folders ifs, flame, es and cfdg')
    parser.add_argument('--format', choices=sorted(FORMATS))
    parser.add_argument('-o', '--output', type=Path, metavar='PNG')
    parser.add_argument('--count', type=int, default=24)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--size', type=int, default=240, metavar='PIXELS')
    parser.add_argument('--smoke', action='store_true', help='two models of its own, without other programs')
    options = parser.parse_args()
    if options.smoke:
        return smoke(programs.graftal())
    if not (options.collections and options.format and options.output):
        parser.error('name --collections, --format and --output')
    program = programs.graftal(NEEDS.get(options.format, ''))
    chosen = models(options.format, options.collections / options.format)
    random.Random(options.seed).shuffle(chosen)
    pictures = []
    with tempfile.TemporaryDirectory() as name:
        for i, model in enumerate(sorted(chosen[:options.count])):
            theirs, ours = Path(name) / f'{i}_theirs.png', Path(name) / f'{i}_ours.png'
            has_theirs = original(options.format, model, theirs, options.size)
            has_ours = own(program, model, ours, options.size)
            alike = f'{likeness.of(theirs, ours):.2f}' if has_theirs and has_ours else \
                '' if has_ours else 'graftal draws none'
            print(f'{i // 3 + 1}.{i % 3 + 1}  {model.removeprefix(str(options.collections))}  {alike}', flush=True)
            pictures += [theirs if has_theirs else None] if options.format in NEEDS else []
            pictures.append(ours if has_ours else None)
        sheet(pictures, options.output, options.size // 2 if options.size > 200 else options.size, 6)
    return 0


sys.exit(main())
