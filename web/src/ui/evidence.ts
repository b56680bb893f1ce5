// Choice of task, course, case and level above figures of a cohort.

import { get, path_with } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";
import { level_text } from "../lib/format.ts";
import { write_query, type PageContext } from "../lib/router.ts";
import type { Overview } from "../lib/types.ts";
import { said, t } from "../lib/words.ts";
import { select_field } from "./parts.ts";
import { empty_box, load_into } from "./states.ts";

type Name = "task" | "course" | "patient" | "level";

/** Filters, and below them `show` of the answer at `path`. The answer names the cases and levels that there are. */
export function evidence_filters<T extends { patients?: string[]; levels?: string[] }>(overview: Overview, { query, signal }: PageContext, path: string, show: (answer: T) => Child): Child {
  if (overview.tasks.length === 0) return empty_box(t("No tasks"), t("The database has no attempts yet."));
  const chosen: Record<Name, string> = { task: query.get("task") || overview.tasks[0].id, course: query.get("course") ?? "", patient: query.get("patient") ?? "", level: query.get("level") ?? "" };
  const place = h("div", {});
  const more = h("div", { class: "more-filters" });
  const choose = (name: Name) => (value: string): void => {
    chosen[name] = value;
    if (name === "task") chosen.patient = "";
    load();
  };
  const show_more = (answer: T): void => {
    const patients = [...new Set([...(answer.patients ?? []), ...(chosen.patient ? [chosen.patient] : [])])];
    const levels = [...new Set([...(answer.levels ?? []), ...(chosen.level ? [chosen.level] : [])])];
    replace_children(
      more,
      select_field(t("Case"), [{ value: "", label: t("All cases") }, ...patients.map((one) => ({ value: one, label: one }))], chosen.patient, choose("patient")),
      select_field(t("Level of help"), [{ value: "", label: t("All levels") }, ...levels.map((one) => ({ value: one, label: level_text(one) }))], chosen.level, choose("level")),
    );
  };
  const load = (): void => {
    write_query(chosen);
    void load_into(place, signal, () => get<T>(path_with(path, chosen), signal), (answer) => {
      show_more(answer);
      return show(answer);
    });
  };
  const tasks = overview.tasks.map((one) => ({ value: one.id, label: said(one.title) }));
  const courses = [{ value: "", label: t("All courses") }, ...overview.courses.map((one) => ({ value: String(one.id), label: one.name }))];
  load();
  return [h("div", { class: "filters" }, select_field(t("Task"), tasks, chosen.task, choose("task")), select_field(t("Course"), courses, chosen.course, choose("course")), more), place];
}
