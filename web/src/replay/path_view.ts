// A view of the tip's path on a canvas: plan, path so far, rest of the path, the expert's path, tip, scale, directions.

import { h } from "../lib/dom.ts";
import type { Point3, Trace } from "../lib/types.ts";
import { decimal } from "../lib/words.ts";
import { colour, on_theme_change } from "../ui/theme.ts";
import { nice_ticks } from "../plots/histogram.ts";
import { is_inside, project, tip_at, type Extent, type Rotation } from "./trace.ts";

export interface PathScene {
  trace: Trace;
  expert: Trace | null;
  extent: Extent;
  index: number;
  expert_index: number | null;
}
export interface PathView {
  element: HTMLElement;
  canvas: HTMLCanvasElement;
  draw: (scene: PathScene) => void;
  set_rotation: (rotation: Rotation) => void;
}

const kDirections: [string, Point3][] = [
  ["L", [1, 0, 0]], ["R", [-1, 0, 0]], ["P", [0, 1, 0]], ["A", [0, -1, 0]], ["H", [0, 0, 1]], ["F", [0, 0, -1]],
];

interface Pen {
  ctx: CanvasRenderingContext2D;
  width: number;
  height: number;
  to_screen: (point: Point3) => [number, number];
  pixels_per_mm: number;
}

function stroke_path(pen: Pen, trace: Trace, from: number, to: number, inside_width: number, outside_width: number): void {
  const { ctx } = pen;
  let before: [number, number] | null = null;
  let width = -1;
  ctx.beginPath();
  for (let k = from; k <= to; k += 1) {
    const tip = tip_at(trace, k);
    const at = tip ? pen.to_screen(tip) : null;
    const wished = is_inside(trace, k) ? inside_width : outside_width;
    if (wished !== width) {
      if (width >= 0) ctx.stroke();
      ctx.beginPath();
      if (before) ctx.moveTo(before[0], before[1]);
      ctx.lineWidth = width = wished;
    }
    if (at && before) ctx.lineTo(at[0], at[1]);
    else if (at) ctx.moveTo(at[0], at[1]);
    before = at;
  }
  ctx.stroke();
}

function draw_plan(pen: Pen, plan: { entry: Point3; target: Point3 }): void {
  const { ctx } = pen;
  const [entry, target] = [pen.to_screen(plan.entry), pen.to_screen(plan.target)];
  ctx.strokeStyle = colour("path");
  ctx.lineWidth = 2;
  ctx.setLineDash([7, 5]);
  ctx.beginPath();
  ctx.moveTo(...entry);
  ctx.lineTo(...target);
  ctx.stroke();
  ctx.setLineDash([]);
  ctx.beginPath();
  ctx.arc(entry[0], entry[1], 6, 0, 2 * Math.PI);
  ctx.stroke();
  ctx.strokeStyle = colour("target");
  ctx.beginPath();
  ctx.arc(target[0], target[1], 8, 0, 2 * Math.PI);
  for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
    ctx.moveTo(target[0] + 4 * dx, target[1] + 4 * dy);
    ctx.lineTo(target[0] + 12 * dx, target[1] + 12 * dy);
  }
  ctx.stroke();
}

function draw_tip(pen: Pen, trace: Trace, index: number, colour_name: string, radius: number): void {
  const tip = tip_at(trace, index);
  if (!tip) return;
  const { ctx } = pen;
  ctx.beginPath();
  ctx.arc(...pen.to_screen(tip), radius, 0, 2 * Math.PI);
  ctx.fillStyle = colour(colour_name);
  ctx.fill();
  ctx.lineWidth = 2;
  ctx.strokeStyle = colour("view");
  ctx.stroke();
}

