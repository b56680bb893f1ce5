// The list of questionnaires.

import { get, send } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";

import { navigate, type PageContext } from "../lib/router.ts";
import type { Form } from "../lib/types.ts";
import { language, plural, t } from "../lib/words.ts";
import { run_once } from "../ui/parts.ts";
import { empty_box, error_box, load_into, type Missing } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";

/** Shown for a questionnaire that does not exist. */
export function no_form(): Missing {
  return { title: t("There is no such questionnaire"), text: t("It may have been deleted, or the address is incomplete."), link: { label: t("Go to the questionnaires"), path: "/forms" } };
}

export function status_badge(form: Form): HTMLElement {
  return form.is_open ? h("span", { class: "badge badge-open" }, t("Open")) : h("span", { class: "badge badge-plain" }, t("Closed"));
}

export function form_path(form: Form): string {
  return `/forms/${encodeURIComponent(String(form.id))}`;
}

const columns = (): Column<Form>[] => [
  { name: "title", title: t("Title"), is_header: true, key: (one) => one.title, cell: (one) => h("a", { href: form_path(one) }, one.title || t("Without a title")) },
  { name: "status", title: t("Status"), key: (one) => (one.is_open ? 0 : 1), cell: status_badge },
  { name: "items", title: t("Questions"), is_number: true, cell: (one) => String(one.items.length) },
  { name: "responses", title: t("Responses"), is_number: true, key: (one) => one.responses, cell: (one) => String(one.responses) },
  { name: "edit", title: t("Edit"), cell: (one) => h("a", { href: `${form_path(one)}/edit`, "aria-label": t("Edit {0}", one.title) }, t("Edit")) },
];

function show_forms({ forms }: { forms: Form[] }): Child {
  if (forms.length === 0) return empty_box(t("No questionnaires"), t("“Standard questionnaire” adds one with the four statements of the published study and a text question. “New questionnaire” starts with an empty one."));
  return data_table({ caption: plural(forms.length, "{0} questionnaire", "{0} questionnaires"), columns: columns(), rows: forms });
}

export async function forms_page({ main, signal, set_title }: PageContext): Promise<void> {
  set_title(t("Questionnaires"));
  const place = h("div", {});
  const problem = h("div", {});
  const standard = h("button", { type: "button", class: "button" }, t("Standard questionnaire"));
  const add_standard = async (): Promise<void> => {
    try {
      navigate(form_path(await send<Form>("POST", "/api/forms", { language: language() })));
    } catch (error) {
      replace_children(problem, error_box(error));
    }
  };
  standard.addEventListener("click", () => void run_once(standard, add_standard));
  main.append(
    h("div", { class: "page-head" }, h("h1", {}, t("Questionnaires")), h("span", { class: "page-actions" }, standard, h("a", { class: "button button-primary", href: "/forms/new" }, t("New questionnaire")))),
    h("p", { class: "lead" }, t("Answers are given on a six-point scale from 1 (strongly agree) to 6 (strongly disagree) and as free text.")),
    problem,
    place,
  );
  await load_into(place, signal, () => get<{ forms: Form[] }>("/api/forms", signal), show_forms);
}
