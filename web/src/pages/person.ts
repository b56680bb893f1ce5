// A person: learning curve and CUSUM of a task, the attempts, and what instructors change.

import { get, path_with, send } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";
import { date_time_text, duration_text, fixed, percent, plural, state_text, words } from "../lib/format.ts";
import { cusum_by_point, cusum_verdict } from "../lib/judgement.ts";
import { navigate, write_query, type PageContext } from "../lib/router.ts";
import type { AttemptList, Course, Curve, ListedAttempt, Person, PersonAnswer } from "../lib/types.ts";
import { line_plot, type Series } from "../plots/line_plot.ts";
import { change_person, remove_pin, set_pin } from "../manage/people.ts";
import { is_admin } from "../session.ts";
import { ask } from "../ui/dialog.ts";
import { breadcrumb, card, fold_card, group_badge, is_phone, passed_text, person_badges, reasons_list, run_once, select_field, time_element } from "../ui/parts.ts";
import { print_button } from "../ui/print.ts";
import { empty_box, error_box, load_into, toast } from "../ui/states.ts";
import { data_table, plain_table, type Column } from "../ui/table.ts";

function only(values: (number | null)[], keep: (index: number) => boolean): (number | null)[] {
  return values.map((one, k) => (keep(k) ? one : null));
}

function score_plot(curve: Curve, signal: AbortSignal): HTMLElement {
  const { points, experts, peers } = curve;
  const scores = points.map((one) => one.score);
  const series: Series[] = [];
  if (experts && experts.low !== null && experts.high !== null) {
    series.push({ label: `Experts' range (n = ${experts.n}${experts.simulated ? ", simulated" : ""})`, values: points.map(() => experts.low), upper: points.map(() => experts.high), colour: "path", mark: "band" });
  }
  if (experts?.mean !== null && experts?.mean !== undefined) series.push({ label: "Experts' mean", values: points.map(() => experts.mean), colour: "path", mark: "dotted", width: 1.5 });
  if (peers && peers.n > 0) series.push({ label: `Peers' mean (n = ${peers.n})`, values: points.map((one) => peers.mean_by_attempt[one.n - 1] ?? null), colour: "dim", mark: "dashed" });
  series.push(
    { label: "Moving mean", values: points.map((one) => one.moving_mean), colour: "accent", mark: "line", width: 3 },
    { label: "Passed", values: only(scores, (k) => points[k].passed === true), colour: "good", mark: "filled-points" },
    { label: "Not passed", values: only(scores, (k) => points[k].passed !== true), colour: "bad", mark: "hollow-points" },
  );
  // An attempt without a result has no score: its mark lies on the axis.
  if (scores.includes(null)) series.push({ label: "Without a result (not passed)", values: scores.map((one) => (one === null ? 0 : null)), colour: "bad", mark: "hollow-points" });
  const last = points[points.length - 1];
  return line_plot({
    title: "Score by attempt",
    summary: `${plural(points.length, "attempt")}; moving mean now ${fixed(last.moving_mean, 0)} of 100.`,
    x: points.map((one) => one.n),
    x_label: "attempt",
    y_label: "score",
    y_range: [0, 103],
    whole_x: true,
    series,
    signal,
    read_out: (k) => `Attempt ${points[k].n}, ${date_time_text(points[k].started_s)}: ${points[k].score === null ? "no result" : `${fixed(points[k].score, 0)} points`} on ${points[k].patient}, moving mean ${fixed(points[k].moving_mean, 0)}`,
    table: () =>
      plain_table(
        "Scores by attempt",
        ["Attempt", "Started", "Patient", "Score", "Result", "Moving mean", "Peers' mean"],
        points.map((one) => [
          String(one.n), date_time_text(one.started_s), one.patient, fixed(one.score, 0), one.score === null ? "no result" : one.passed ? "passed" : "not passed",
          fixed(one.moving_mean, 1), fixed(peers?.mean_by_attempt[one.n - 1], 1),
        ]),
      ),
  }).element;
}

