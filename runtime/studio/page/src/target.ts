// A picture that maps are fitted to, as cells: those with dark pixels or, where any pixel of the picture is not opaque, with opaque
// ones (docs/fit.md). The browser reads it.

const most_bytes = 64_000_000, most_px = 2 ** 25, most_cells_a_side = 1024, band_px = 2 ** 20;
/** A stored value from 0 to 255: darker pixels, or those of at least this alpha. */
const threshold = 127.5;

export interface Target {
  name: string;
  /** In pixels. */
  width: number;
  height: number;
  /** Pixels a cell, along a side. */
  cell: number;
  /** Lengths of runs of cells row by row, in turns outside and inside of the set. */
  runs: number[];
  /** The set as a picture, whose other cells are clear. */
  shown: string;
}

export async function read_target(file: File): Promise<Target> {
  if (file.size > most_bytes) throw new Error(`${file.name} is too large for a target: it has more than ${most_bytes / 1e6} MB.`);
  const address = URL.createObjectURL(file), image = new Image();
  try {
    await new Promise((resolve, reject) => {
      image.onload = resolve;
      image.onerror = () => reject(new Error(`${file.name} is no picture that this browser can read.`));
      image.src = address;
    });
    const { naturalWidth: width, naturalHeight: height } = image;
    if (!width || !height) throw new Error(`${file.name} has no pixels.`);
    if (width * height > most_px || Math.max(width, height) > 16384) throw new Error(`${file.name} has ${width}x${height} pixels: a target has 2^25 at most, and 16384 along a side. Make it smaller.`);
    return { name: file.name, ...await cells_of(image, width, height) };
  } finally {
    URL.revokeObjectURL(address);
  }
}

async function cells_of(image: HTMLImageElement, width: number, height: number): Promise<Omit<Target, 'name'>> {
  const cell = Math.ceil(Math.max(width, height) / most_cells_a_side);
  const columns = Math.ceil(width / cell), rows = Math.ceil(height / cell);
  const dark = new Uint8Array(columns * rows), opaque = new Uint8Array(columns * rows), canvas = document.createElement('canvas');
  let by_alpha = false;
  canvas.width = width;
  const band = canvas.height = Math.min(height, Math.max(1, Math.floor(band_px / width)));
  const context = canvas.getContext('2d', { willReadFrequently: true })!;
  for (let top = 0; top < height; top += band) {
    const lines = Math.min(band, height - top);
    context.clearRect(0, 0, width, band);
    context.drawImage(image, 0, -top, width, height);
    const { data } = context.getImageData(0, 0, width, lines);
    for (let y = 0, i = 0; y < lines; ++y) {
      const row = Math.floor((top + y) / cell) * columns;
      for (let x = 0; x < width; ++x, i += 4) {
        const at = row + Math.floor(x / cell);
        if (0.2126 * data[i]! + 0.7152 * data[i + 1]! + 0.0722 * data[i + 2]! < threshold) dark[at] = 1;
        if (data[i + 3]! >= threshold) opaque[at] = 1;
        by_alpha ||= data[i + 3]! < 255;
      }
    }
    await new Promise((go_on) => setTimeout(go_on)); // the page hears its person meanwhile
  }
  const set = by_alpha ? opaque : dark, runs = [0];
  set.forEach((inside, at) => {
    if (inside !== (at ? set[at - 1] : 0)) runs.push(0);
    ++runs[runs.length - 1]!;
  });
  return { width, height, cell, runs, shown: shown(set, columns, rows) };
}

function shown(set: Uint8Array, columns: number, rows: number): string {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [columns, rows];
  const context = canvas.getContext('2d')!, pixels = context.createImageData(columns, rows);
  set.forEach((inside, at) => pixels.data.set(inside ? [200, 30, 120, 255] : [0, 0, 0, 0], 4 * at));
  context.putImageData(pixels, 0, 0);
  return canvas.toDataURL();
}
