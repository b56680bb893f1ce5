// A questionnaire: its address, its state, means and comments.

import { get, send } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { fixed, scale_labels } from "../lib/format.ts";
import { navigate, type PageContext } from "../lib/router.ts";
import type { Form, FormSummary, ItemSummary } from "../lib/types.ts";
import { plural, t } from "../lib/words.ts";
import { scale_distribution } from "../plots/small.ts";
import { ask } from "../ui/dialog.ts";
import { breadcrumb, card, run_once, time_element } from "../ui/parts.ts";
import { empty_box, load_into, toast } from "../ui/states.ts";
import { data_table, plain_table, type Column } from "../ui/table.ts";
import { form_path, no_form, status_badge } from "./forms.ts";

function address_card(form: Form): HTMLElement {
  const address = `${location.origin}/q/${encodeURIComponent(form.token)}`;
  const field = h("input", { class: "field", type: "text", readonly: true, value: address, "aria-label": t("Address of the questionnaire"), on: { focus: () => field.select() } });
  const copy = async (): Promise<void> => {
    try {
      await navigator.clipboard.writeText(address);
      toast(t("The address was copied."));
    } catch {
      field.focus();
      toast(t("The browser does not allow copying. The address is selected: press Ctrl+C."));
    }
  };
  return card(
    t("Address"),
    {},
    form.is_open
      ? h("div", { class: "address" }, field, h("button", { type: "button", class: "button", on: { click: () => void copy() } }, t("Copy")), h("a", { class: "button", href: `/q/${encodeURIComponent(form.token)}`, target: "_blank", rel: "noopener" }, t("Open in a new tab")))
      : h("p", {}, t("The questionnaire is closed: nobody can answer it. Open it to collect answers.")),
  );
}

function means_table(items: ItemSummary[]): HTMLElement {
  const columns: Column<ItemSummary>[] = [
    { name: "text", title: t("Statement"), is_header: true, cell: (one) => [one.text, one.is_retired && h("span", { class: "badge badge-plain retired" }, t("Retired"))] },
    { name: "n", title: "n", is_number: true, cell: (one) => String(one.n) },
    { name: "mean", title: t("Mean"), is_number: true, cell: (one) => h("strong", { class: "mean" }, fixed(one.mean, 1)) },
    { name: "sd", title: t("SD"), is_number: true, cell: (one) => fixed(one.sd, 1) },
    { name: "counts", title: t("Answers 1 to 6"), cell: (one) => scale_distribution(one.counts ?? []) },
  ];
  return h(
    "div",
    {},
    data_table({ caption: t("Mean of each statement: 1 = strongly agree, 6 = strongly disagree"), columns, rows: items }),
    h("details", { class: "as-table" }, h("summary", {}, t("Answers as a table")), plain_table(t("Count of each answer"), [t("Statement"), ...scale_labels().map((one, k) => `${k + 1} ${one}`)], items.map((one) => [one.text, ...scale_labels().map((_, k) => String(one.counts?.[k] ?? 0))]))),
  );
}

function comments_card(item: ItemSummary): HTMLElement {
  const comments = item.comments ?? [];
  return card(
    item.is_retired ? t("{0} (retired)", item.text) : item.text,
    {},
    comments.length === 0
      ? h("p", { class: "dim" }, t("No answers yet."))
      : h("ul", { class: "comments" }, comments.map((one) => h("li", {}, h("p", { class: "comment" }, one.text), one.submitted_s !== null && h("p", { class: "help" }, time_element(one.submitted_s))))),
  );
}

function show_results(summary: FormSummary, context: PageContext, reload: () => void): Child {
  const { form, items, responses } = summary;
  context.set_title(form.title);
  const scales = items.filter((one) => one.kind === "scale");
  const toggle = h("button", { type: "button", class: "button" }, form.is_open ? t("Close for answers") : t("Open for answers"));
  const change = async (): Promise<void> => {
    try {
      await send("PUT", `/api${form_path(form)}`, { is_open: !form.is_open });
      toast(form.is_open ? t("The questionnaire is closed.") : t("The questionnaire is open."));
      reload();
    } catch (error) {
      toast(error instanceof Error ? error.message : t("The state could not be changed."));
    }
  };
  toggle.addEventListener("click", () => void run_once(toggle, change));
  const remove = (): void =>
    ask({
      title: t("Delete this questionnaire?"),
      text: t("Responses that are deleted with it: {0}. This cannot be undone.", responses),
      action: t("Delete"),
      run: async () => {
        await send("DELETE", `/api${form_path(form)}`, {});
        toast(t("The questionnaire was deleted."));
        navigate("/forms");
      },
    });
  return [
    breadcrumb({ label: t("Questionnaires"), path: "/forms" }, { label: form.title }),
    h(
      "div",
      { class: "page-head" },
      h("h1", {}, form.title),
      status_badge(form),
      h(
        "span",
        { class: "page-actions" },
        h("a", { class: "button", href: `${form_path(form)}/edit` }, t("Edit")),
        toggle,
        h("a", { class: "button", download: true, href: `/api${form_path(form)}/answers.csv` }, t("Answers as CSV")),
        h("button", { type: "button", class: "button button-danger", on: { click: remove } }, t("Delete …")),
      ),
    ),
    form.intro && h("p", { class: "lead" }, form.intro),
    address_card(form),
    card(plural(responses, "Results: {0} response", "Results: {0} responses"), {}, scales.length === 0 ? empty_box(t("No statements"), t("This questionnaire has only text questions.")) : means_table(scales)),
    items.filter((one) => one.kind === "text").map(comments_card),
  ];
}

export async function form_results_page(context: PageContext): Promise<void> {
  context.set_title(t("Questionnaire"));
  const place = h("div", {});
  context.main.append(place);
  const path = `/api/forms/${encodeURIComponent(context.params[0])}/summary`;
  const load = (): Promise<void> => load_into(place, context.signal, () => get<FormSummary>(path, context.signal), (summary) => show_results(summary, context, () => void load()), no_form());
  await load();
}
