// An attempt: score and its parts, hints, notes, replay, metrics compared with the experts'.

import { ApiError, get } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { clock_text, duration_text, fixed, sentence, state_text, with_unit, words } from "../lib/format.ts";
import { compared } from "../lib/judgement.ts";
import type { PageContext } from "../lib/router.ts";
import type { AttemptAnswer, MetricValue, ScorePart, Trace } from "../lib/types.ts";
import { bar, quartile_strip, score_gauge } from "../plots/small.ts";
import { replay } from "../replay/replay.ts";
import { notes_card } from "../manage/notes.ts";
import { breadcrumb, card, fold_card, passed_text, person_badges, time_element } from "../ui/parts.ts";
import { print_button } from "../ui/print.ts";
import { empty_box, load_into } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";

function part_tone(part: ScorePart): "good" | "warning" | "bad" {
  const share = part.max_points > 0 ? part.points / part.max_points : 1;
  return share >= 0.8 ? "good" : share >= 0.5 ? "warning" : "bad";
}

function parts_card(parts: ScorePart[]): HTMLElement {
  if (parts.length === 0) return card("Score", {}, empty_box("No score", "This attempt was not scored."));
  const columns: Column<ScorePart>[] = [
    { name: "title", title: "Part", is_header: true, cell: (one) => one.title },
    ...(parts.some((one) => one.value_text) ? [{ name: "value", title: "Measured", is_number: true, cell: (one: ScorePart) => one.value_text ?? "–" }] : []),
    {
      name: "points", title: "Points", is_number: true,
      cell: (one) => h("span", { class: "score-cell" }, bar(one.max_points > 0 ? one.points / one.max_points : 0, part_tone(one)), h("span", { class: "points" }, `${fixed(one.points, 1)} of ${fixed(one.max_points, 1)}`)),
    },
  ];
  return fold_card("Parts of the score", { class: "card-score" }, data_table({ caption: "Points of each part", columns, rows: parts }));
}

function comparison_cell(metric: MetricValue): Child {
  const verdict = compared(metric);
  const { value, expert_q1: q1, expert_median: median, expert_q3: q3 } = metric;
  const has_strip = value !== null && q1 !== null && median !== null && q3 !== null;
  return h("span", { class: "compared" }, has_strip && quartile_strip(value, q1, median, q3), h("span", { class: `verdict verdict-${verdict.tone}` }, verdict.text));
}

function metrics_card(metrics: MetricValue[]): HTMLElement {
  if (metrics.length === 0) return card("Metrics", {}, empty_box("No metrics", "They are computed at the end of an attempt."));
  const range = (one: MetricValue): string => (one.expert_q1 === null || one.expert_q3 === null ? "–" : `${with_unit(one.expert_q1, "1")} to ${with_unit(one.expert_q3, one.unit)}`);
  const columns: Column<MetricValue>[] = [
    { name: "title", title: "Metric", is_header: true, key: (one) => one.title, cell: (one) => one.title },
    { name: "value", title: "Value", is_number: true, cell: (one) => with_unit(one.value, one.unit) },
    { name: "median", title: "Median of experts", is_number: true, cell: (one) => with_unit(one.expert_median, one.unit) },
    { name: "range", title: "Interquartile range of experts", is_number: true, cell: range },
    { name: "better", title: "Better values", cell: (one) => (one.better === "neither" ? "–" : words(one.better)) },
    { name: "compared", title: "Comparison", key: (one) => compared(one).tone, cell: comparison_cell },
  ];
  return fold_card("Metrics compared with experts", {}, data_table({ caption: "Each metric, with the interquartile range of the experts at this task", columns, rows: metrics }));
}

