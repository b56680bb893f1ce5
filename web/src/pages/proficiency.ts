// How many attempts people need to become proficient, first-pass success, time to the target, and time spent.

import { get } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { duration_text, fixed, sentence } from "../lib/format.ts";
import type { PageContext } from "../lib/router.ts";
import type { GroupProficiency, Overview, PersonProficiency, Proficiency } from "../lib/types.ts";
import { plural, said, t } from "../lib/words.ts";
import { group_title } from "../plots/histogram.ts";
import { evidence_filters } from "../ui/evidence.ts";
import { card, is_phone } from "../ui/parts.ts";
import { empty_box, load_into } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";

/** The interval of a median; a limit that is not reached yet is left out. */
export function limits_text({ median, low, high }: { median: number | null; low: number | null; high: number | null }): string {
  if (median === null || (low === null && high === null)) return "";
  if (low !== null && high !== null) return t("95 % interval: {0} to {1}.", fixed(low, 0), fixed(high, 0));
  return low !== null ? t("95 % interval: at least {0}.", fixed(low, 0)) : t("95 % interval: at most {0}.", fixed(high, 0));
}

function share_text(share: number | null): string {
  return share === null ? "–" : `${fixed(100 * share, 0)}\u00a0%`;
}

function figure(title: string, value: string, text: string, is_none = false): HTMLElement {
  return h("section", { class: "card card-figure" }, h("h3", {}, title), h("p", { class: is_none ? "figure figure-none" : "figure" }, value), h("p", {}, text));
}

function people_table(people: PersonProficiency[]): HTMLElement {
  const columns: Column<PersonProficiency>[] = [
    { name: "name", title: t("Name"), is_header: true, key: (one) => one.name, cell: (one) => h("a", { href: `/people/${encodeURIComponent(one.id)}` }, one.name) },
    { name: "attempts", title: t("Attempts"), is_number: true, key: (one) => one.attempts, cell: (one) => String(one.attempts) },
    { name: "passed", title: t("Passed"), is_number: true, key: (one) => one.passed, cell: (one) => t("{0} of {1}", one.passed, one.attempts) },
    { name: "trials", title: t("Attempts to proficiency"), is_number: true, key: (one) => one.trials, cell: (one) => (one.trials === null ? t("Not yet") : String(one.trials)) },
    { name: "first", title: t("First-pass success"), is_number: true, key: (one) => one.first_pass_share, cell: (one) => share_text(one.first_pass_share) },
    { name: "time", title: t("Time to target"), is_number: true, key: (one) => one.time_to_target_s, cell: (one) => duration_text(one.time_to_target_s) },
    { name: "practice", title: t("Practice time"), is_number: true, key: (one) => one.practice_s, cell: (one) => duration_text(one.practice_s) },
    { name: "instructor", title: t("Time of instructors"), is_number: true, key: (one) => one.instructor_min, cell: (one) => (one.instructor_min === null ? "–" : `${fixed(one.instructor_min, 0)}\u00a0min`) },
  ];
  return data_table({ caption: t("Results of each person"), columns, rows: people, order: { column: "trials", is_descending: false }, page_size: is_phone() ? 10 : 100 });
}

function median_text(group: GroupProficiency, rule: string): string {
  const counts = plural(group.people_count, "Median of {0} person, {1} proficient, {2} not yet.", "Median of {0} people, {1} proficient, {2} not yet.", group.proficient, group.not_yet);
  return [counts, limits_text(group), t("Kaplan–Meier estimate, which includes people who are not proficient yet."), rule].filter(Boolean).join(" ");
}

function show_group(group: GroupProficiency, rule: string): Child {
  return card(
    group_title(group),
    {},
    group.simulated && h("p", { class: "notice notice-simulated" }, t("Simulated people (scripted operators) only test the calculation. They say nothing about people.")),
    h("p", { class: "dim" }, sentence(said(group.counts_text))),
    h(
      "div",
      { class: "figures" },
      figure(t("Attempts to proficiency"), group.median === null ? t("None yet") : fixed(group.median, 0), median_text(group, rule), group.median === null),
      figure(t("First-pass success"), share_text(group.first_pass_share), t("The target was reached with one puncture of the skin and without a withdrawal of more than 10 mm. Mean of the shares of all people; an attempt that did not reach the target counts as no success.")),
      figure(t("Time to the target"), duration_text(group.time_to_target_s), t("From the first contact with the skin. Median of the medians of all people, from attempts that reached the target.")),
      figure(t("Time of instructors"), group.instructor_min === null ? t("None entered") : `${fixed(group.instructor_min, 0)}\u00a0min`, sentence(said(group.instructor)), group.instructor_min === null),
    ),
    h("details", { class: "fold inner-fold", open: !is_phone() }, h("summary", {}, t("Each person")), people_table(group.people)),
  );
}

function show_proficiency(answer: Proficiency): Child {
  if (answer.groups.length === 0) return empty_box(t("No attempts"), t("No attempt that counts matches these filters."));
  const rule = plural(answer.passes_in_a_row, "Proficient means {0} pass in a row with at least {1} points.", "Proficient means {0} passes in a row with at least {1} points.", fixed(answer.score, 0));
  return answer.groups.map((one) => show_group(one, rule));
}

export async function proficiency_page(context: PageContext): Promise<void> {
  context.set_title(t("Proficiency"));
  const place = h("div", {});
  context.main.append(h("h1", {}, t("Proficiency")), h("p", { class: "lead" }, t("How many attempts people need until they are proficient at a task.")), place);
  await load_into(place, context.signal, () => get<Overview>("/api/overview", context.signal), (overview) => evidence_filters<Proficiency>(overview, context, "/api/proficiency", show_proficiency));
}
