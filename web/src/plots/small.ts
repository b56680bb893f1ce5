// Small drawings inside text and tables: score gauge, bar, quartile strip, interval, distribution of a scale.

import { h, svg } from "../lib/dom.ts";
import { fixed, scale_labels } from "../lib/format.ts";
import { t } from "../lib/words.ts";

/** Arc of the score, as in the trainer's window. */
export function score_gauge(score: number | null, passed: boolean | null): HTMLElement {
  const radius = 54;
  const length = 1.5 * Math.PI * radius;
  const share = Math.max(0, Math.min(1, (score ?? 0) / 100));
  const arc = (name: string, dash: string): SVGElement =>
    svg("circle", { class: name, cx: "64", cy: "64", r: String(radius), fill: "none", "stroke-width": "10", "stroke-linecap": "round", "stroke-dasharray": dash, transform: "rotate(135 64 64)" });
  const full = 2 * Math.PI * radius;
  const drawing = svg("svg", { viewBox: "0 0 128 128", width: "128", height: "128", "aria-hidden": "true" }, arc("gauge-rest", `${length} ${full}`));
  if (share > 0) drawing.append(arc(passed ? "gauge-good" : "gauge-bad", `${length * share} ${full}`));
  return h("div", { class: "gauge" }, drawing, h("p", { class: "gauge-value" }, score === null ? "–" : fixed(score, 0)), h("p", { class: "gauge-caption" }, score === null ? t("no score") : t("of 100")));
}

export function bar(share: number, tone: "good" | "accent" | "warning" | "bad" = "accent"): HTMLElement {
  const fill = h("span", { class: `bar-fill tone-${tone}` });
  fill.style.width = `${100 * Math.max(0, Math.min(1, share))}%`;
  return h("span", { class: "bar", "aria-hidden": "true" }, fill);
}

/** The experts' middle half as a band, their median as a line, the value as a dot. */
export function quartile_strip(value: number, q1: number, median: number, q3: number): SVGElement {
  const width = 150;
  const spread = Math.max(q3 - q1, Math.abs(median) * 0.05, 1e-9);
  const low = Math.min(value, q1) - 0.35 * spread;
  const high = Math.max(value, q3) + 0.35 * spread;
  const x = (at: number): number => 6 + ((at - low) / (high - low)) * (width - 12);
  const inside = value >= q1 && value <= q3;
  return svg(
    "svg",
    { class: "strip", viewBox: `0 0 ${width} 20`, width: String(width), height: "20", "aria-hidden": "true" },
    svg("line", { class: "axis", x1: "2", x2: String(width - 2), y1: "10", y2: "10" }),
    svg("rect", { class: "strip-band", x: String(x(q1)), y: "4", width: String(Math.max(2, x(q3) - x(q1))), height: "12", rx: "2" }),
    svg("line", { class: "strip-median", x1: String(x(median)), x2: String(x(median)), y1: "3", y2: "17" }),
    svg("circle", { class: inside ? "strip-dot" : "strip-dot strip-dot-out", cx: String(x(value)), cy: "10", r: "5" }),
  );
}

/** Area under the curve with its interval on 0..1; the line is 0.5, no separation. */
export function interval_strip(value: number, low: number | null, high: number | null): SVGElement {
  const width = 150;
  const x = (at: number): number => 4 + Math.max(0, Math.min(1, at)) * (width - 8);
  const strip = svg(
    "svg",
    { class: "strip", viewBox: `0 0 ${width} 20`, width: String(width), height: "20", "aria-hidden": "true" },
    svg("line", { class: "axis", x1: "4", x2: String(width - 4), y1: "10", y2: "10" }),
    svg("line", { class: "axis", x1: String(x(0.5)), x2: String(x(0.5)), y1: "2", y2: "18", "stroke-dasharray": "2 2" }),
  );
  if (low !== null && high !== null) strip.append(svg("line", { class: "interval", x1: String(x(low)), x2: String(x(high)), y1: "10", y2: "10" }));
  strip.append(svg("circle", { class: "strip-dot", cx: String(x(value)), cy: "10", r: "4.5" }));
  return strip;
}

/** Answers of a six-point item: one column an answer, with its count. */
export function scale_distribution(counts: number[]): HTMLElement {
  const most = Math.max(1, ...counts);
  return h(
    "ol",
    { class: "distribution" },
    scale_labels().map((label, k) => {
      const count = counts[k] ?? 0;
      const column = h("span", { class: "distribution-bar", "aria-hidden": "true" });
      column.style.height = `${(100 * count) / most}%`;
      return h("li", {}, h("span", { class: "distribution-count" }, String(count)), h("span", { class: "distribution-area" }, column), h("span", { class: "distribution-label" }, String(k + 1), h("span", { class: "hidden" }, ` ${label}`)));
    }),
  );
}

/** Quartiles of scores on 0..100: a line from the lowest to the highest, a band between the quartiles, the median as a dot. */
export function score_strip(scores: { min: number; q1: number; median: number; q3: number; max: number }): SVGElement {
  const width = 150;
  const x = (at: number): string => String(6 + (Math.max(0, Math.min(100, at)) / 100) * (width - 12));
  return svg(
    "svg",
    { class: "strip", viewBox: `0 0 ${width} 20`, width: String(width), height: "20", "aria-hidden": "true" },
    svg("line", { class: "axis strip-scale", x1: x(0), x2: x(100), y1: "10", y2: "10" }),
    svg("line", { class: "strip-median", x1: x(scores.min), x2: x(scores.max), y1: "10", y2: "10" }),
    svg("rect", { class: "strip-band", x: x(scores.q1), y: "4", width: String(Math.max(2, Number(x(scores.q3)) - Number(x(scores.q1)))), height: "12", rx: "2" }),
    svg("circle", { class: "strip-dot", cx: x(scores.median), cy: "10", r: "4.5" }),
  );
}

/** How many scores lie in each tenth of 0..100, as columns with their counts. */
export function score_histogram(bins: number[]): HTMLElement {
  const most = Math.max(1, ...bins);
  return h(
    "ol",
    { class: "distribution score-distribution" },
    bins.map((count, k) => {
      const column = h("span", { class: "distribution-bar", "aria-hidden": "true" });
      column.style.height = `${(100 * count) / most}%`;
      return h("li", {}, h("span", { class: "distribution-count" }, count > 0 ? String(count) : "\u00a0"), h("span", { class: "distribution-area" }, column), h("span", { class: "distribution-label" }, String(10 * k), h("span", { class: "hidden" }, " ", t("to {0}", 10 * (k + 1)))));
    }),
  );
}