function improvements({ attempt }: AttemptAnswer): Child {
  const { fails, hints } = attempt;
  return [
    fails.length > 0 && [h("h3", {}, "Why it was not passed"), h("ul", { class: "fails" }, fails.map((one) => h("li", {}, sentence(one))))],
    h("h3", {}, "How to improve"),
    hints.length === 0
      ? h("p", { class: "dim" }, "No hints for this attempt.")
      : h("ol", { class: "hints" }, hints.map((one) => h("li", {}, sentence(one.text), one.at_s !== null && h("span", { class: "dim" }, ` (at ${clock_text(one.at_s)})`)))),
  ];
}

function not_scored_text(not_scored: string | boolean | null): string | null {
  if (not_scored === true) return "This attempt was not scored.";
  return typeof not_scored === "string" && not_scored ? `Not scored: ${not_scored}.` : null;
}

function show_attempt(answer: AttemptAnswer, context: PageContext): Child {
  const { attempt } = answer;
  const title = attempt.task_title ?? words(attempt.task);
  context.set_title(`${title}, ${attempt.person.name}`);
  const not_scored = not_scored_text(attempt.not_scored);
  const replay_place = h("div", {});
  void load_into(replay_place, context.signal, () => load_trace(attempt.id, context.signal), (trace) =>
    trace && trace.time_s.length > 1 ? replay(trace, context.signal) : empty_box("No recording", "The path of the needle was not stored, or it was deleted."),
  );
  const facts: [string, Child][] = [
    ["Started", time_element(attempt.started_s)],
    ["Patient", attempt.patient],
    ["Case difficulty (1–5)", attempt.difficulty === null ? "–" : String(attempt.difficulty)],
    ["Level of help", words(attempt.level)],
    ["Duration", duration_text(attempt.duration_s)],
    ["State", state_text(attempt.state)],
    ["Station", attempt.station ?? "–"],
  ];
  return [
    breadcrumb({ label: "Cohort", path: "/" }, { label: attempt.person.name, path: `/people/${encodeURIComponent(attempt.person.id)}?task=${encodeURIComponent(attempt.task)}` }, { label: title }),
    h(
      "div",
      { class: "page-head" },
      h("h1", {}, title),
      person_badges({ simulated: attempt.person.simulated }),
      h("span", { class: "page-actions" }, print_button(), h("a", { class: "button", download: true, href: `/api/attempts/${encodeURIComponent(attempt.id)}/recording` }, "Download session file")),
    ),
    h("p", { class: "lead" }, "Attempt by ", h("a", { href: `/people/${encodeURIComponent(attempt.person.id)}?task=${encodeURIComponent(attempt.task)}` }, attempt.person.name)),
    h("dl", { class: "facts" }, facts.map(([term, value]) => h("div", {}, h("dt", {}, term), h("dd", {}, value)))),
    h(
      "div",
      { class: "attempt-top" },
      card("Result", { class: "card-result" }, score_gauge(attempt.score, attempt.passed), h("p", { class: "result-outcome" }, passed_text(attempt.passed, attempt.score)), not_scored && h("p", { class: "notice" }, not_scored), improvements(answer)),
      parts_card(answer.parts),
    ),
    notes_card(attempt.id, answer.notes ?? []),
    fold_card("Replay", { class: "card-replay" }, replay_place),
    metrics_card(answer.metrics),
  ];
}

/** Null if the attempt has no recording. */
async function load_trace(id: string, signal: AbortSignal): Promise<Trace | null> {
  try {
    return await get<Trace>(`/api/attempts/${encodeURIComponent(id)}/trace`, signal);
  } catch (error) {
    if (error instanceof ApiError && error.status === 404) return null;
    throw error;
  }
}

export async function attempt_page(context: PageContext): Promise<void> {
  context.set_title("Attempt");
  const place = h("div", {});
  context.main.append(place);
  const path = `/api/attempts/${encodeURIComponent(context.params[0])}`;
  const missing = { title: "There is no such attempt", text: "It may have been deleted, or the address is incomplete.", link: { label: "Go to the cohort", path: "/" } };
  await load_into(place, context.signal, () => get<AttemptAnswer>(path, context.signal), (answer) => show_attempt(answer, context), missing);
}
