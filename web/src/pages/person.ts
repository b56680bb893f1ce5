// A person: learning curve and CUSUM of a task, the attempts, and what instructors change.

import { get, path_with, send } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";
import { date_time_text, duration_text, fixed, level_text, percent, sentence, state_text } from "../lib/format.ts";
import { cusum_by_point, cusum_verdict } from "../lib/judgement.ts";
import { navigate, write_query, type PageContext } from "../lib/router.ts";
import type { AttemptList, Course, Curve, ListedAttempt, Person, PersonAnswer } from "../lib/types.ts";
import { plural, said, t } from "../lib/words.ts";
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
    series.push({ label: experts.simulated ? t("Experts' range (n = {0}, simulated)", experts.n) : t("Experts' range (n = {0})", experts.n), values: points.map(() => experts.low), upper: points.map(() => experts.high), colour: "path", mark: "band" });
  }
  if (experts?.mean !== null && experts?.mean !== undefined) series.push({ label: t("Experts' mean"), values: points.map(() => experts.mean), colour: "path", mark: "dotted", width: 1.5 });
  if (peers && peers.n > 0) series.push({ label: t("Peers' mean (n = {0})", peers.n), values: points.map((one) => peers.mean_by_attempt[one.n - 1] ?? null), colour: "dim", mark: "dashed" });
  series.push(
    { label: t("Moving mean"), values: points.map((one) => one.moving_mean), colour: "accent", mark: "line", width: 3 },
    { label: t("Passed"), values: only(scores, (k) => points[k].passed === true), colour: "good", mark: "filled-points" },
    { label: t("Not passed"), values: only(scores, (k) => points[k].passed !== true), colour: "bad", mark: "hollow-points" },
  );
  // An attempt without a result has no score: its mark lies on the axis.
  if (scores.includes(null)) series.push({ label: t("Without a result (not passed)"), values: scores.map((one) => (one === null ? 0 : null)), colour: "bad", mark: "hollow-points" });
  const last = points[points.length - 1];
  return line_plot({
    title: t("Score by attempt"),
    summary: plural(points.length, "{0} attempt; moving mean now {1} of 100.", "{0} attempts; moving mean now {1} of 100.", fixed(last.moving_mean, 0)),
    x: points.map((one) => one.n),
    x_label: t("attempt"),
    y_label: t("score"),
    y_range: [0, 103],
    whole_x: true,
    series,
    signal,
    read_out: (k) => {
      const { n, started_s, score, patient, moving_mean } = points[k];
      const result = score === null ? t("no result") : t("{0} points", fixed(score, 0));
      return t("Attempt {0}, {1}: {2} on {3}, moving mean {4}", n, date_time_text(started_s), result, patient, fixed(moving_mean, 0));
    },
    table: () =>
      plain_table(
        t("Scores by attempt"),
        [t("Attempt"), t("Started"), t("Patient"), t("Score"), t("Result"), t("Moving mean"), t("Peers' mean")],
        points.map((one) => [
          String(one.n), date_time_text(one.started_s), one.patient, fixed(one.score, 0), one.score === null ? t("no result") : one.passed ? t("passed") : t("not passed"),
          fixed(one.moving_mean, 1), fixed(peers?.mean_by_attempt[one.n - 1], 1),
        ]),
      ),
  }).element;
}

