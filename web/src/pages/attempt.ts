// An attempt: score and its parts, hints, notes, replay, metrics compared with the experts'.

import { ApiError, get } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { clock_text, duration_text, fixed, level_text, sentence, state_text, with_unit, words } from "../lib/format.ts";
import { compared } from "../lib/judgement.ts";
import type { PageContext } from "../lib/router.ts";
import type { AttemptAnswer, MetricValue, ScorePart, Trace } from "../lib/types.ts";
import { said, t, t_nodes } from "../lib/words.ts";
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
  if (parts.length === 0) return card(t("Score"), {}, empty_box(t("No score"), t("This attempt was not scored.")));
  const columns: Column<ScorePart>[] = [
    { name: "title", title: t("Part"), is_header: true, cell: (one) => said(one.title) },
    ...(parts.some((one) => one.value_text) ? [{ name: "value", title: t("Measured"), is_number: true, cell: (one: ScorePart) => said(one.value_text ?? "–") }] : []),
    {
      name: "points", title: t("Points"), is_number: true,
      cell: (one) => h("span", { class: "score-cell" }, bar(one.max_points > 0 ? one.points / one.max_points : 0, part_tone(one)), h("span", { class: "points" }, t("{0} of {1}", fixed(one.points, 1), fixed(one.max_points, 1)))),
    },
  ];
  return fold_card(t("Parts of the score"), { class: "card-score" }, data_table({ caption: t("Points of each part"), columns, rows: parts }));
}

function comparison_cell(metric: MetricValue): Child {
  const verdict = compared(metric);
  const { value, expert_q1: q1, expert_median: median, expert_q3: q3 } = metric;
  const has_strip = value !== null && q1 !== null && median !== null && q3 !== null;
  return h("span", { class: "compared" }, has_strip && quartile_strip(value, q1, median, q3), h("span", { class: `verdict verdict-${verdict.tone}` }, verdict.text));
}

function metrics_card(metrics: MetricValue[]): HTMLElement {
  if (metrics.length === 0) return card(t("Metrics"), {}, empty_box(t("No metrics"), t("They are computed at the end of an attempt.")));
  const range = (one: MetricValue): string => (one.expert_q1 === null || one.expert_q3 === null ? "–" : t("{0} to {1}", with_unit(one.expert_q1, "1"), with_unit(one.expert_q3, one.unit)));
  const columns: Column<MetricValue>[] = [
    { name: "title", title: t("Metric"), is_header: true, key: (one) => said(one.title), cell: (one) => said(one.title) },
    { name: "value", title: t("Value"), is_number: true, cell: (one) => with_unit(one.value, one.unit) },
    { name: "median", title: t("Median of experts"), is_number: true, cell: (one) => with_unit(one.expert_median, one.unit) },
    { name: "range", title: t("Interquartile range of experts"), is_number: true, cell: range },
    { name: "better", title: t("Better values"), cell: (one) => (one.better === "neither" ? "–" : one.better === "lower" ? t("Lower") : t("Higher")) },
    { name: "compared", title: t("Comparison"), key: (one) => compared(one).tone, cell: comparison_cell },
  ];
  return fold_card(t("Metrics compared with experts"), {}, data_table({ caption: t("Each metric, with the interquartile range of the experts at this task"), columns, rows: metrics }));
}

function improvements({ attempt }: AttemptAnswer): Child {
  const { fails, hints } = attempt;
  return [
    fails.length > 0 && [h("h3", {}, t("Why it was not passed")), h("ul", { class: "fails" }, fails.map((one) => h("li", {}, sentence(said(one)))))],
    h("h3", {}, t("How to improve")),
    hints.length === 0
      ? h("p", { class: "dim" }, t("No hints for this attempt."))
      : h("ol", { class: "hints" }, hints.map((one) => h("li", {}, sentence(said(one.text)), one.at_s !== null && h("span", { class: "dim" }, " ", t("(at {0})", clock_text(one.at_s)))))),
  ];
}

function not_scored_text(not_scored: string | boolean | null): string | null {
  if (not_scored === true) return t("This attempt was not scored.");
  return typeof not_scored === "string" && not_scored ? t("Not scored: {0}", sentence(said(not_scored))) : null;
}

function show_attempt(answer: AttemptAnswer, context: PageContext): Child {
  const { attempt } = answer;
  const title = said(attempt.task_title ?? words(attempt.task));
  context.set_title(`${title}, ${attempt.person.name}`);
  const not_scored = not_scored_text(attempt.not_scored);
  const replay_place = h("div", {});
  void load_into(replay_place, context.signal, () => load_trace(attempt.id, context.signal), (trace) =>
    trace && trace.time_s.length > 1 ? replay(trace, context.signal) : empty_box(t("No recording"), t("The path of the needle was not stored, or it was deleted.")),
  );
  const facts: [string, Child][] = [
    [t("Started"), time_element(attempt.started_s)],
    [t("Patient"), attempt.patient],
    [t("Case difficulty (1–5)"), attempt.difficulty === null ? "–" : String(attempt.difficulty)],
    [t("Level of help"), level_text(attempt.level)],
    [t("Duration"), duration_text(attempt.duration_s)],
    [t("State"), state_text(attempt.state)],
    [t("Station"), attempt.station ?? "–"],
  ];
  return [
    breadcrumb({ label: t("Cohort"), path: "/" }, { label: attempt.person.name, path: `/people/${encodeURIComponent(attempt.person.id)}?task=${encodeURIComponent(attempt.task)}` }, { label: title }),
    h(
      "div",
      { class: "page-head" },
      h("h1", {}, title),
      person_badges({ simulated: attempt.person.simulated }),
      h("span", { class: "page-actions" }, print_button(), h("a", { class: "button", download: true, href: `/api/attempts/${encodeURIComponent(attempt.id)}/recording` }, t("Download session file"))),
    ),
    h("p", { class: "lead" }, t_nodes("Attempt by {0}", h("a", { href: `/people/${encodeURIComponent(attempt.person.id)}?task=${encodeURIComponent(attempt.task)}` }, attempt.person.name))),
    h("dl", { class: "facts" }, facts.map(([term, value]) => h("div", {}, h("dt", {}, term), h("dd", {}, value)))),
    h(
      "div",
      { class: "attempt-top" },
      card(t("Result"), { class: "card-result" }, score_gauge(attempt.score, attempt.passed), h("p", { class: "result-outcome" }, passed_text(attempt.passed, attempt.score)), not_scored && h("p", { class: "notice" }, not_scored), improvements(answer)),
      parts_card(answer.parts),
    ),
    notes_card(attempt.id, answer.notes ?? []),
    fold_card(t("Replay"), { class: "card-replay" }, replay_place),
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
  context.set_title(t("Attempt"));
  const place = h("div", {});
  context.main.append(place);
  const path = `/api/attempts/${encodeURIComponent(context.params[0])}`;
  const missing = { title: t("There is no such attempt"), text: t("It may have been deleted, or the address is incomplete."), link: { label: t("Go to the cohort"), path: "/" } };
  await load_into(place, context.signal, () => get<AttemptAnswer>(path, context.signal), (answer) => show_attempt(answer, context), missing);
}
