// All courses side by side.

import { get, send } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { date_text, fixed, percent } from "../lib/format.ts";
import { write_query, type PageContext } from "../lib/router.ts";
import type { Overview } from "../lib/types.ts";
import { plural, said, t, t_nodes } from "../lib/words.ts";
import { course_rows, quartiles_of, type CourseNumbers, type CourseRow } from "../manage/course_numbers.ts";
import { score_strip } from "../plots/small.ts";
import { ask } from "../ui/dialog.ts";
import { select_field, simulated_badge } from "../ui/parts.ts";
import { print_button } from "../ui/print.ts";
import { empty_box, load_into, toast } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";

export function course_path(id: string | null): string {
  return id === null ? "/course" : `/course?name=${encodeURIComponent(id)}`;
}

/** Median, quartiles and their drawing. */
export function scores_cell(numbers: CourseNumbers): Child {
  const quartiles = quartiles_of(numbers.scores);
  if (!quartiles) return h("span", { class: "dim" }, "–");
  const median = fixed(quartiles.median, 0);
  const text = quartiles.min === quartiles.max ? median : t("{0} ({1} to {2})", median, fixed(quartiles.q1, 0), fixed(quartiles.q3, 0));
  return h("span", { class: "compared" }, score_strip(quartiles), h("span", { class: "auc-number" }, text));
}

/** Columns that tables of courses and of tasks share. */
export function number_columns<Row>(numbers: (row: Row) => CourseNumbers): Column<Row>[] {
  return [
    { name: "practised", title: t("People who practised"), is_number: true, key: (one) => numbers(one).practised, cell: (one) => t("{0} of {1}", numbers(one).practised, numbers(one).people) },
    { name: "with_pass", title: t("People with a pass"), is_number: true, key: (one) => numbers(one).with_pass, cell: (one) => String(numbers(one).with_pass) },
    { name: "attempts", title: t("Attempts"), is_number: true, key: (one) => numbers(one).attempts, cell: (one) => String(numbers(one).attempts) },
    {
      name: "passed", title: t("Passed"), is_number: true, key: (one) => (numbers(one).attempts ? numbers(one).passed / numbers(one).attempts : null),
      cell: (one) => (numbers(one).attempts ? [`${numbers(one).passed} `, h("span", { class: "dim" }, `(${percent(numbers(one).passed, numbers(one).attempts)})`)] : "–"),
    },
    { name: "score", title: t("Score, median (quartiles)"), is_number: true, key: (one) => quartiles_of(numbers(one).scores)?.median ?? null, cell: (one) => scores_cell(numbers(one)) },
    { name: "last", title: t("Last attempt"), is_number: true, key: (one) => numbers(one).last_s, cell: (one) => date_text(numbers(one).last_s) },
  ];
}

function show_courses(overview: Overview, context: PageContext, reload: () => void): Child {
  if (overview.courses.length === 0) {
    return empty_box(t("No courses"), t_nodes("A course is made when the first person is put into it: use “Move people” on the page {0}.", h("a", { href: "/" }, t("Cohort"))));
  }
  let task = context.query.get("task") ?? "";
  const place = h("div", {});
  const remove = (row: CourseRow): void =>
    ask({
      title: t("Delete the course {0}?", row.name),
      text: t("Nobody is in this course. No results are lost."),
      action: t("Delete"),
      run: async () => {
        await send("DELETE", "/api/courses", { name: row.name });
        toast(t("The course {0} was deleted.", row.name));
        reload();
      },
    });
  const is_empty = (row: CourseRow): boolean => row.id !== null && !overview.people.some((one) => String(one.course ?? "") === row.id);
  const columns: Column<CourseRow>[] = [
    {
      name: "name", title: t("Course"), is_header: true, key: (one) => one.name,
      cell: (one) => h("span", { class: "person" }, h("a", { href: course_path(one.id) }, one.name), one.is_simulated && simulated_badge(), is_empty(one) && h("button", { type: "button", class: "button button-small no-print", on: { click: () => remove(one) } }, t("Delete empty course …"))),
    },
    ...number_columns<CourseRow>((one) => one.numbers),
  ];
  const fill = (): void => {
    const rows = course_rows(overview, task);
    const title = overview.tasks.find((one) => one.id === task)?.title;
    place.replaceChildren(data_table({ caption: plural(overview.courses.length, "{0} course, {1}", "{0} courses, {1}", title === undefined ? t("all tasks") : said(title)), columns, rows, order: { column: "name", is_descending: false } }));
  };
  const tasks = [{ value: "", label: t("All tasks") }, ...overview.tasks.map((one) => ({ value: one.id, label: said(one.title) }))];
  fill();
  return [
    h("div", { class: "filters" }, select_field(t("Task"), tasks, task, (value) => {
      task = value;
      write_query({ task });
      fill();
    })),
    h("p", { class: "dim" }, t("Trainees only, without experts; simulated people count only in a course that has no others. Each person counts once in the scores, with the mean of the last five.")),
    place,
  ];
}

export async function courses_page(context: PageContext): Promise<void> {
  context.set_title(t("Courses"));
  const place = h("div", {});
  context.main.append(h("div", { class: "page-head" }, h("h1", {}, t("Courses")), h("span", { class: "page-actions" }, print_button())), place);
  const load = (): Promise<void> => load_into(place, context.signal, () => get<Overview>("/api/overview", context.signal), (overview) => show_courses(overview, context, () => void load()));
  await load();
}
