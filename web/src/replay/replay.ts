// Replay of an attempt: two projections and a 3D view of the tip's path, force and depth over time, one clock for all.

import { h, type Child } from "../lib/dom.ts";
import { clock_text, event_text, fixed, said_words } from "../lib/format.ts";
import type { Trace } from "../lib/types.ts";
import { decimal, t } from "../lib/words.ts";
import { line_plot, type DrawnPlot, type Series } from "../plots/line_plot.ts";
import { plain_table } from "../ui/table.ts";
import { select_field } from "../ui/parts.ts";
import { make_clock, type ReplayClock } from "./clock.ts";
import { path_view } from "./path_view.ts";
import { time_line } from "./time_line.ts";
import { extent_of, index_at, kFront, kSide, points_to_show, tissue_at } from "./trace.ts";
import { turn_view } from "./turn_view.ts";

const kSpeeds = ["0.25", "0.5", "1", "2", "4"];

/** A second trace at the moments of the first; null outside of its own time. */
function resampled(values: (number | null)[], times_s: number[], at_s: number[]): (number | null)[] {
  const end = times_s[times_s.length - 1] ?? -1;
  return at_s.map((time_s) => (time_s > end ? null : (values[index_at(times_s, time_s)] ?? null)));
}

/** Resistance is positive where the recorded force along the needle pushes it out. */
function resistance(force_n: (number | null)[]): (number | null)[] {
  return force_n.map((one) => (one === null ? null : one === 0 ? 0 : -one));
}

function time_plot(title: string, y_label: string, own: (number | null)[], expert: (number | null)[] | null, trace: Trace, clock: ReplayClock, signal: AbortSignal): DrawnPlot {
  const series: Series[] = [];
  if (expert) series.push({ label: t("Expert attempt"), values: expert, colour: "expert", mark: "dashed", width: 1.5 });
  series.push({ label: t("This attempt"), values: own, colour: "accent", mark: "line" });
  const known = own.filter((one): one is number => one !== null);
  const most = known.length ? Math.max(...known) : 0;
  const unit = y_label.replace(/.*\((.*)\)/, "$1");
  return line_plot({
    title,
    summary: known.length ? t("Largest value {0} {1} in {2} s.", fixed(most, 1), unit, fixed(clock.duration_s, 0)) : t("Not recorded."),
    x: trace.time_s,
    x_label: t("time (s)"),
    y_label,
    series,
    height: 190,
    signal,
    on_click: (time_s) => clock.set_time(time_s),
    table: () => second_table(title, unit, own, expert, trace),
  });
}

function second_table(title: string, unit: string, own: (number | null)[], expert: (number | null)[] | null, trace: Trace): Child {
  const rows: string[][] = [];
  let next_s = 0;
  trace.time_s.forEach((time_s, k) => {
    if (time_s < next_s) return;
    next_s += 1;
    const row = [fixed(time_s, 0), fixed(own[k], 2), said_words(tissue_at(trace, k))];
    if (expert) row.push(fixed(expert[k], 2));
    rows.push(row);
  });
  const titles = [t("Time (s)"), t("This attempt ({0})", unit), t("Tissue at the tip")];
  if (expert) titles.push(t("Expert attempt ({0})", unit));
  return plain_table(t("{0}, once a second", title), titles, rows);
}

function event_list(trace: Trace, clock: ReplayClock): HTMLElement {
  if (trace.events.length === 0) return h("p", { class: "dim" }, t("No events were recorded."));
  return h(
    "ol",
    { class: "events" },
    trace.events.map((one) =>
      h("li", {}, h("button", { type: "button", class: "event", on: { click: () => clock.set_time(one.time_s) } }, h("span", { class: "event-time" }, clock_text(one.time_s)), h("span", {}, event_text(one.text)))),
    ),
  );
}

function controls(clock: ReplayClock): HTMLElement {
  const play = h("button", { type: "button", class: "button button-primary play" }, t("Play"));
  const time = h("span", { class: "clock" });
  const step = (label: string, by_s: number): HTMLElement => h("button", { type: "button", class: "button", on: { click: () => clock.set_time(clock.time_s + by_s) } }, label);
  play.addEventListener("click", () => (clock.is_playing ? clock.pause() : clock.play()));
  clock.on_change(() => {
    play.textContent = clock.is_playing ? t("Pause") : t("Play");
    time.textContent = `${clock_text(clock.time_s)} / ${clock_text(clock.duration_s)}`;
  });
  const speed = select_field(t("Speed"), kSpeeds.map((one) => ({ value: one, label: `${decimal(one)}×` })), "1", (value) => clock.set_speed(Number(value)));
  return h("div", { class: "replay-controls" }, play, step(t("Back 1 s"), -1), step(t("Forward 1 s"), 1), time, speed);
}

