// Distribution of a metric: a histogram and a box of the quartiles for each group, over one axis.

import { h, svg } from "../lib/dom.ts";
import { fixed, number_text, said_words, with_unit } from "../lib/format.ts";
import type { MetricDistribution, MetricGroup } from "../lib/types.ts";
import { plural, t } from "../lib/words.ts";

const kLeft = 8;
const kRight = 8;
const kBars = 92;
const kBox = 26;

/** Ticks of 1, 2 or 5 times a power of ten inside [low, high]. */
export function nice_ticks(low: number, high: number, wished: number): number[] {
  const span = high - low;
  if (!(span > 0)) return [low];
  const rough = span / Math.max(1, wished);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((one) => one * power).find((one) => one >= rough * (1 - 1e-9))!;
  const ticks: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; k += 1) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

export function group_title(group: { group: string; simulated: boolean }): string {
  const name = group.group === "expert" ? t("Experts") : group.group === "trainee" ? t("Trainees") : said_words(group.group);
  return group.simulated ? t("{0} (simulated)", name) : name;
}

function group_summary(metric: MetricDistribution, group: MetricGroup): string {
  const people = plural(group.n, "{0} person", "{0} people");
  if (group.n === 0) return t("{0}: no value.", group_title(group));
  return t("{0}: {1}, median {2}, quartiles {3} to {4}.", group_title(group), people, with_unit(group.median, metric.unit), number_text(group.q1), with_unit(group.q3, metric.unit));
}

function group_drawing(metric: MetricDistribution, group: MetricGroup, width: number): SVGElement {
  const { edges } = metric;
  const low = edges[0];
  const high = edges[edges.length - 1];
  const x = (value: number): number => kLeft + ((value - low) / (high - low || 1)) * (width - kLeft - kRight);
  const most = Math.max(1e-12, ...group.counts.map((one) => one / Math.max(1, group.n)));
  const name = group.group === "expert" ? "path" : "accent";
  const height = kBars + kBox + 24;
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, width: String(width), height: String(height), role: "img", "aria-label": group_summary(metric, group) });
  group.counts.forEach((count, k) => {
    if (count === 0) return;
    const bar = (count / Math.max(1, group.n) / most) * (kBars - 16);
    const left = x(edges[k]);
    const wide = Math.max(1, x(edges[k + 1]) - left - 1.5);
    drawing.append(svg("rect", { class: `bar-${name}`, x: String(left), y: String(kBars - bar), width: String(wide), height: String(bar), rx: "1.5" }));
    if (wide > 14) drawing.append(svg("text", { class: "tick", x: String(left + wide / 2), y: String(kBars - bar - 3), "text-anchor": "middle" }, String(count)));
  });
  drawing.append(svg("line", { class: "axis", x1: String(kLeft), x2: String(width - kRight), y1: String(kBars + 0.5), y2: String(kBars + 0.5) }));
  const middle = kBars + 14;
  if (group.q1 !== null && group.q3 !== null && group.median !== null && group.min !== null && group.max !== null) {
    const [a, b, c, d, e] = [group.min, group.q1, group.median, group.q3, group.max].map(x);
    drawing.append(
      svg("line", { class: `box-${name}`, x1: String(a), x2: String(e), y1: String(middle), y2: String(middle) }),
      svg("rect", { class: `box-${name} box-body`, x: String(b), y: String(middle - 7), width: String(Math.max(1, d - b)), height: "14", rx: "2" }),
      svg("line", { class: `box-${name} box-median`, x1: String(c), x2: String(c), y1: String(middle - 7), y2: String(middle + 7) }),
    );
  }
  for (const tick of nice_ticks(low, high, width / 90)) {
    drawing.append(svg("text", { class: "tick", x: String(Math.min(width - 14, Math.max(10, x(tick)))), y: String(height - 4), "text-anchor": "middle" }, number_text(tick)));
  }
  return drawing;
}

export function histograms(metric: MetricDistribution, signal: AbortSignal): HTMLElement {
  const place = h("div", { class: "histograms" });
  const draw = (): void => {
    const width = Math.floor(place.clientWidth);
    if (width < 80) return;
    place.replaceChildren(
      ...metric.groups.map((group) =>
        h(
          "figure",
          { class: "histogram" },
          h("figcaption", {}, h("strong", {}, group_title(group)), h("span", { class: "dim" },  ": ", plural(group.n, "{0} person", "{0} people"))),
          group_drawing(metric, group, width),
        ),
      ),
    );
  };
  let width_before = 0;
  const observer = new ResizeObserver(() => {
    if (place.clientWidth === width_before) return;
    width_before = place.clientWidth;
    draw();
  });
  observer.observe(place);
  signal.addEventListener("abort", () => observer.disconnect());
  return place;
}

export function auc_text(auc: { value: number; low: number | null; high: number | null }): string {
  const value = fixed(auc.value, 2);
  return auc.low === null || auc.high === null ? value : t("{0} (95 % interval {1} to {2})", value, fixed(auc.low, 2), fixed(auc.high, 2));
}
