// Places of handles where a hand reaches them: in the stage, and beside what lies over the picture.

export type Place = [number, number];

export interface Area {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Whether a cover lies over a handle that reaches `radius` about a place. */
export function covers([x, y]: Place, { left, top, right, bottom }: Area, radius: number): boolean {
  return x > left - radius && x < right + radius && y > top - radius && y < bottom + radius;
}

/** The nearest place, about, that lies in the stage and in none of the covers; a handle reaches `radius` about it. */
export function reachable([x, y]: Place, stage: Area, over: Area[], radius: number): Place {
  const into = ([px, py]: Place): Place => [
    Math.max(stage.left + radius, Math.min(stage.right - radius, px)), Math.max(stage.top + radius, Math.min(stage.bottom - radius, py)),
  ];
  const is_free = (one: Place) => !over.some((cover) => covers(one, cover, radius));
  const place = into([x, y]);
  if (is_free(place)) return place;
  const [px, py] = place;
  const beside = over.flatMap(({ left, top, right, bottom }): Place[] => [
    [left - radius, py], [right + radius, py], [px, top - radius], [px, bottom + radius],
  ]).map(into);
  const far = ([a, b]: Place) => Math.hypot(a - px, b - py);
  return beside.filter(is_free).sort((a, b) => far(a) - far(b))[0] ?? place;
}

/** What lies over the picture, in pixels of the picture. */
export function covers_of(stage: Element, ids: string[], scale: number): Area[] {
  const box = stage.getBoundingClientRect();
  return ids.map((id) => document.getElementById(id)?.getBoundingClientRect()).filter((one) => one !== undefined && one.width > 0)
    .map((one) => ({
      left: (one!.left - box.left) * scale, top: (one!.top - box.top) * scale, right: (one!.right - box.left) * scale, bottom: (one!.bottom - box.top) * scale,
    }));
}
