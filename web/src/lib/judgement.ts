// Words for results: the CUSUM of a learning curve, a metric beside the experts.

import type { CurvePoint, MetricValue } from "./types.ts";
import { t } from "./words.ts";

/** The last decision of the sequential test: each limit that is reached decides, and the next attempt begins a new test. */
export function cusum_verdict(values: (number | null)[], upper: number, lower: number): string {
  if (values.every((one) => one === null)) return t("There are no attempts yet.");
  for (let k = values.length - 1; k >= 0; k -= 1) {
    const value = values[k];
    if (value === null) continue;
    if (value >= upper) return t("Attempt {0} reached the upper limit: too many attempts fail.", k + 1);
    if (value <= lower) return t("Attempt {0} reached the lower limit: the failure rate is acceptable.", k + 1);
  }
  return t("The curve is between the limits: more attempts are needed for a decision.");
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
  if (value === null || q1 === null || q3 === null) return { text: t("No comparison"), tone: "plain" };
  if (value >= q1 && value <= q3) return { text: t("Within the interquartile range of experts"), tone: "good" };
  const above = value > q3;
  if (better === "neither") return { text: above ? t("Above the range of experts") : t("Below the range of experts"), tone: "plain" };
  const is_better = (better === "higher") === above;
  return is_better ? { text: t("Better than most experts"), tone: "good" } : { text: above ? t("Above the range of experts: worse") : t("Below the range of experts: worse"), tone: "bad" };
}
