// Places of handles where a hand reaches them: in the stage, and beside what lies over the picture.

export type Place = [number, number];

export interface Area {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

const inside = ([x, y]: Place, { left, top, right, bottom }: Area) => x > left && x < right && y > top && y < bottom;

/** The nearest place, about, that lies in the stage and in none of the covers; a handle reaches `radius` about it. */
export function reachable([x, y]: Place, stage: Area, covers: Area[], radius: number): Place {
  const into = ([px, py]: Place): Place => [
    Math.max(stage.left + radius, Math.min(stage.right - radius, px)), Math.max(stage.top + radius, Math.min(stage.bottom - radius, py)),
  ];
  const wide = covers.map(({ left, top, right, bottom }) => ({ left: left - radius, top: top - radius, right: right + radius, bottom: bottom + radius }));
  const place = into([x, y]);
  if (!wide.some((cover) => inside(place, cover))) return place;
  const [px, py] = place;
  const beside = wide.flatMap(({ left, top, right, bottom }): Place[] => [[left, py], [right, py], [px, top], [px, bottom]]).map(into);
  const far = ([a, b]: Place) => Math.hypot(a - px, b - py);
  return beside.filter((one) => !wide.some((cover) => inside(one, cover))).sort((a, b) => far(a) - far(b))[0] ?? place;
}

/** What lies over the picture, in pixels of the picture. */
export function covers_of(stage: Element, ids: string[], scale: number): Area[] {
  const box = stage.getBoundingClientRect();
  return ids.map((id) => document.getElementById(id)?.getBoundingClientRect()).filter((one) => one !== undefined && one.width > 0)
    .map((one) => ({
      left: (one!.left - box.left) * scale, top: (one!.top - box.top) * scale, right: (one!.right - box.left) * scale, bottom: (one!.bottom - box.top) * scale,
    }));
}
