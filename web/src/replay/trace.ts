// Reading a trace: moments, bounds, tissues. Pure functions.

import type { Point3, Trace } from "../lib/types.ts";

/** Index of the last moment that is not after `time_s`; 0 before the first. */
export function index_at(times_s: number[], time_s: number): number {
  let low = 0;
  let high = times_s.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times_s[middle] <= time_s + 1e-9) low = middle;
    else high = middle - 1;
  }
  return Math.max(0, low);
}

export function tip_at(trace: Trace, index: number): Point3 | null {
  const x = trace.tip_x_mm[index];
  const y = trace.tip_y_mm[index];
  const z = trace.tip_z_mm[index];
  return typeof x === "number" && typeof y === "number" && typeof z === "number" ? [x, y, z] : null;
}

/** Null outside of the body. */
export function tissue_at(trace: Trace, index: number): string | null {
  const tissue = trace.tissue[index];
  const name = typeof tissue === "number" && tissue >= 0 ? (trace.tissues[tissue] ?? null) : null;
  return name === "air" && !is_inside(trace, index) ? null : name;
}

export function is_inside(trace: Trace, index: number): boolean {
  return (trace.depth_mm[index] ?? 0) > 0;
}

/** Points that have to be in the picture: the plan, and the tip inside the body or, on request, everywhere. */
export function points_to_show(trace: Trace, whole_path: boolean): Point3[] {
  const points: Point3[] = trace.plan ? [trace.plan.entry, trace.plan.target] : [];
  for (let k = 0; k < trace.time_s.length; k += 1) {
    const tip = tip_at(trace, k);
    if (tip && (whole_path || is_inside(trace, k))) points.push(tip);
  }
  if (points.length < 2 && !whole_path) return points_to_show(trace, true);
  return points;
}

/** What a picture of the points has to cover. */
export interface Extent {
  centre: Point3;
  /** Half of the extent across (of x and y the larger one, so that the views from front and side have one scale). */
  half_across_mm: number;
  /** Half of the extent along z. */
  half_along_mm: number;
  /** Largest distance from the centre, for a view that turns. */
  radius_mm: number;
}

export function extent_of(points: Point3[]): Extent {
  if (points.length === 0) return { centre: [0, 0, 0], half_across_mm: 50, half_along_mm: 50, radius_mm: 50 };
  const low: Point3 = [...points[0]];
  const high: Point3 = [...points[0]];
  for (const point of points) {
    for (let axis = 0; axis < 3; axis += 1) {
      low[axis] = Math.min(low[axis], point[axis]);
      high[axis] = Math.max(high[axis], point[axis]);
    }
  }
  const centre = [0, 1, 2].map((axis) => (high[axis] + low[axis]) / 2) as Point3;
  const half = [0, 1, 2].map((axis) => (high[axis] - low[axis]) / 2);
  let radius_mm = 10;
  for (const point of points) radius_mm = Math.max(radius_mm, Math.hypot(point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]));
  return { centre, half_across_mm: Math.max(10, half[0], half[1]), half_along_mm: Math.max(10, half[2]), radius_mm };
}

export interface Stretch {
  tissue: string;
  start_s: number;
  end_s: number;
}

/** Stretches of time in one tissue; time without a tissue is left out. */
export function tissue_stretches(trace: Trace): Stretch[] {
  const stretches: Stretch[] = [];
  const step = 1 / (trace.rate_hz || 25);
  trace.time_s.forEach((time_s, k) => {
    const tissue = tissue_at(trace, k);
    if (tissue === null) return;
    const last = stretches[stretches.length - 1];
    if (last && last.tissue === tissue && time_s - last.end_s < 0.5 * step) last.end_s = time_s + step;
    else stretches.push({ tissue, start_s: time_s, end_s: time_s + step });
  });
  return stretches;
}

export type Rotation = [Point3, Point3, Point3];  ///< Rows: right, down, away from the viewer, in P.

/** From the front: the patient's left on the right side, the head up. From the patient's left: front on the left. */
export const kFront: Rotation = [[1, 0, 0], [0, 0, -1], [0, 1, 0]];
export const kSide: Rotation = [[0, 1, 0], [0, 0, -1], [-1, 0, 0]];

/** The front view turned about the body's long axis, then tilted. Angles in degrees. */
export function turned(turn_deg: number, tilt_deg: number): Rotation {
  const [ct, st] = [Math.cos((turn_deg * Math.PI) / 180), Math.sin((turn_deg * Math.PI) / 180)];
  const [ci, si] = [Math.cos((tilt_deg * Math.PI) / 180), Math.sin((tilt_deg * Math.PI) / 180)];
  const right: Point3 = [ct, st, 0];
  const away: Point3 = [-st * ci, ct * ci, -si];
  const down: Point3 = [si * st, -si * ct, -ci];  // away x right
  return [right, down, away];
}

export function project(rotation: Rotation, centre: Point3, point: Point3): [number, number] {
  const d: Point3 = [point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]];
  const dot = (row: Point3): number => row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
  return [dot(rotation[0]), dot(rotation[1])];
}
