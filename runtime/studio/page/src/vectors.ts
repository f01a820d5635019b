// Vectors, and maps with twelve numbers by rows.
import type { Box, Camera, Matrix, Vec3 } from './protocol';

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a: Vec3, by: number): Vec3 => [a[0] * by, a[1] * by, a[2] * by];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Vec3): number => Math.hypot(...a);
export const unit = (a: Vec3): Vec3 => times(a, 1 / (length(a) || 1));

/** Rodrigues' formula; the axis has length 1. */
export function turned(a: Vec3, axis: Vec3, angle_rad: number): Vec3 {
  const cos = Math.cos(angle_rad), sin = Math.sin(angle_rad);
  return add(add(times(a, cos), times(cross(axis, a), sin)), times(axis, dot(axis, a) * (1 - cos)));
}

export function map_point(m: Matrix, p: Vec3): Vec3 {
  const row = (r: number) => m[4 * r]! * p[0] + m[4 * r + 1]! * p[1] + m[4 * r + 2]! * p[2] + m[4 * r + 3]!;
  return [row(0), row(1), row(2)];
}

/** The map with these images of the axes, and of the origin. */
export function matrix_of(x: Vec3, y: Vec3, z: Vec3, origin: Vec3): Matrix {
  return [0, 1, 2].flatMap((r) => [x[r]!, y[r]!, z[r]!, origin[r]!]);
}

export function column(m: Matrix, c: number): Vec3 {
  return [m[c]!, m[4 + c]!, m[8 + c]!];
}

/** First `inner`, then `outer`. */
export function compose(outer: Matrix, inner: Matrix): Matrix {
  const origin = column(outer, 3);
  const direction = (c: number) => subtract(map_point(outer, column(inner, c)), origin);
  return matrix_of(direction(0), direction(1), direction(2), map_point(outer, column(inner, 3)));
}

/** `turn` applied about the point `centre`. */
export function about(centre: Vec3, image: (direction: Vec3) => Vec3): Matrix {
  const x = image([1, 0, 0]), y = image([0, 1, 0]), z = image([0, 0, 1]);
  return matrix_of(x, y, z, subtract(centre, image(centre)));
}

export function middle(box: Box): Vec3 {
  return times(add(box.least, box.most), 0.5);
}

/** The corner whose bits say where it is: 1 for most along x, 2 along y, 4 along z. */
export function corner(box: Box, bits: number): Vec3 {
  return [0, 1, 2].map((axis) => (bits & (1 << axis) ? box.most : box.least)[axis]!) as Vec3;
}

/** The axis along which the model has no depth; null: it is a solid. */
export function flat_axis(box: Box | null): number | null {
  if (!box) return null;
  const extents = subtract(box.most, box.least), most = Math.max(...extents);
  for (const axis of [2, 0, 1]) if (extents[axis]! <= 1e-6 * most) return axis;
  return null;
}

/** Axes of a camera: to the right, up, and into the picture. */
export interface View {
  right: Vec3;
  up: Vec3;
  into: Vec3;
  distance: number;
}

export function view_of(camera: Camera): View {
  const sight = subtract(camera.look_at, camera.location);
  const into = unit(sight);
  let right = cross(into, camera.up);
  if (length(right) < 1e-9) right = cross(into, Math.abs(into[1]) < 0.9 ? [0, 1, 0] : [0, 0, 1]);
  right = unit(right);
  return { right, up: cross(right, into), into, distance: length(sight) };
}

/** How many units a pixel spans at the depth of `point`, in a picture `width_px` wide. */
export function units_of_pixel(camera: Camera, width_px: number, point: Vec3 = camera.look_at): number {
  if (camera.width) return camera.width / width_px;
  const depth = dot(subtract(point, camera.location), view_of(camera).into);
  return (2 * depth * Math.tan(((camera.angle_deg ?? 40) * Math.PI) / 360)) / width_px;
}