function cusum_plot(curve: Curve, signal: AbortSignal): Child {
  const { points } = curve;
  const cusum = curve.cusum && { ...curve.cusum, values: cusum_by_point(points, curve.cusum.values) };
  if (!cusum || cusum.values.every((one) => one === null)) return empty_box(t("No CUSUM"), t("The curve appears after the first attempt that counts."));
  const known = cusum.values.filter((one): one is number => one !== null);
  const low = Math.min(cusum.lower, ...known);
  const high = Math.max(cusum.upper, ...known);
  const pad = 0.16 * (high - low || 1);
  const verdict = cusum_verdict(cusum.values, cusum.upper, cusum.lower);
  return [
    line_plot({
      title: t("CUSUM of failures"),
      summary: t("CUSUM now {0}.", fixed(known[known.length - 1], 2)),
      x: points.map((one) => one.n),
      x_label: t("attempt"),
      y_label: "CUSUM",
      y_range: [low - pad, high + pad],
      whole_x: true,
      limits: [
        { value: cusum.upper, label: t("upper limit: not acceptable"), colour: "bad" },
        { value: cusum.lower, label: t("lower limit: acceptable"), colour: "good" },
      ],
      series: [{ label: "CUSUM", values: cusum.values, colour: "accent", mark: "line", width: 2.5 }],
      height: 240,
      signal,
      read_out: (k) => t("Attempt {0}: CUSUM {1}", points[k].n, fixed(cusum.values[k], 2)),
      table: () => plain_table(t("CUSUM by attempt"), [t("Attempt"), "CUSUM"], points.map((one, k) => [String(one.n), fixed(cusum.values[k], 2)])),
    }).element,
    h("p", {}, h("strong", {}, verdict)),
    h("p", { class: "help" }, t("A passed attempt lowers the curve; an attempt that was not passed or ended without a result raises it. At the lower limit the failure rate is acceptable (at most {0} %), at the upper limit it is not (at least {1} %); after either, the next attempt starts again at 0.", fixed(100 * cusum.acceptable, 0), fixed(100 * cusum.unacceptable, 0))),
  ];
}

function result_cell(attempt: ListedAttempt): Child {
  return h("span", { class: "result-cell" }, attempt.passed !== null ? passed_text(attempt.passed, attempt.score) : state_text(attempt.state), reasons_list(attempt));
}

function attempt_columns(): Column<ListedAttempt>[] {
  return [
    {
      name: "started", title: t("Started"), is_header: true,
      cell: (one) => h("span", { class: "person" }, h("a", { href: `/attempts/${encodeURIComponent(one.id)}` }, time_element(one.started_s)), one.notes ? h("span", { class: "badge badge-plain" }, plural(one.notes, "{0} note", "{0} notes")) : null),
    },
    { name: "patient", title: t("Patient"), cell: (one) => one.patient },
    { name: "level", title: t("Level of help"), cell: (one) => level_text(one.level) },
    { name: "score", title: t("Score"), is_number: true, cell: (one) => fixed(one.score, 0) },
    { name: "result", title: t("Result"), cell: result_cell },
    { name: "duration", title: t("Duration"), is_number: true, cell: (one) => duration_text(one.duration_s) },
    { name: "station", title: t("Station"), cell: (one) => one.station ?? "–" },
  ];
}

function attempts_section(person: Person, task: string, signal: AbortSignal): HTMLElement {
  const place = h("div", {});
  const more = h("div", { class: "more" });
  let rows: ListedAttempt[] = [];
  const path = (before: number | null): string => path_with(`/api/people/${encodeURIComponent(person.id)}/attempts`, { task, before, limit: is_phone() ? 10 : 50 });
  const show = (answer: AttemptList): Child => {
    rows = rows.concat(answer.attempts);
    const button = h("button", { type: "button", class: "button" }, t("Older attempts"));
    button.addEventListener("click", () => void run_once(button, () => load_older(answer.next!)));
    replace_children(more, answer.next !== null && [h("span", {}, t("{0} shown", rows.length)), button]);
    if (rows.length === 0) return empty_box(t("No attempts"), t("This person has no attempts at this task."));
    return data_table({ caption: t("Attempts, newest first"), columns: attempt_columns(), rows });
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
  return fold_card(t("Attempts"), {}, place, more);
}

function delete_button(person: Person): HTMLElement {
  const run = async (): Promise<void> => {
    await send("DELETE", `/api/people/${encodeURIComponent(person.id)}`, { confirm: person.name });
    toast(t("{0} was deleted.", person.name));
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
            title: t("Delete this person?"),
            text: t("All attempts, recordings, notes and answers of this person are deleted permanently. This cannot be undone."),
            action: t("Delete"),
            typed: { label: t("Type the name to confirm: {0}", person.name), value: person.name },
            run,
          }),
      },
    },
    t("Delete person …"),
  );
}