function cusum_plot(curve: Curve, signal: AbortSignal): Child {
  const { points } = curve;
  const cusum = curve.cusum && { ...curve.cusum, values: cusum_by_point(points, curve.cusum.values) };
  if (!cusum || cusum.values.every((one) => one === null)) return empty_box("No CUSUM", "The curve appears after the first attempt that counts.");
  const known = cusum.values.filter((one): one is number => one !== null);
  const low = Math.min(cusum.lower, ...known);
  const high = Math.max(cusum.upper, ...known);
  const pad = 0.16 * (high - low || 1);
  const verdict = cusum_verdict(cusum.values, cusum.upper, cusum.lower);
  return [
    line_plot({
      title: "CUSUM of failures",
      summary: `CUSUM now ${fixed(known[known.length - 1], 2)}.`,
      x: points.map((one) => one.n),
      x_label: "attempt",
      y_label: "CUSUM",
      y_range: [low - pad, high + pad],
      whole_x: true,
      limits: [
        { value: cusum.upper, label: "upper limit: not acceptable", colour: "bad" },
        { value: cusum.lower, label: "lower limit: acceptable", colour: "good" },
      ],
      series: [{ label: "CUSUM", values: cusum.values, colour: "accent", mark: "line", width: 2.5 }],
      height: 240,
      signal,
      read_out: (k) => `Attempt ${points[k].n}: CUSUM ${fixed(cusum.values[k], 2)}`,
      table: () => plain_table("CUSUM by attempt", ["Attempt", "CUSUM"], points.map((one, k) => [String(one.n), fixed(cusum.values[k], 2)])),
    }).element,
    h("p", {}, h("strong", {}, verdict)),
    h("p", { class: "help" }, `A passed attempt lowers the curve; an attempt that was not passed or ended without a result raises it. At the lower limit the failure rate is acceptable (at most ${fixed(100 * cusum.acceptable, 0)} %), at the upper limit it is not (at least ${fixed(100 * cusum.unacceptable, 0)} %); after either, the next attempt starts again at 0.`),
  ];
}

function result_cell(attempt: ListedAttempt): Child {
  return h("span", { class: "result-cell" }, attempt.passed !== null ? passed_text(attempt.passed, attempt.score) : state_text(attempt.state), reasons_list(attempt));
}

function attempt_columns(): Column<ListedAttempt>[] {
  return [
    {
      name: "started", title: "Started", is_header: true,
      cell: (one) => h("span", { class: "person" }, h("a", { href: `/attempts/${encodeURIComponent(one.id)}` }, time_element(one.started_s)), one.notes ? h("span", { class: "badge badge-plain" }, plural(one.notes, "note")) : null),
    },
    { name: "patient", title: "Patient", cell: (one) => one.patient },
    { name: "level", title: "Level of help", cell: (one) => words(one.level) },
    { name: "score", title: "Score", is_number: true, cell: (one) => fixed(one.score, 0) },
    { name: "result", title: "Result", cell: result_cell },
    { name: "duration", title: "Duration", is_number: true, cell: (one) => duration_text(one.duration_s) },
    { name: "station", title: "Station", cell: (one) => one.station ?? "–" },
  ];
}

function attempts_section(person: Person, task: string, signal: AbortSignal): HTMLElement {
  const place = h("div", {});
  const more = h("div", { class: "more" });
  let rows: ListedAttempt[] = [];
  const path = (before: number | null): string => path_with(`/api/people/${encodeURIComponent(person.id)}/attempts`, { task, before, limit: is_phone() ? 10 : 50 });
  const show = (answer: AttemptList): Child => {
    rows = rows.concat(answer.attempts);
    const button = h("button", { type: "button", class: "button" }, "Older attempts");
    button.addEventListener("click", () => void run_once(button, () => load_older(answer.next!)));
    replace_children(more, answer.next !== null && [h("span", {}, `${rows.length} shown`), button]);
    if (rows.length === 0) return empty_box("No attempts", "This person has no attempts at this task.");
    return data_table({ caption: "Attempts, newest first", columns: attempt_columns(), rows });
  };
  const load_older = async (before: number): Promise<void> => {
    const first_new = rows.length;
    try {
      const answer = await get<AttemptList>(path(before), signal);
      replace_children(place, show(answer));
      place.querySelectorAll<HTMLElement>("tbody tr")[first_new]?.querySelector("a")?.focus();
    } catch (error) {
      if (!signal.aborted) replace_children(more, error_box(error, () => void load_older(before)));
    }
  };
  void load_into(place, signal, () => get<AttemptList>(path(null), signal), show);
  return fold_card("Attempts", {}, place, more);
}

function delete_button(person: Person): HTMLElement {
  const run = async (): Promise<void> => {
    await send("DELETE", `/api/people/${encodeURIComponent(person.id)}`, { confirm: person.name });
    toast(`${person.name} was deleted.`);
    navigate("/");
  };
  return h(
    "button",
    {
      type: "button",
      class: "button button-danger",
      on: {
        click: () =>
          ask({
            title: "Delete this person?",
            text: "All attempts, recordings, notes and answers of this person are deleted permanently. This cannot be undone.",
            action: "Delete",
            typed: { label: `Type the name to confirm: ${person.name}`, value: person.name },
            run,
          }),
      },
    },
    "Delete person …",
  );
}