/** Keys of the replay while the focus is inside it and not in a control that needs the key itself. */
function bind_keys(section: HTMLElement, clock: ReplayClock, signal: AbortSignal): void {
  section.addEventListener(
    "keydown",
    (event) => {
      const target = event.target as HTMLElement;
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const is_slider = target instanceof HTMLInputElement && target.type === "range";
      if (target.matches("select, summary, a, .scroll") || (target.matches("input") && !is_slider)) return;
      if (event.key === " ") {
        if (target.matches("button")) return;
        if (clock.is_playing) clock.pause();
        else clock.play();
      } else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
        clock.set_time(clock.time_s + (event.key === "ArrowLeft" ? -1 : 1) * (event.shiftKey ? 1 : 0.2));
      } else if (event.key === "Home" || event.key === "End") {
        clock.set_time(event.key === "Home" ? 0 : clock.duration_s);
      } else {
        return;
      }
      event.preventDefault();
    },
    { signal },
  );
}

/** A plan of no length is none. */
function without_empty_plan(trace: Trace): Trace {
  const has_plan = trace.plan !== null && trace.plan.entry.some((one, k) => one !== trace.plan!.target[k]);
  return has_plan ? trace : { ...trace, plan: null };
}

export function replay(given: Trace, signal: AbortSignal): HTMLElement {
  const trace = without_empty_plan(given);
  const expert = trace.expert ?? null;
  const start_s = trace.time_s[0] ?? 0;
  const end_s = trace.time_s[trace.time_s.length - 1] ?? 0;
  const clock = make_clock(end_s, signal);
  const line = time_line(trace, clock);

  const views = [
    path_view(t("From the front"), t("Path of the tip from the front; the patient's left is on the right."), kFront, signal),
    path_view(t("From the patient's left"), t("Path of the tip from the patient's left; front on the left."), kSide, signal),
    turn_view(signal),
  ];
  let extent = extent_of(points_to_show(trace, false));
  const now = h("p", { class: "now" });
  const own_force = resistance(trace.force_n);
  const draw = (): void => {
    const index = index_at(trace.time_s, clock.time_s);
    const expert_index = expert ? index_at(expert.time_s, clock.time_s) : null;
    for (const view of views) view.draw({ trace, expert, extent, index, expert_index });
    const tissue = tissue_at(trace, index);
    now.textContent = t("Depth {0} mm · resistance {1} N · {2}", fixed(trace.depth_mm[index], 1), fixed(own_force[index], 2), tissue ? said_words(tissue) : t("Outside"));
    for (const plot of plots) plot.set_marker(clock.time_s);
  };
  const expert_of = (values: (number | null)[] | undefined): (number | null)[] | null => (expert && values ? resampled(values, expert.time_s, trace.time_s) : null);
  const plots = [
    time_plot(t("Resistance along the needle"), t("force (N)"), own_force, expert_of(expert ? resistance(expert.force_n) : undefined), trace, clock, signal),
    time_plot(t("Depth of the tip"), t("depth (mm)"), trace.depth_mm, expert_of(expert?.depth_mm), trace, clock, signal),
  ];
  const extent_choice = select_field(t("Pictures show"), [{ value: "inside", label: t("The path inside the body") }, { value: "all", label: t("The whole path") }], "inside", (value) => {
    extent = extent_of(points_to_show(trace, value === "all"));
    draw();
  });
  const key = (name: string, text: string): HTMLElement => h("li", {}, h("span", { class: `key key-${name}`, "aria-hidden": "true" }), text);
  const section = h(
    "section",
    { class: "replay", tabindex: "0", role: "group", "aria-label": t("Replay. Space plays and pauses, arrow keys step."), "aria-keyshortcuts": "Space ArrowLeft ArrowRight Home End" },
    h("div", { class: "replay-top" }, h("ul", { class: "legend" }, key("own", t("Tip, this attempt")), trace.plan && key("plan", t("Planned path")), trace.plan && key("target", t("Target")), expert && key("expert", t("Best expert attempt, same case"))), extent_choice),
    h("div", { class: "path-views" }, views.map((one) => one.element)),
    controls(clock),
    line.element,
    now,
    h("p", { class: "help" }, t("Keys: Space plays and pauses, ← and → step 0.2 s, with Shift 1 s, Home and End jump.")),
    h("div", { class: "replay-plots" }, plots.map((one) => one.element)),
    h("h3", {}, t("Events")),
    event_list(trace, clock),
  );
  bind_keys(section, clock, signal);
  clock.on_change(draw);
  clock.set_time(start_s);
  return section;
}
