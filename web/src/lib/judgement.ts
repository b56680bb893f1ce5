// Words for results: the CUSUM of a learning curve, a metric beside the experts.

import type { CurvePoint, MetricValue } from "./types.ts";

/** The last decision of the sequential test: each limit that is reached decides, and the next attempt begins a new test. */
export function cusum_verdict(values: (number | null)[], upper: number, lower: number): string {
  if (values.every((one) => one === null)) return "There are no attempts yet.";
  for (let k = values.length - 1; k >= 0; k -= 1) {
    const value = values[k];
    if (value === null) continue;
    if (value >= upper) return `Attempt ${k + 1} reached the upper limit: too many attempts fail.`;
    if (value <= lower) return `Attempt ${k + 1} reached the lower limit: the failure rate is acceptable.`;
  }
  return "The curve is between the limits: more attempts are needed for a decision.";
}

/** How strongly a metric separates the groups: an AUC, or of a metric without a better direction that of the direction in which it separates. */
export function separation_strength(metric: { auc: number | null; better?: string }): number | null {
  if (metric.auc === null) return null;
  return metric.better === "neither" ? Math.max(metric.auc, 1 - metric.auc) : metric.auc;
}

/** Values by point: the server may leave out attempts without a result. */
export function cusum_by_point(points: CurvePoint[], values: (number | null)[]): (number | null)[] {
  if (values.length === points.length) return values;
  let next = 0;
  return points.map((one) => (one.passed === null ? null : (values[next++] ?? null)));
}

/** Words for a value compared with the interquartile range of the experts. */
export function compared(metric: MetricValue): { text: string; tone: "good" | "bad" | "plain" } {
  const { value, expert_q1: q1, expert_q3: q3, better } = metric;
  if (value === null || q1 === null || q3 === null) return { text: "No comparison", tone: "plain" };
  if (value >= q1 && value <= q3) return { text: "Within the interquartile range of experts", tone: "good" };
  const above = value > q3;
  if (better === "neither") return { text: above ? "Above the range of experts" : "Below the range of experts", tone: "plain" };
  const is_better = (better === "higher") === above;
  return is_better ? { text: "Better than most experts", tone: "good" } : { text: above ? "Above the range of experts: worse" : "Below the range of experts: worse", tone: "bad" };
}
