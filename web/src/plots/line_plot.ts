// A line plot (uPlot) with a legend in the page, a text alternative and a table of its values.

import uPlot from "uplot";
import { h, svg, type Child } from "../lib/dom.ts";
import { decimal, t } from "../lib/words.ts";
import { opened_later } from "../ui/table.ts";
import { colour, on_theme_change } from "../ui/theme.ts";

export type Mark = "line" | "dashed" | "dotted" | "filled-points" | "hollow-points" | "band";
export interface Series {
  label: string;
  values: (number | null)[];
  colour: string;  ///< Name in the style sheet.
  mark: Mark;
  width?: number;
  /** Of a band: its upper edge; `values` is the lower one. */
  upper?: (number | null)[];
}
export interface LinePlot {
  title: string;
  /** What a sighted reader sees at a glance. */
  summary: string;
  x: number[];
  x_label: string;
  y_label: string;
  series: Series[];
  y_range?: [number, number];
  /** Horizontal limits. */
  limits?: { value: number; label: string; colour: string }[];
  height?: number;
  whole_x?: boolean;
  /** Text under the plot for the point at the cursor. */
  read_out?: (index: number) => string;
  on_click?: (x: number) => void;
  table?: () => Child;
  signal: AbortSignal;
}
export interface DrawnPlot {
  element: HTMLElement;
  /** Moves the vertical line of the replay. */
  set_marker: (x: number) => void;
}

function is_points(mark: Mark): boolean {
  return mark === "filled-points" || mark === "hollow-points";
}

function legend_entry(label: string, colour_name: string, mark: Mark): HTMLElement {
  const stroke = `var(--${colour_name})`;
  const sample = svg("svg", { width: "26", height: "12", viewBox: "0 0 26 12", "aria-hidden": "true" });
  const shape =
    mark === "band"
      ? svg("rect", { x: "1", y: "2", width: "24", height: "8", style: { fill: stroke, "fill-opacity": "0.25" } })
      : is_points(mark)
        ? svg("circle", { cx: "13", cy: "6", r: "4", style: { stroke, "stroke-width": "2", fill: mark === "filled-points" ? stroke : "none" } })
        : svg("line", { x1: "1", x2: "25", y1: "6", y2: "6", style: { stroke, "stroke-width": "2.5", "stroke-dasharray": mark === "dashed" ? "6 4" : mark === "dotted" ? "2 3" : "none" } });
  sample.append(shape);
  return h("li", {}, sample, label);
}

function uplot_series(one: Series): uPlot.Series {
  const stroke = (): string => colour(one.colour);
  if (is_points(one.mark)) {
    const fill = one.mark === "filled-points" ? stroke : (): string => colour("panel");
    return { label: one.label, stroke, paths: () => null, points: { show: true, size: 8, width: 2, stroke, fill } };
  }
  const dash = one.mark === "dashed" ? [7, 5] : one.mark === "dotted" ? [2, 4] : [];
  return { label: one.label, stroke, width: one.width ?? 2, dash, spanGaps: false, points: { show: false } };
}

function draw_limits(u: uPlot, plot: LinePlot): void {
  const { ctx, bbox } = u;
  for (const limit of plot.limits ?? []) {
    const y = u.valToPos(limit.value, "y", true);
    if (y < bbox.top || y > bbox.top + bbox.height) continue;
    const ratio = devicePixelRatio;
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = colour(limit.colour);
    ctx.lineWidth = 1.5 * ratio;
    ctx.setLineDash([6 * ratio, 4 * ratio]);
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    ctx.font = `${12 * ratio}px ${kFont}`;
    ctx.textAlign = "right";
    const is_below = limit.value < 0;
    ctx.textBaseline = is_below ? "top" : "bottom";
    ctx.fillText(limit.label, bbox.left + bbox.width - 4 * ratio, y + (is_below ? 3 : -2) * ratio);
    ctx.restore();
  }
}

const kFont = "system-ui, sans-serif";

function axis(label: string, size: number): uPlot.Axis {
  return {
    label,
    labelSize: 18,
    labelGap: 2,
    gap: 4,
    labelFont: `12px ${kFont}`,
    font: `12px ${kFont}`,
    size,
    stroke: () => colour("dim"),
    grid: { stroke: () => colour("grid"), width: 1 },
    ticks: { show: false },
    values: (_u, values) => values.map((one) => (one === null ? "" : decimal(String(one).replace("-", "\u2212")))),
  };
}