function draw_scale(pen: Pen): void {
  const { ctx, width, height, pixels_per_mm } = pen;
  const steps = nice_ticks(0, (0.32 * width) / pixels_per_mm, 1);
  const length_mm = steps[steps.length - 1] || 10;
  const length = length_mm * pixels_per_mm;
  const [left, y] = [12, height - 12];
  ctx.strokeStyle = ctx.fillStyle = colour("text");
  ctx.lineWidth = 2;
  ctx.beginPath();
  ctx.moveTo(left, y - 5);
  ctx.lineTo(left, y);
  ctx.lineTo(left + length, y);
  ctx.lineTo(left + length, y - 5);
  ctx.stroke();
  ctx.textAlign = "left";
  ctx.textBaseline = "bottom";
  ctx.fillText(`${decimal(String(length_mm))} mm`, left, y - 7);
}

/** A letter at the border to which a direction of the body points, if it lies nearly in the picture. */
function draw_directions(pen: Pen, rotation: Rotation): void {
  const { ctx, width, height } = pen;
  ctx.fillStyle = colour("dim");
  ctx.font = "600 13px system-ui, sans-serif";
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  for (const [letter, direction] of kDirections) {
    const [u, v] = project(rotation, [0, 0, 0], direction);
    if (Math.hypot(u, v) < 0.6) continue;
    const reach = Math.min((width / 2 - 14) / Math.max(1e-6, Math.abs(u)), (height / 2 - 14) / Math.max(1e-6, Math.abs(v)));
    ctx.fillText(letter, width / 2 + u * reach, height / 2 + v * reach);
  }
}

export function path_view(title: string, description: string, start: Rotation, signal: AbortSignal, is_turnable = false): PathView {
  const canvas = h("canvas", { role: "img", "aria-label": description });
  const element = h("figure", { class: "path-view" }, h("figcaption", {}, title), canvas);
  let rotation = start;
  let scene: PathScene | null = null;

  const draw = (): void => {
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    if (!scene || width < 20 || height < 20) return;
    const ratio = devicePixelRatio || 1;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const ctx = canvas.getContext("2d");
    if (!ctx) return;
    const { extent, trace, expert, index, expert_index } = scene;
    const [across, along] = is_turnable ? [extent.radius_mm, extent.radius_mm] : [extent.half_across_mm, extent.half_along_mm];
    const pixels_per_mm = Math.min((width / 2 - 30) / across, (height / 2 - 30) / along);
    const pen: Pen = {
      ctx, width, height, pixels_per_mm,
      to_screen: (point) => {
        const [u, v] = project(rotation, extent.centre, point);
        return [width / 2 + u * pixels_per_mm, height / 2 + v * pixels_per_mm];
      },
    };
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    ctx.fillStyle = colour("view");
    ctx.fillRect(0, 0, width, height);
    ctx.lineJoin = ctx.lineCap = "round";
    draw_directions(pen, rotation);
    if (trace.plan) draw_plan(pen, trace.plan);
    const last = trace.time_s.length - 1;
    ctx.strokeStyle = `${colour("accent")}55`;
    stroke_path(pen, trace, index, last, 2, 1);
    if (expert) {
      ctx.strokeStyle = colour("expert");
      ctx.setLineDash([2, 5]);
      stroke_path(pen, expert, 0, expert.time_s.length - 1, 2.5, 1);
      ctx.setLineDash([]);
    }
    ctx.strokeStyle = colour("accent");
    stroke_path(pen, trace, 0, index, 3, 1.25);
    if (expert && expert_index !== null) draw_tip(pen, expert, expert_index, "expert", 5);
    draw_tip(pen, trace, index, "accent", 7);
    draw_scale(pen);
  };
  const observer = new ResizeObserver(draw);
  observer.observe(canvas);
  signal.addEventListener("abort", () => observer.disconnect());
  on_theme_change(signal, draw);
  return {
    element,
    canvas,
    draw: (wanted) => {
      scene = wanted;
      draw();
    },
    set_rotation: (wanted) => {
      rotation = wanted;
      draw();
    },
  };
}
