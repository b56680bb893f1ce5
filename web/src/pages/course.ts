// One course: its numbers, each task, each trainee; made to be printed.

import { get, send } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { date_text, fixed, percent } from "../lib/format.ts";
import { navigate, type PageContext } from "../lib/router.ts";
import type { Overview, Person, Task } from "../lib/types.ts";
import { plural, said, t } from "../lib/words.ts";
import { numbers_of, quartiles_of, results_of, score_bins, score_of, trainees_of, type CourseNumbers } from "../manage/course_numbers.ts";
import { score_histogram } from "../plots/small.ts";
import { ask } from "../ui/dialog.ts";
import { breadcrumb, card, fold_card, simulated_badge, text_field } from "../ui/parts.ts";
import { print_button } from "../ui/print.ts";
import { empty_box, load_into, missing_box, toast } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";
import { course_path, number_columns } from "./courses.ts";

function rename(name: string): void {
  const field = text_field(t("New name"), { value: name, maxlength: "100" });
  ask({
    title: t("Rename the course"),
    action: t("Rename"),
    is_harmless: true,
    fields: field.element,
    check: () => {
      field.set_error(field.input.value.trim() ? null : t("Enter a name."));
      return !field.input.hasAttribute("aria-invalid");
    },
    run: async () => {
      const new_name = field.input.value.trim().replace(/\s+/g, " ");
      await send("PUT", "/api/courses", { name, new_name });
      toast(t("The course is now called {0}.", new_name));
      navigate(course_path(new_name), true);
    },
  });
}

function facts_list(numbers: CourseNumbers): HTMLElement {
  const quartiles = quartiles_of(numbers.scores);
  const facts: [string, string][] = [
    [t("Trainees"), String(numbers.people)],
    [t("With attempts"), String(numbers.practised)],
    [t("Attempts that count"), String(numbers.attempts)],
    [t("Passed"), numbers.attempts ? t("{0} of {1} ({2})", numbers.passed, numbers.attempts, percent(numbers.passed, numbers.attempts)) : "–"],
    [t("Median score"), quartiles ? fixed(quartiles.median, 0) : "–"],
    [t("Last attempt"), date_text(numbers.last_s)],
  ];
  return h("dl", { class: "facts" }, facts.map(([term, value]) => h("div", {}, h("dt", {}, term), h("dd", {}, value))));
}

function task_table(people: Person[], tasks: Task[]): HTMLElement {
  const rows = tasks.map((task) => ({ task, numbers: numbers_of(people, task.id) })).filter((one) => one.numbers.attempts > 0);
  const columns: Column<(typeof rows)[number]>[] = [{ name: "task", title: t("Task"), is_header: true, key: (one) => said(one.task.title), cell: (one) => said(one.task.title) }, ...number_columns<(typeof rows)[number]>((one) => one.numbers)];
  return data_table({ caption: t("Results of each task"), columns, rows });
}

function people_table(people: Person[]): HTMLElement {
  const numbers = (person: Person): CourseNumbers => numbers_of([person], "");
  const columns: Column<Person>[] = [
    { name: "name", title: t("Name"), is_header: true, key: (one) => one.name, cell: (one) => h("a", { href: `/people/${encodeURIComponent(one.id)}` }, one.name) },
    { name: "tasks", title: t("Tasks"), is_number: true, key: (one) => results_of(one, "").length, cell: (one) => String(results_of(one, "").length) },
    { name: "attempts", title: t("Attempts"), is_number: true, key: (one) => numbers(one).attempts, cell: (one) => String(numbers(one).attempts) },
    { name: "passed", title: t("Passed"), is_number: true, key: (one) => numbers(one).passed, cell: (one) => (numbers(one).attempts ? `${numbers(one).passed} (${percent(numbers(one).passed, numbers(one).attempts)})` : "–") },
    { name: "score", title: t("Mean of last 5 scores"), is_number: true, key: (one) => score_of(one, ""), cell: (one) => fixed(score_of(one, ""), 0) },
    { name: "last", title: t("Last attempt"), is_number: true, key: (one) => numbers(one).last_s, cell: (one) => (numbers(one).last_s === null ? t("Not yet") : date_text(numbers(one).last_s)) },
  ];
  return data_table({ caption: plural(people.length, "{0} trainee", "{0} trainees"), columns, rows: people, order: { column: "name", is_descending: false } });
}

function show_course(overview: Overview, name: string | null, context: PageContext): Child {
  const course = overview.courses.find((one) => String(one.id) === name);
  if (name !== null && !course) {
    return missing_box({ title: t("There is no such course"), text: t("It may have been renamed or deleted."), link: { label: t("Go to the courses"), path: "/courses" } });
  }
  const title = course?.name ?? t("Without a course");
  context.set_title(title);
  const { people, is_simulated } = trainees_of(overview.people, course ? String(course.id) : null);
  const numbers = numbers_of(people, "");
  const header = [
    breadcrumb({ label: t("Courses"), path: "/courses" }, { label: title }),
    h("div", { class: "page-head" }, h("h1", {}, title), is_simulated && simulated_badge(), h("span", { class: "page-actions" }, print_button(), course && h("button", { type: "button", class: "button", on: { click: () => rename(course.name) } }, t("Rename …")))),
  ];
  if (people.length === 0) return [header, empty_box(t("No trainees"), t("Nobody is in this course, or only experts."))];
  return [
    header,
    facts_list(numbers),
    h("p", { class: "dim" }, is_simulated ? t("Only simulated people are in this course: the numbers say nothing about people.") : t("Trainees only: experts and simulated people are left out.")),
    numbers.attempts === 0
      ? empty_box(t("No attempts yet"), t("Results appear after the first attempt that counts."))
      : [
          card(t("Tasks"), {}, task_table(people, overview.tasks)),
          fold_card(t("Scores"), {}, score_histogram(score_bins(numbers.scores)), h("p", { class: "help" }, t("Number of trainees with a score of 0 to 10, 10 to 20 and so on. Score of a trainee: mean of the last five scores of each task, averaged over the tasks."))),
        ],
    fold_card(t("Trainees"), {}, people_table(people)),
  ];
}

export async function course_page(context: PageContext): Promise<void> {
  const name = context.query.get("name");
  context.set_title(t("Course"));
  const place = h("div", {});
  context.main.append(place);
  await load_into(place, context.signal, () => get<Overview>("/api/overview", context.signal), (overview) => show_course(overview, name, context));
}
