// How many attempts people need to become proficient, first-pass success, time to the target, and time spent.

import { get } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { duration_text, fixed, plural } from "../lib/format.ts";
import type { PageContext } from "../lib/router.ts";
import type { GroupProficiency, Overview, PersonProficiency, Proficiency } from "../lib/types.ts";
import { evidence_filters } from "../ui/evidence.ts";
import { card, is_phone } from "../ui/parts.ts";
import { empty_box, load_into } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";

const kNames = { trainee: "Trainees", expert: "Experts" };

/** The interval of a median; a limit that is not reached yet is left out. */
export function limits_text({ median, low, high }: { median: number | null; low: number | null; high: number | null }): string {
  if (median === null || (low === null && high === null)) return "";
  if (low !== null && high !== null) return `95 % interval: ${fixed(low, 0)} to ${fixed(high, 0)}. `;
  return low !== null ? `95 % interval: at least ${fixed(low, 0)}. ` : `95 % interval: at most ${fixed(high, 0)}. `;
}

function share_text(share: number | null): string {
  return share === null ? "–" : `${fixed(100 * share, 0)}\u00a0%`;
}

function figure(title: string, value: string, text: string): HTMLElement {
  return h("section", { class: "card card-figure" }, h("h3", {}, title), h("p", { class: value === "None yet" || value === "None entered" ? "figure figure-none" : "figure" }, value), h("p", {}, text));
}

function people_table(people: PersonProficiency[]): HTMLElement {
  const columns: Column<PersonProficiency>[] = [
    { name: "name", title: "Name", is_header: true, key: (one) => one.name, cell: (one) => h("a", { href: `/people/${encodeURIComponent(one.id)}` }, one.name) },
    { name: "attempts", title: "Attempts", is_number: true, key: (one) => one.attempts, cell: (one) => String(one.attempts) },
    { name: "passed", title: "Passed", is_number: true, key: (one) => one.passed, cell: (one) => `${one.passed} of ${one.attempts}` },
    { name: "trials", title: "Attempts to proficiency", is_number: true, key: (one) => one.trials, cell: (one) => (one.trials === null ? "Not yet" : String(one.trials)) },
    { name: "first", title: "First-pass success", is_number: true, key: (one) => one.first_pass_share, cell: (one) => share_text(one.first_pass_share) },
    { name: "time", title: "Time to target", is_number: true, key: (one) => one.time_to_target_s, cell: (one) => duration_text(one.time_to_target_s) },
    { name: "practice", title: "Practice time", is_number: true, key: (one) => one.practice_s, cell: (one) => duration_text(one.practice_s) },
    { name: "instructor", title: "Time of instructors", is_number: true, key: (one) => one.instructor_min, cell: (one) => (one.instructor_min === null ? "–" : `${fixed(one.instructor_min, 0)}\u00a0min`) },
  ];
  return data_table({ caption: "Results of each person", columns, rows: people, order: { column: "trials", is_descending: false }, page_size: is_phone() ? 10 : 100 });
}

function show_group(group: GroupProficiency, rule: string): Child {
  return card(
    `${kNames[group.group]}${group.simulated ? ", simulated" : ""}`,
    {},
    group.simulated && h("p", { class: "notice notice-simulated" }, "Simulated people (scripted operators) only test the calculation. They say nothing about people."),
    h("p", { class: "dim" }, `${group.counts_text}.`),
    h(
      "div",
      { class: "figures" },
      figure("Attempts to proficiency", group.median === null ? "None yet" : fixed(group.median, 0), `Median of ${plural(group.people_count, "person", "people")}, ${group.proficient} proficient, ${group.not_yet} not yet. ${limits_text(group)}Kaplan–Meier estimate, which includes people who are not proficient yet. Proficient means ${rule}.`),
      figure("First-pass success", share_text(group.first_pass_share), "The target was reached with one puncture of the skin and without a withdrawal of more than 10 mm. Mean of the shares of all people; an attempt that did not reach the target counts as no success."),
      figure("Time to the target", duration_text(group.time_to_target_s), "From the first contact with the skin. Median of the medians of all people, from attempts that reached the target."),
      figure("Time of instructors", group.instructor_min === null ? "None entered" : `${fixed(group.instructor_min, 0)}\u00a0min`, `${group.instructor.charAt(0).toUpperCase()}${group.instructor.slice(1)}.`),
    ),
    h("details", { class: "fold inner-fold", open: !is_phone() }, h("summary", {}, "Each person"), people_table(group.people)),
  );
}

function show_proficiency(answer: Proficiency): Child {
  if (answer.groups.length === 0) return empty_box("No attempts", "No attempt that counts matches these filters.");
  const rule = `${plural(answer.passes_in_a_row, "pass", "passes")} in a row with at least ${fixed(answer.score, 0)} points`;
  return answer.groups.map((one) => show_group(one, rule));
}

export async function proficiency_page(context: PageContext): Promise<void> {
  context.set_title("Proficiency");
  const place = h("div", {});
  context.main.append(h("h1", {}, "Proficiency"), h("p", { class: "lead" }, "How many attempts people need until they are proficient at a task."), place);
  await load_into(place, context.signal, () => get<Overview>("/api/overview", context.signal), (overview) => evidence_filters<Proficiency>(overview, context, "/api/proficiency", show_proficiency));
}