function options_of(plot: LinePlot, width: number, read: (index: number | null) => void): { options: uPlot.Options; data: uPlot.AlignedData } {
  const data: (number | null)[][] = [plot.x];
  const series: uPlot.Series[] = [{}];
  const bands: uPlot.Band[] = [];
  for (const one of plot.series) {
    if (one.mark !== "band") {
      series.push(uplot_series(one));
      data.push(one.values);
      continue;
    }
    const edge: uPlot.Series = { label: one.label, width: 0, points: { show: false }, stroke: "transparent" };
    series.push(edge, { ...edge });
    data.push(one.upper ?? [], one.values);
    bands.push({ series: [series.length - 2, series.length - 1], fill: () => `${colour(one.colour)}33` });
  }
  const last = plot.x[plot.x.length - 1] ?? 1;
  const first = plot.x[0] ?? 0;
  const x_axis = axis(plot.x_label, 22);
  if (plot.whole_x) x_axis.incrs = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
  const options: uPlot.Options = {
    width,
    height: plot.height ?? 280,
    legend: { show: false },
    cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
    scales: {
      x: { time: false, range: plot.whole_x ? [first - 0.5, last + 0.5] : [first, last] },
      y: plot.y_range ? { range: plot.y_range } : {},
    },
    axes: [x_axis, axis(plot.y_label, 38)],
    series,
    bands,
    padding: [10, 12, 0, 0],
    hooks: {
      draw: [(u) => draw_limits(u, plot)],
      setCursor: [(u) => read(u.cursor.idx ?? null)],
    },
  };
  return { options, data: data as unknown as uPlot.AlignedData };
}

/** The plot draws itself when its place has a width, and again when width or theme change. */
export function line_plot(plot: LinePlot): DrawnPlot {
  const canvas_place = h("div", { class: "plot-canvas", role: "img", "aria-label": `${plot.title}. ${plot.summary}` });
  canvas_place.style.minHeight = `${plot.height ?? 280}px`;
  const read_out = h("p", { class: "read-out", "aria-hidden": "true" });
  const marker = h("div", { class: "plot-marker", hidden: true });
  let drawn: uPlot | null = null;
  let marker_x: number | null = null;

  const place_marker = (): void => {
    marker.hidden = marker_x === null || drawn === null;
    if (drawn && marker_x !== null) marker.style.transform = `translateX(${drawn.valToPos(marker_x, "x")}px)`;
  };
  const draw = (): void => {
    const width = Math.floor(canvas_place.clientWidth);
    if (width < 50 || plot.signal.aborted) return;
    drawn?.destroy();
    const { options, data } = options_of(plot, width, (index) => {
      if (plot.read_out) read_out.textContent = index === null ? plot.summary : plot.read_out(index);
    });
    drawn = new uPlot(options, data, canvas_place);
    drawn.over.append(marker);
    if (plot.on_click) {
      const over = drawn.over;
      over.classList.add("is-clickable");
      over.addEventListener("click", (event) => plot.on_click!(drawn!.posToVal(event.clientX - over.getBoundingClientRect().left, "x")));
    }
    place_marker();
  };
  let width_before = 0;
  const observer = new ResizeObserver(() => {
    const width = Math.floor(canvas_place.clientWidth);
    if (width === width_before) return;
    width_before = width;
    draw();
  });
  observer.observe(canvas_place);
  on_theme_change(plot.signal, draw);
  plot.signal.addEventListener("abort", () => {
    observer.disconnect();
    drawn?.destroy();
  });

  const entries = plot.series.map((one) => legend_entry(one.label, one.colour, one.mark));
  const element = h(
    "figure",
    { class: "plot" },
    h("figcaption", {}, h("span", { class: "plot-title" }, plot.title), h("ul", { class: "legend" }, entries)),
    canvas_place,
    plot.read_out && read_out,
    plot.table && opened_later(t("Values as a table"), plot.table),
  );
  if (plot.read_out) read_out.textContent = plot.summary;
  return {
    element,
    set_marker: (x) => {
      marker_x = x;
      place_marker();
    },
  };
}
