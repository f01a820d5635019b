// Motions of a camera: each gives a new one.
import type { Camera } from './protocol';
import { rounded } from './dom';
import { add, dot, length, subtract, times, turned, unit, units_of_pixel, view_of } from './vectors';

/** Around the point that it looks at: by so much to the right and up, in radians. It never turns over. */
export function orbited(camera: Camera, right_rad: number, up_rad: number): Camera {
  const pole = unit(camera.up), view = view_of(camera);
  const height_rad = Math.asin(Math.max(-1, Math.min(1, -dot(view.into, pole))));
  const most_rad = 1.55;
  const rise_rad = Math.max(-most_rad, Math.min(most_rad, height_rad + up_rad)) - height_rad;
  let arm = subtract(camera.location, camera.look_at);
  arm = turned(arm, view.right, -rise_rad);
  arm = turned(arm, pole, -right_rad);
  return { ...camera, location: add(camera.look_at, arm) };
}

/** The same view, which looks at what is so far off. */
export function aimed(camera: Camera, distance: number): Camera {
  return { ...camera, look_at: add(camera.location, times(view_of(camera).into, distance)) };
}

/** Sideways, so that what lies at the point it looks at follows the pointer. */
export function panned(camera: Camera, dx_px: number, dy_px: number, width_px: number): Camera {
  const view = view_of(camera), unit_of_px = units_of_pixel(camera, width_px);
  const by = add(times(view.right, -dx_px * unit_of_px), times(view.up, dy_px * unit_of_px));
  return { ...camera, location: add(camera.location, by), look_at: add(camera.look_at, by) };
}

/** With the digits that one can see: to a ten-thousandth of the distance. So a command line with it can be read. */
export function tidied(camera: Camera): Camera {
  const step = 1e-4 * length(subtract(camera.location, camera.look_at));
  const tidy = (place: Camera['location']) => place.map((number) => rounded(number, step)) as Camera['location'];
  return { ...camera, location: tidy(camera.location), look_at: tidy(camera.look_at) };
}

/** Nearer to the point that it looks at, `factor` times. Parallel rays draw together. */
export function dollied(camera: Camera, factor: number): Camera {
  if (camera.width) return { ...camera, width: camera.width / factor };
  return { ...camera, location: add(camera.look_at, times(subtract(camera.location, camera.look_at), 1 / factor)) };
}
