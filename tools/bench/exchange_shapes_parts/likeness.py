"""How alike two pictures are, whatever their frames."""
import subprocess

CELLS = 32


def pixels(path):
    """(width, height, bytes of red, green and blue)."""
    said = subprocess.run(['ffprobe', '-v', 'error', '-select_streams', 'v:0', '-show_entries', 'stream=width,height',
                           '-of', 'csv=p=0', str(path)], capture_output=True, check=True).stdout.decode()
    width, height = (int(number) for number in said.strip().split(',')[:2])
    data = subprocess.run(['ffmpeg', '-v', 'error', '-i', str(path), '-frames:v', '1', '-f', 'rawvideo', '-pix_fmt', 'rgb24', '-'],
                          capture_output=True, check=True).stdout
    return width, height, data


def shown(path):
    """Means of CELLS x CELLS cells of what differs from the corner, up to its edges; None of an empty picture."""
    width, height, data = pixels(path)
    corner = data[:3]
    rows, columns = [], []
    for y in range(height):
        row = data[3 * width * y:3 * width * (y + 1)]
        at = [x for x in range(width) if sum(abs(row[3 * x + i] - corner[i]) for i in range(3)) > 24]
        if at:
            rows.append(y)
            columns += [at[0], at[-1]]
    if not rows:
        return None
    top, left, high, wide = rows[0], min(columns), rows[-1] + 1 - rows[0], max(columns) + 1 - min(columns)
    cells = []
    for j in range(CELLS):
        for i in range(CELLS):
            ys = range(top + high * j // CELLS, max(top + high * (j + 1) // CELLS, top + high * j // CELLS + 1))
            xs = range(left + wide * i // CELLS, max(left + wide * (i + 1) // CELLS, left + wide * i // CELLS + 1))
            for channel in range(3):
                values = [data[3 * (width * y + x) + channel] for y in ys for x in xs]
                cells.append(sum(values) / len(values))
    return cells


def of(a, b):
    first, second = shown(a), shown(b)
    if first is None or second is None:
        return 1.0 if first is second else 0.0
    return 1 - sum(abs(x - y) for x, y in zip(first, second)) / len(first) / 255
