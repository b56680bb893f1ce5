// The cohort: every person with the results of one task, or the recent means of all tasks.

import { get, path_with } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";
import { date_text, fixed, percent } from "../lib/format.ts";
import { write_query, type PageContext } from "../lib/router.ts";
import type { Overview, Person, TaskResult } from "../lib/types.ts";
import { plural, said, t } from "../lib/words.ts";
import { add_person, move_people } from "../manage/people.ts";
import { is_phone, person_badges, select_field } from "../ui/parts.ts";
import { print_button } from "../ui/print.ts";
import { bar } from "../plots/small.ts";
import { empty_box, load_into } from "../ui/states.ts";
import { data_table, type Column, type Order } from "../ui/table.ts";

interface Filter {
  search: string;
  course: string;
  group: string;
  task: string;
  order: Order;
}

export function matches(person: Person, filter: { search: string; course: string; group: string }): boolean {
  const text = filter.search.trim().toLocaleLowerCase();
  if (text && !person.name.toLocaleLowerCase().includes(text)) return false;
  if (filter.course && String(person.course ?? "") !== filter.course) return false;
  if (filter.group === "simulated") return person.simulated;
  if (filter.group === "people") return !person.simulated;
  return !filter.group || person.group === filter.group;
}

interface Counted {
  attempts: number;
  unscored: number;
  never_began: number;
  lost: number;
  running: number;
}
/** "24 attempts counted (16 ended without a result), 3 left out: 2 never began, 1 was lost to a crash" of several. */
export function counted_text(all: Counted[]): string {
  const sum = (name: keyof Counted): number => all.reduce((value, one) => value + one[name], 0);
  const left_out = [
    { count: sum("never_began"), text: t("{0} never began", sum("never_began")) },
    { count: sum("lost"), text: plural(sum("lost"), "{0} was lost to a crash", "{0} were lost to crashes") },
    { count: sum("running"), text: plural(sum("running"), "{0} is not over", "{0} are not over") },
  ].filter((one) => one.count > 0);
  const unscored = sum("unscored");
  const attempts = plural(sum("attempts"), "{0} attempt counted", "{0} attempts counted");
  const counted = unscored ? t("{0} ({1} ended without a result)", attempts, unscored) : attempts;
  if (left_out.length === 0) return counted;
  return t("{0}, {1} left out: {2}", counted, left_out.reduce((value, one) => value + one.count, 0), left_out.map((one) => one.text).join(", "));
}

/** Sums over all tasks of a person. */
export function total(person: Person): Counted & { passed: number; last_s: number | null } {
  const sum = { attempts: 0, passed: 0, unscored: 0, never_began: 0, lost: 0, running: 0, last_s: null as number | null };
  for (const one of Object.values(person.tasks)) {
    sum.attempts += one.attempts;
    sum.passed += one.passed;
    sum.unscored += one.unscored;
    sum.never_began += one.never_began;
    sum.lost += one.lost;
    sum.running += one.running;
    if (one.last_s !== null) sum.last_s = Math.max(sum.last_s ?? 0, one.last_s);
  }
  return sum;
}

function score_cell(score: number | null | undefined): Child {
  if (score === null || score === undefined) return h("span", { class: "dim" }, "–");
  return h("span", { class: "score-cell" }, bar(score / 100), h("span", { class: "score-number" }, fixed(score, 0)));
}

function passed_cell(result: { attempts: number; passed: number }): Child {
  if (result.attempts === 0) return h("span", { class: "dim" }, "–");
  return [t("{0} of {1}", result.passed, result.attempts), " ", h("span", { class: "dim" }, `(${percent(result.passed, result.attempts)})`)];
}

function columns_of(overview: Overview, task: string): Column<Person>[] {
  const course_names = new Map(overview.courses.map((one) => [String(one.id), one.name]));
  const course = (person: Person): string => (person.course === null ? "–" : (course_names.get(String(person.course)) ?? String(person.course)));
  const of_task = (person: Person): TaskResult | undefined => person.tasks[task];
  const result = (person: Person): { attempts: number; passed: number; last_s: number | null } => (task ? (of_task(person) ?? { attempts: 0, passed: 0, last_s: null }) : total(person));
  const person_path = (person: Person): string => path_with(`/people/${encodeURIComponent(person.id)}`, { task });
  const scores: Column<Person>[] = task
    ? [
        { name: "last", title: t("Last score"), is_number: true, key: (one) => of_task(one)?.last_score ?? null, cell: (one) => fixed(of_task(one)?.last_score, 0) },
        { name: "best", title: t("Best score"), is_number: true, key: (one) => of_task(one)?.best_score ?? null, cell: (one) => fixed(of_task(one)?.best_score, 0) },
        { name: "mean", title: t("Mean of last 5"), is_number: true, key: (one) => of_task(one)?.recent_mean ?? null, cell: (one) => score_cell(of_task(one)?.recent_mean) },
      ]
    : overview.tasks.map((one) => ({
        name: `mean-${one.id}`,
        title: said(one.title),
        is_number: true,
        key: (person: Person) => person.tasks[one.id]?.recent_mean ?? null,
        cell: (person: Person) => score_cell(person.tasks[one.id]?.recent_mean),
      }));
  return [
    { name: "name", title: t("Name"), is_header: true, key: (one) => one.name, cell: (one) => h("span", { class: "person" }, h("a", { href: person_path(one) }, one.name), person_badges(one)) },
    { name: "course", title: t("Course"), key: course, cell: course },
    { name: "attempts", title: t("Attempts"), is_number: true, key: (one) => result(one).attempts, cell: (one) => String(result(one).attempts) },
    { name: "passed", title: t("Passed"), is_number: true, key: (one) => (result(one).attempts ? result(one).passed / result(one).attempts : null), cell: (one) => passed_cell(result(one)) },
    ...scores,
    { name: "date", title: t("Last attempt"), is_number: true, key: (one) => result(one).last_s, cell: (one) => date_text(result(one).last_s) },
  ];
}

