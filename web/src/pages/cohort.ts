// The cohort: every person with the results of one task, or the recent means of all tasks.

import { get, path_with } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";
import { date_text, fixed, percent, plural } from "../lib/format.ts";
import { write_query, type PageContext } from "../lib/router.ts";
import type { Overview, Person, TaskResult } from "../lib/types.ts";
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
    { count: sum("never_began"), one: "never began", many: "never began" },
    { count: sum("lost"), one: "was lost to a crash", many: "were lost to crashes" },
    { count: sum("running"), one: "is not over", many: "are not over" },
  ].filter((one) => one.count > 0);
  const unscored = sum("unscored");
  const counted = `${plural(sum("attempts"), "attempt")} counted${unscored ? ` (${unscored} ended without a result)` : ""}`;
  if (left_out.length === 0) return counted;
  return `${counted}, ${left_out.reduce((value, one) => value + one.count, 0)} left out: ${left_out.map((one) => `${one.count} ${one.count === 1 ? one.one : one.many}`).join(", ")}`;
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
  return [`${result.passed} of ${result.attempts} `, h("span", { class: "dim" }, `(${percent(result.passed, result.attempts)})`)];
}

function columns_of(overview: Overview, task: string): Column<Person>[] {
  const course_names = new Map(overview.courses.map((one) => [String(one.id), one.name]));
  const course = (person: Person): string => (person.course === null ? "–" : (course_names.get(String(person.course)) ?? String(person.course)));
  const of_task = (person: Person): TaskResult | undefined => person.tasks[task];
  const result = (person: Person): { attempts: number; passed: number; last_s: number | null } => (task ? (of_task(person) ?? { attempts: 0, passed: 0, last_s: null }) : total(person));
  const person_path = (person: Person): string => path_with(`/people/${encodeURIComponent(person.id)}`, { task });
  const scores: Column<Person>[] = task
    ? [
        { name: "last", title: "Last score", is_number: true, key: (one) => of_task(one)?.last_score ?? null, cell: (one) => fixed(of_task(one)?.last_score, 0) },
        { name: "best", title: "Best score", is_number: true, key: (one) => of_task(one)?.best_score ?? null, cell: (one) => fixed(of_task(one)?.best_score, 0) },
        { name: "mean", title: "Mean of last 5", is_number: true, key: (one) => of_task(one)?.recent_mean ?? null, cell: (one) => score_cell(of_task(one)?.recent_mean) },
      ]
    : overview.tasks.map((one) => ({
        name: `mean-${one.id}`,
        title: one.title,
        is_number: true,
        key: (person: Person) => person.tasks[one.id]?.recent_mean ?? null,
        cell: (person: Person) => score_cell(person.tasks[one.id]?.recent_mean),
      }));
  return [
    { name: "name", title: "Name", is_header: true, key: (one) => one.name, cell: (one) => h("span", { class: "person" }, h("a", { href: person_path(one) }, one.name), person_badges(one)) },
    { name: "course", title: "Course", key: course, cell: course },
    { name: "attempts", title: "Attempts", is_number: true, key: (one) => result(one).attempts, cell: (one) => String(result(one).attempts) },
    { name: "passed", title: "Passed", is_number: true, key: (one) => (result(one).attempts ? result(one).passed / result(one).attempts : null), cell: (one) => passed_cell(result(one)) },
    ...scores,
    { name: "date", title: "Last attempt", is_number: true, key: (one) => result(one).last_s, cell: (one) => date_text(result(one).last_s) },
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
  const add = h("button", { type: "button", class: "button button-primary", on: { click: () => add_person(overview.courses) } }, "Add person …");
  if (overview.people.length === 0) {
    replace_children(actions, add);
    return empty_box("No results yet", "Attempts appear here after somebody has practised at a station that uses this database.");
  }
  const shown_people = (): Person[] => overview.people.filter((one) => matches(one, filter));
  const place = h("div", {});
  const count = h("p", { class: "dim", role: "status" });
  const export_link = h("a", { class: "button", download: true }, "Attempts as CSV");
  const notes_link = h("a", { class: "button", download: true }, "Notes as CSV");
  const move = h("button", { type: "button", class: "button", on: { click: () => move_people(shown_people(), overview.courses, reload) } }, "Move people …");
  replace_children(actions, print_button(), export_link, notes_link, move, add);
  const fill = (): void => {
    const people = shown_people();
    const simulated = people.filter((one) => one.simulated).length;
    const results = people.flatMap((one) => (filter.task ? (one.tasks[filter.task] ?? []) : total(one)));
    count.textContent = `${plural(people.length, "person", "people")} of ${overview.people.length}${simulated ? `, ${simulated} simulated` : ""}; ${counted_text(results)}`;
    export_link.href = path_with("/api/export/attempts.csv", { task: filter.task, course: filter.course });
    notes_link.href = path_with("/api/export/notes.csv", { task: filter.task, course: filter.course });
    const caption = filter.task ? `Results of ${overview.tasks.find((one) => one.id === filter.task)?.title ?? filter.task}` : "Mean of the last five scores at each task";
    replace_children(
      place,
      people.length === 0
        ? empty_box("Nobody matches", "Change the search or the filters.")
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
  const tasks = [{ value: "", label: "All tasks" }, ...overview.tasks.map((one) => ({ value: one.id, label: one.title }))];
  const courses = [{ value: "", label: "All courses" }, ...overview.courses.map((one) => ({ value: String(one.id), label: one.name }))];
  const groups = [
    { value: "", label: "Everyone" },
    { value: "trainee", label: "Trainees" },
    { value: "expert", label: "Experts" },
    { value: "people", label: "Without simulated people" },
    { value: "simulated", label: "Simulated people only" },
  ];
  fill();
  return [
    h(
      "div",
      { class: "filters", role: "search" },
      h("div", { class: "labelled" }, h("label", { for: "search" }, "Name"), search),
      select_field("Task", tasks, filter.task, (value) => { filter.task = value; change(); }),
      select_field("Course", courses, filter.course, (value) => { filter.course = value; change(); }),
      select_field("Group", groups, filter.group, (value) => { filter.group = value; change(); }),
    ),
    count,
    place,
  ];
}

export async function cohort_page({ main, query, signal, set_title }: PageContext): Promise<void> {
  set_title("Cohort");
  const place = h("div", {});
  const actions = h("span", { class: "page-actions" });
  main.append(h("div", { class: "page-head" }, h("h1", {}, "Cohort"), actions), place);
  const filter = read_filter(query);
  const load = (): Promise<void> => load_into(place, signal, () => get<Overview>("/api/overview", signal), (overview) => show_cohort(overview, filter, actions, () => void load()));
  await load();
}
