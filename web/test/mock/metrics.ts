// Made-up metric values: a function of skill plus noise.

import { Random } from "./random.ts";

export interface MockMetric {
  name: string;
  title: string;
  unit: string;
  better: "lower" | "higher" | "neither";
  novice: number;
  expert: number;
}

export const kMetrics: MockMetric[] = [
  { name: "score", title: "Score", unit: "1", better: "higher", novice: 38, expert: 92 },
  { name: "target_distance", title: "Distance of the tip from the target at the end", unit: "mm", better: "lower", novice: 11, expert: 1.4 },
  { name: "entry_offset", title: "Distance of the entry from the expert's entry", unit: "mm", better: "lower", novice: 19, expert: 4 },
  { name: "path_angle", title: "Angle between the needle and the expert path", unit: "deg", better: "lower", novice: 14, expert: 3 },
  { name: "frechet_distance", title: "Fréchet distance of the tip's path from the expert path", unit: "mm", better: "lower", novice: 22, expert: 5 },
  { name: "elapsed_time", title: "Elapsed time", unit: "s", better: "lower", novice: 140, expert: 52 },
  { name: "path_length", title: "Path length of the tip", unit: "mm", better: "lower", novice: 640, expert: 210 },
  { name: "tissue_damage", title: "Area swept by the shaft inside the body", unit: "mm²", better: "lower", novice: 2300, expert: 310 },
  { name: "depth_max", title: "Largest depth of the tip below the skin", unit: "mm", better: "neither", novice: 71, expert: 63 },
  { name: "skin_punctures", title: "Punctures of the skin", unit: "1", better: "lower", novice: 2.4, expert: 1.05 },
  { name: "redirections", title: "Redirections inside the body", unit: "1", better: "lower", novice: 3.1, expert: 0.4 },
  { name: "log_dimensionless_jerk", title: "Log dimensionless jerk of the tip", unit: "1", better: "higher", novice: -17.5, expert: -12.2 },
  { name: "force_peak", title: "Largest resistance along the needle", unit: "N", better: "neither", novice: 4.1, expert: 3.8 },
  { name: "plane_angle", title: "Median angle between needle and image plane", unit: "deg", better: "lower", novice: 11, expert: 2.6 },
  { name: "tip_visible", title: "Share of the advance with the tip in the image", unit: "%", better: "higher", novice: 41, expert: 93 },
];

export function metric_value(metric: MockMetric, skill: number, random: Random): number {
  const mean = metric.novice + (metric.expert - metric.novice) * skill;
  const value = mean * Math.exp(random.normal(0, 0.22));
  return metric.unit === "%" || metric.name === "score" ? Math.min(100, value) : value;
}

export function quantile(sorted: number[], share: number): number | null {
  if (sorted.length === 0) return null;
  const at = share * (sorted.length - 1);
  const low = Math.floor(at);
  return sorted[low] + (at - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
}

/** Share of pairs in which the expert has the higher value (lower, if lower is better). */
export function separation(experts: number[], novices: number[], lower_is_better: boolean): number {
  let sum = 0;
  for (const a of experts) for (const b of novices) sum += a === b ? 0.5 : (lower_is_better ? a < b : a > b) ? 1 : 0;
  return sum / Math.max(1, experts.length * novices.length);
}