function read_filter(query: URLSearchParams): Filter {
  const [column = "name", direction = ""] = (query.get("order") ?? "name").split(".");
  return {
    search: query.get("search") ?? "",
    course: query.get("course") ?? "",
    group: query.get("group") ?? "",
    task: query.get("task") ?? "",
    order: { column, is_descending: direction === "down" },
  };
}

function show_cohort(overview: Overview, filter: Filter, actions: Element, reload: () => void): Child {
  const add = h("button", { type: "button", class: "button button-primary", on: { click: () => add_person(overview.courses) } }, t("Add person …"));
  if (overview.people.length === 0) {
    replace_children(actions, add);
    return empty_box(t("No results yet"), t("Attempts appear here after somebody has practised at a station that uses this database."));
  }
  const shown_people = (): Person[] => overview.people.filter((one) => matches(one, filter));
  const place = h("div", {});
  const count = h("p", { class: "dim", role: "status" });
  const export_link = h("a", { class: "button", download: true }, t("Attempts as CSV"));
  const notes_link = h("a", { class: "button", download: true }, t("Notes as CSV"));
  const move = h("button", { type: "button", class: "button", on: { click: () => move_people(shown_people(), overview.courses, reload) } }, t("Move people …"));
  replace_children(actions, print_button(), export_link, notes_link, move, add);
  const fill = (): void => {
    const people = shown_people();
    const simulated = people.filter((one) => one.simulated).length;
    const results = people.flatMap((one) => (filter.task ? (one.tasks[filter.task] ?? []) : total(one)));
    const shown = plural(people.length, "{0} person of {1}", "{0} people of {1}", overview.people.length);
    count.textContent = `${simulated ? t("{0}, {1} simulated", shown, simulated) : shown}; ${counted_text(results)}`;
    export_link.href = path_with("/api/export/attempts.csv", { task: filter.task, course: filter.course });
    notes_link.href = path_with("/api/export/notes.csv", { task: filter.task, course: filter.course });
    const caption = filter.task ? t("Results of {0}", said(overview.tasks.find((one) => one.id === filter.task)?.title ?? filter.task)) : t("Mean of the last five scores at each task");
    replace_children(
      place,
      people.length === 0
        ? empty_box(t("Nobody matches"), t("Change the search or the filters."))
        : data_table({
            caption,
            columns: columns_of(overview, filter.task),
            rows: people,
            order: filter.order,
            page_size: is_phone() ? 10 : 100,
            on_order: (order) => {
              filter.order = order;
              store();
            },
          }),
    );
  };
  const store = (): void => {
    const { search, course, group, task, order } = filter;
    const order_text = order.column === "name" && !order.is_descending ? "" : `${order.column}.${order.is_descending ? "down" : "up"}`;
    write_query({ search, course, group, task, order: order_text });
  };
  const change = (): void => {
    store();
    fill();
  };
  const search = h("input", { id: "search", class: "field", type: "search", value: filter.search, autocomplete: "off", on: { input: () => { filter.search = search.value; change(); } } });
  const tasks = [{ value: "", label: t("All tasks") }, ...overview.tasks.map((one) => ({ value: one.id, label: said(one.title) }))];
  const courses = [{ value: "", label: t("All courses") }, ...overview.courses.map((one) => ({ value: String(one.id), label: one.name }))];
  const groups = [
    { value: "", label: t("Everyone") },
    { value: "trainee", label: t("Trainees") },
    { value: "expert", label: t("Experts") },
    { value: "people", label: t("Without simulated people") },
    { value: "simulated", label: t("Simulated people only") },
  ];
  fill();
  return [
    h(
      "div",
      { class: "filters", role: "search" },
      h("div", { class: "labelled" }, h("label", { for: "search" }, t("Name")), search),
      select_field(t("Task"), tasks, filter.task, (value) => { filter.task = value; change(); }),
      select_field(t("Course"), courses, filter.course, (value) => { filter.course = value; change(); }),
      select_field(t("Group"), groups, filter.group, (value) => { filter.group = value; change(); }),
    ),
    count,
    place,
  ];
}

export async function cohort_page({ main, query, signal, set_title }: PageContext): Promise<void> {
  set_title(t("Cohort"));
  const place = h("div", {});
  const actions = h("span", { class: "page-actions" });
  main.append(h("div", { class: "page-head" }, h("h1", {}, t("Cohort")), actions), place);
  const filter = read_filter(query);
  const load = (): Promise<void> => load_into(place, signal, () => get<Overview>("/api/overview", signal), (overview) => show_cohort(overview, filter, actions, () => void load()));
  await load();
}