/** Name, group, course and PIN. */
function manage_card(person: Person, courses: Course[], reload: () => void): HTMLElement {
  const button = (label: string, action: () => void): HTMLElement => h("button", { type: "button", class: "button", on: { click: action } }, label);
  const course = courses.find((one) => String(one.id) === String(person.course ?? ""))?.name ?? t("none");
  return fold_card(
    t("Manage this person"),
    { class: "no-print" },
    h("p", { class: "dim" }, person.has_pin ? t("Course: {0}. This person has a PIN.", course) : t("Course: {0}. This person has no PIN.", course)),
    h("div", { class: "buttons" }, button(t("Rename or move …"), () => change_person(person, courses, reload)), button(person.has_pin ? t("Replace PIN …") : t("Set PIN …"), () => set_pin(person, reload)), person.has_pin && button(t("Remove PIN …"), () => remove_pin(person, reload)), is_admin() && delete_button(person)),
    is_admin() && h("p", { class: "help" }, t("Everybody may ask that all own results are deleted. Deleted data cannot be restored.")),
  );
}

function show_person({ person, tasks, courses }: PersonAnswer, wished_task: string, context: PageContext, reload: () => void): Child {
  context.set_title(person.name);
  const practised = tasks.filter((one) => person.tasks[one.id] !== undefined);
  const header = [
    breadcrumb({ label: t("Cohort"), path: "/" }, { label: person.name }),
    h("div", { class: "page-head" }, h("h1", {}, person.name), person.group !== "expert" && group_badge(person.group), person_badges(person), h("span", { class: "page-actions" }, print_button())),
  ];
  const manage = manage_card(person, courses, reload);
  if (practised.length === 0) return [header, empty_box(t("No attempts yet"), t("Learning curves appear after the first attempt.")), manage];
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
          [t("Attempts"), String(result.attempts)],
          [t("Passed"), t("{0} of {1} ({2})", result.passed, result.attempts, percent(result.passed, result.attempts))],
          [t("Mean of last 5 scores"), fixed(result.recent_mean, 0)],
          [t("Best score"), fixed(result.best_score, 0)],
          [t("Last attempt"), date_time_text(result.last_s)],
        ].map(([term, value]) => h("div", {}, h("dt", {}, term), h("dd", {}, value))),
      ),
      result.counts_text ? h("p", { class: "dim" }, sentence(said(result.counts_text))) : null,
      curves,
      attempts_section(person, task, signal),
    );
    const path = path_with(`/api/people/${encodeURIComponent(person.id)}/curve`, { task });
    void load_into(curves, signal, () => get<Curve>(path, signal), (curve) =>
      curve.points.length === 0
        ? empty_box(t("No learning curve yet"), t("It appears after the first attempt that counts."))
        : h("div", { class: "curves" }, card(t("Learning curve"), {}, score_plot(curve, signal)), fold_card(t("CUSUM: is the failure rate acceptable?"), {}, cusum_plot(curve, signal))),
    );
  };
  const choice = select_field(t("Task"), practised.map((one) => ({ value: one.id, label: said(one.title) })), first, (task) => {
    write_query({ task });
    show_task(task);
  });
  show_task(first);
  return [header, h("div", { class: "filters" }, choice), place, manage];
}

export async function person_page(context: PageContext): Promise<void> {
  context.set_title(t("Person"));
  const place = h("div", {});
  context.main.append(place);
  const path = `/api/people/${encodeURIComponent(context.params[0])}`;
  const missing = { title: t("There is no such person"), text: t("The person may have been deleted, or the address is incomplete."), link: { label: t("Go to the cohort"), path: "/" } };
  const load = (): Promise<void> => load_into(place, context.signal, () => get<PersonAnswer>(path, context.signal), (answer) => show_person(answer, new URLSearchParams(location.search).get("task") ?? "", context, () => void load()), missing);
  await load();
}