/** Name, group, course and PIN. */
function manage_card(person: Person, courses: Course[], reload: () => void): HTMLElement {
  const button = (label: string, action: () => void): HTMLElement => h("button", { type: "button", class: "button", on: { click: action } }, label);
  const course = courses.find((one) => String(one.id) === String(person.course ?? ""))?.name ?? "none";
  return fold_card(
    "Manage this person",
    { class: "no-print" },
    h("p", { class: "dim" }, person.has_pin ? `Course: ${course}. This person has a PIN.` : `Course: ${course}. This person has no PIN.`),
    h("div", { class: "buttons" }, button("Rename or move …", () => change_person(person, courses, reload)), button(person.has_pin ? "Replace PIN …" : "Set PIN …", () => set_pin(person, reload)), person.has_pin && button("Remove PIN …", () => remove_pin(person, reload)), is_admin() && delete_button(person)),
    is_admin() && h("p", { class: "help" }, "Everybody may ask that all own results are deleted. Deleted data cannot be restored."),
  );
}

function show_person({ person, tasks, courses }: PersonAnswer, wished_task: string, context: PageContext, reload: () => void): Child {
  context.set_title(person.name);
  const practised = tasks.filter((one) => person.tasks[one.id] !== undefined);
  const header = [
    breadcrumb({ label: "Cohort", path: "/" }, { label: person.name }),
    h("div", { class: "page-head" }, h("h1", {}, person.name), person.group !== "expert" && group_badge(person.group), person_badges(person), h("span", { class: "page-actions" }, print_button())),
  ];
  const manage = manage_card(person, courses, reload);
  if (practised.length === 0) return [header, empty_box("No attempts yet", "Learning curves appear after the first attempt."), manage];
  const most = [...practised].sort((a, b) => (person.tasks[b.id].last_s ?? 0) - (person.tasks[a.id].last_s ?? 0))[0];
  const first = practised.some((one) => one.id === wished_task) ? wished_task : most.id;
  const place = h("div", { class: "stack" });
  let task_controller = new AbortController();
  const show_task = (task: string): void => {
    task_controller.abort();
    task_controller = new AbortController();
    const signal = AbortSignal.any ? AbortSignal.any([context.signal, task_controller.signal]) : context.signal;
    const result = person.tasks[task];
    const curves = h("div", {});
    replace_children(
      place,
      h(
        "dl",
        { class: "facts" },
        [
          ["Attempts", String(result.attempts)],
          ["Passed", `${result.passed} of ${result.attempts} (${percent(result.passed, result.attempts)})`],
          ["Mean of last 5 scores", fixed(result.recent_mean, 0)],
          ["Best score", fixed(result.best_score, 0)],
          ["Last attempt", date_time_text(result.last_s)],
        ].map(([term, value]) => h("div", {}, h("dt", {}, term), h("dd", {}, value))),
      ),
      result.counts_text ? h("p", { class: "dim" }, `${result.counts_text}.`) : null,
      curves,
      attempts_section(person, task, signal),
    );
    const path = path_with(`/api/people/${encodeURIComponent(person.id)}/curve`, { task });
    void load_into(curves, signal, () => get<Curve>(path, signal), (curve) =>
      curve.points.length === 0
        ? empty_box("No learning curve yet", "It appears after the first attempt that counts.")
        : h("div", { class: "curves" }, card("Learning curve", {}, score_plot(curve, signal)), fold_card("CUSUM: is the failure rate acceptable?", {}, cusum_plot(curve, signal))),
    );
  };
  const choice = select_field("Task", practised.map((one) => ({ value: one.id, label: one.title })), first, (task) => {
    write_query({ task });
    show_task(task);
  });
  show_task(first);
  return [header, h("div", { class: "filters" }, choice), place, manage];
}

export async function person_page(context: PageContext): Promise<void> {
  context.set_title("Person");
  const place = h("div", {});
  context.main.append(place);
  const path = `/api/people/${encodeURIComponent(context.params[0])}`;
  const missing = { title: "There is no such person", text: "The person may have been deleted, or the address is incomplete.", link: { label: "Go to the cohort", path: "/" } };
  const load = (): Promise<void> => load_into(place, context.signal, () => get<PersonAnswer>(path, context.signal), (answer) => show_person(answer, new URLSearchParams(location.search).get("task") ?? "", context, () => void load()), missing);
  await load();
}