/** Where a point is in the picture, in pixels; null: behind the camera. */
export function projected(camera: Camera, width_px: number, height_px: number, point: Vec3): [number, number] | null {
  const view = view_of(camera), from_eye = subtract(point, camera.location);
  if (!camera.width && dot(from_eye, view.into) < 1e-6 * view.distance) return null;
  const unit_px = 1 / units_of_pixel(camera, width_px, point);
  return [width_px / 2 + dot(from_eye, view.right) * unit_px, height_px / 2 - dot(from_eye, view.up) * unit_px];
}

/** The point that lies `dx_px`, `dy_px` from `point` in the picture, in the plane with this normal. */
export function dragged(camera: Camera, width_px: number, point: Vec3, dx_px: number, dy_px: number, normal?: Vec3): Vec3 {
  const view = view_of(camera), unit_of_px = units_of_pixel(camera, width_px, point);
  const moved = add(point, add(times(view.right, dx_px * unit_of_px), times(view.up, -dy_px * unit_of_px)));
  if (!normal) return moved;
  // Along the ray of the pixel, back into the plane.
  const ray = camera.width ? view.into : unit(subtract(moved, camera.location));
  const slope = dot(ray, normal);
  if (Math.abs(slope) < 0.05) return moved;
  return subtract(moved, times(ray, dot(subtract(moved, point), normal) / slope));
}

/** Whether the corners of a box lie in the picture, but for a hundredth of it. */
export function is_in_view(camera: Camera, width_px: number, height_px: number, box: Box): boolean {
  const slack = 0.01;
  return [0, 1, 2, 3, 4, 5, 6, 7].every((bit) => {
    const place = projected(camera, width_px, height_px, corner(box, bit));
    return place !== null && [width_px, height_px].every((most, i) => place[i]! >= -slack * most && place[i]! <= (1 + slack) * most);
  });
}

/** How far along a way from a point one goes at least, to stay so far from another, or farther. */
export function far_from([x, y]: [number, number], [dx, dy]: [number, number], [cx, cy]: [number, number], far: number): number {
  const along = (x - cx) * dx + (y - cy) * dy, rest = along * along - (x - cx) ** 2 - (y - cy) ** 2 + far * far;
  return rest > 0 ? Math.max(0, Math.sqrt(rest) - along) : 0;
}

/** The convex hull of points, in order. */
export function hull_of(points: [number, number][]): [number, number][] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (from: [number, number][]) => {
    const kept: [number, number][] = [];
    for (const p of from) {
      while (kept.length > 1) {
        const [a, b] = [kept.at(-2)!, kept.at(-1)!];
        if (cross([b[0] - a[0], b[1] - a[1], 0], [p[0] - a[0], p[1] - a[1], 0])[2] > 0) break;
        kept.pop();
      }
      kept.push(p);
    }
    return kept.slice(0, -1);
  };
  return length(subtract([...(sorted[0] ?? [0, 0]), 0] as Vec3, [...(sorted.at(-1) ?? [0, 0]), 0] as Vec3)) === 0
    ? sorted.slice(0, 1) : [...half(sorted), ...half(sorted.reverse())];
}

/** Where a ray from a point inside of a hull meets its outline. */
export function edge_towards(hull: [number, number][], [x, y]: [number, number], [dx, dy]: [number, number]): [number, number] {
  let far = 0;
  hull.forEach(([ax, ay], i) => {
    const [bx, by] = hull[(i + 1) % hull.length]!, ex = bx - ax, ey = by - ay, slope = dx * ey - dy * ex;
    if (Math.abs(slope) < 1e-12) return;
    const along = ((ax - x) * ey - (ay - y) * ex) / slope, share = ((ax - x) * dy - (ay - y) * dx) / slope;
    if (share >= -1e-9 && share <= 1 + 1e-9) far = Math.max(far, along);
  });
  return [x + far * dx, y + far * dy];
}
