// A made-up recording: approach, insertion through layers, withdrawal.

import { Random } from "./random.ts";

type Point = [number, number, number];
const kEntry: Point = [-118, -32, 22];
const kTarget: Point = [-62, -4, 38];
const kLayers: [number, string, number][] = [[0, "skin", 3.4], [2, "fat", 0.4], [12, "muscle", 3], [24, "liver", 1.8], [52, "liver_lesion", 1.4]];

export function make_trace(seed: number, skill: number, duration_s: number): Record<string, unknown> {
  const random = new Random(seed);
  const rate_hz = 25;
  const count = Math.round(duration_s * rate_hz);
  const length = Math.hypot(...kTarget.map((one, k) => one - kEntry[k]));
  const axis = kTarget.map((one, k) => (one - kEntry[k]) / length) as Point;
  const phase = Array.from({ length: 6 }, () => random.uniform(0, 2 * Math.PI));
  const trace = { rate_hz, time_s: [] as number[], tip_x_mm: [] as number[], tip_y_mm: [] as number[], tip_z_mm: [] as number[], depth_mm: [] as number[], force_n: [] as number[], tissue: [] as number[] };
  const events: { time_s: number; text: string }[] = [];
  const error = (1 - skill) * 9 + 0.5;
  let deepest = -1;
  let since = 0;
  for (let k = 0; k < count; k += 1) {
    const t = k / rate_hz;
    const share = t / duration_s;
    const depth = share < 0.35 ? -60 * (1 - share / 0.35) : share < 0.85 ? (length + 3 * (1 - skill)) * Math.pow((share - 0.35) / 0.5, 0.85) + 1.2 * (1 - skill) * Math.sin(4 * t) : length * (1 - (share - 0.85) / 0.15);
    const wobble = (i: number): number => (error * 0.4 + (share < 0.35 ? 12 * (1 - share / 0.35) : 0)) * Math.sin(0.6 * t + phase[i]) * 0.5 + (error * Math.max(0, depth)) / length * Math.cos(phase[i + 3]) * 0.7;
    trace.time_s.push(Number(t.toFixed(3)));
    [trace.tip_x_mm, trace.tip_y_mm, trace.tip_z_mm].forEach((list, i) => list.push(Number((kEntry[i] + axis[i] * depth + wobble(i)).toFixed(2))));
    trace.depth_mm.push(Number(Math.max(0, depth).toFixed(2)));
    const layer = depth <= 0 ? -1 : kLayers.reduce((found, one, i) => (depth >= one[0] ? i : found), 0);
    trace.tissue.push(layer);
    if (layer > deepest) {
      deepest = layer;
      since = t;
      events.push({ time_s: t, text: `puncture:${kLayers[layer][1]}` });
    }
    const withdraws = share > 0.85;
    const peak = layer >= 0 && !withdraws ? kLayers[layer][2] * Math.exp(-(t - since) / 0.5) : 0;
    const friction = depth > 0 ? 0.015 * depth + 0.05 * Math.sin(3 * t) : 0;
    trace.force_n.push(Number((-(withdraws ? -friction : friction + peak)).toFixed(3)));
  }
  events.push({ time_s: duration_s * 0.84, text: "limit:force" });
  return { ...trace, tissues: kLayers.map((one) => one[1]), plan: { entry: kEntry, target: kTarget }, events };
}
