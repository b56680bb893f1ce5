// The 3D view: a path view that is turned by dragging, by buttons, or by the arrow keys while it has the focus.

import { h } from "../lib/dom.ts";
import { t } from "../lib/words.ts";
import { path_view, type PathView } from "./path_view.ts";
import { turned } from "./trace.ts";

const kStep_deg = 15;

export function turn_view(signal: AbortSignal): PathView {
  let turn = 35;
  let tilt = 20;
  const view = path_view(t("3D, turnable"), t("Path of the tip in 3D. Arrow keys turn the view."), turned(turn, tilt), signal, true);
  const turn_by = (dx: number, dy: number): void => {
    turn = (turn + dx) % 360;
    tilt = Math.max(-90, Math.min(90, tilt + dy));
    view.set_rotation(turned(turn, tilt));
  };
  const { canvas } = view;
  canvas.tabIndex = 0;
  canvas.classList.add("is-turnable");
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) turn_by(-0.5 * event.movementX, 0.5 * event.movementY);
  });
  canvas.addEventListener("keydown", (event) => {
    const step: Record<string, [number, number]> = { ArrowLeft: [kStep_deg, 0], ArrowRight: [-kStep_deg, 0], ArrowUp: [0, -kStep_deg], ArrowDown: [0, kStep_deg] };
    const by = step[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    turn_by(...by);
  });
  const button = (label: string, sign: string, dx: number, dy: number): HTMLElement =>
    h("button", { type: "button", class: "button button-small", "aria-label": label, on: { click: () => turn_by(dx, dy) } }, sign);
  view.element.append(
    h(
      "div",
      { class: "turn-buttons" },
      button(t("Turn left"), "←", kStep_deg, 0),
      button(t("Turn right"), "→", -kStep_deg, 0),
      button(t("Tilt up"), "↑", 0, -kStep_deg),
      button(t("Tilt down"), "↓", 0, kStep_deg),
    ),
  );
  return view;
}
