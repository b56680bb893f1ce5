// A questionnaire: its address, its state, means and comments.

import { get, send } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { fixed, kScaleLabels, plural } from "../lib/format.ts";
import { navigate, type PageContext } from "../lib/router.ts";
import type { Form, FormSummary, ItemSummary } from "../lib/types.ts";
import { scale_distribution } from "../plots/small.ts";
import { ask } from "../ui/dialog.ts";
import { breadcrumb, card, run_once, time_element } from "../ui/parts.ts";
import { empty_box, load_into, toast } from "../ui/states.ts";
import { data_table, plain_table, type Column } from "../ui/table.ts";
import { form_path, kNoForm, status_badge } from "./forms.ts";

function address_card(form: Form): HTMLElement {
  const address = `${location.origin}/q/${encodeURIComponent(form.token)}`;
  const field = h("input", { class: "field", type: "text", readonly: true, value: address, "aria-label": "Address of the questionnaire", on: { focus: () => field.select() } });
  const copy = async (): Promise<void> => {
    try {
      await navigator.clipboard.writeText(address);
      toast("The address was copied.");
    } catch {
      field.focus();
      toast("The browser does not allow copying. The address is selected: press Ctrl+C.");
    }
  };
  return card(
    "Address",
    {},
    form.is_open
      ? h("div", { class: "address" }, field, h("button", { type: "button", class: "button", on: { click: () => void copy() } }, "Copy"), h("a", { class: "button", href: `/q/${encodeURIComponent(form.token)}`, target: "_blank", rel: "noopener" }, "Open in a new tab"))
      : h("p", {}, "The questionnaire is closed: nobody can answer it. Open it to collect answers."),
  );
}

function means_table(items: ItemSummary[]): HTMLElement {
  const columns: Column<ItemSummary>[] = [
    { name: "text", title: "Statement", is_header: true, cell: (one) => [one.text, one.is_retired && h("span", { class: "badge badge-plain retired" }, "Retired")] },
    { name: "n", title: "n", is_number: true, cell: (one) => String(one.n) },
    { name: "mean", title: "Mean", is_number: true, cell: (one) => h("strong", { class: "mean" }, fixed(one.mean, 1)) },
    { name: "sd", title: "SD", is_number: true, cell: (one) => fixed(one.sd, 1) },
    { name: "counts", title: "Answers 1 to 6", cell: (one) => scale_distribution(one.counts ?? []) },
  ];
  return h(
    "div",
    {},
    data_table({ caption: "Mean of each statement: 1 = strongly agree, 6 = strongly disagree", columns, rows: items }),
    h("details", { class: "as-table" }, h("summary", {}, "Answers as a table"), plain_table("Count of each answer", ["Statement", ...kScaleLabels.map((one, k) => `${k + 1} ${one}`)], items.map((one) => [one.text, ...kScaleLabels.map((_, k) => String(one.counts?.[k] ?? 0))]))),
  );
}

function comments_card(item: ItemSummary): HTMLElement {
  const comments = item.comments ?? [];
  return card(
    item.is_retired ? `${item.text} (retired)` : item.text,
    {},
    comments.length === 0
      ? h("p", { class: "dim" }, "No answers yet.")
      : h("ul", { class: "comments" }, comments.map((one) => h("li", {}, h("p", { class: "comment" }, one.text), one.submitted_s !== null && h("p", { class: "help" }, time_element(one.submitted_s))))),
  );
}

function show_results(summary: FormSummary, context: PageContext, reload: () => void): Child {
  const { form, items, responses } = summary;
  context.set_title(form.title);
  const scales = items.filter((one) => one.kind === "scale");
  const toggle = h("button", { type: "button", class: "button" }, form.is_open ? "Close for answers" : "Open for answers");
  const change = async (): Promise<void> => {
    try {
      await send("PUT", `/api${form_path(form)}`, { is_open: !form.is_open });
      toast(form.is_open ? "The questionnaire is closed." : "The questionnaire is open.");
      reload();
    } catch (error) {
      toast(error instanceof Error ? error.message : "The state could not be changed.");
    }
  };
  toggle.addEventListener("click", () => void run_once(toggle, change));
  const remove = (): void =>
    ask({
      title: "Delete this questionnaire?",
      text: `Responses that are deleted with it: ${responses}. This cannot be undone.`,
      action: "Delete",
      run: async () => {
        await send("DELETE", `/api${form_path(form)}`, {});
        toast("The questionnaire was deleted.");
        navigate("/forms");
      },
    });
  return [
    breadcrumb({ label: "Questionnaires", path: "/forms" }, { label: form.title }),
    h(
      "div",
      { class: "page-head" },
      h("h1", {}, form.title),
      status_badge(form),
      h(
        "span",
        { class: "page-actions" },
        h("a", { class: "button", href: `${form_path(form)}/edit` }, "Edit"),
        toggle,
        h("a", { class: "button", download: true, href: `/api${form_path(form)}/answers.csv` }, "Answers as CSV"),
        h("button", { type: "button", class: "button button-danger", on: { click: remove } }, "Delete …"),
      ),
    ),
    form.intro && h("p", { class: "lead" }, form.intro),
    address_card(form),
    card(`Results: ${plural(responses, "response")}`, {}, scales.length === 0 ? empty_box("No statements", "This questionnaire has only text questions.") : means_table(scales)),
    items.filter((one) => one.kind === "text").map(comments_card),
  ];
}

export async function form_results_page(context: PageContext): Promise<void> {
  context.set_title("Questionnaire");
  const place = h("div", {});
  context.main.append(place);
  const path = `/api/forms/${encodeURIComponent(context.params[0])}/summary`;
  const load = (): Promise<void> => load_into(place, context.signal, () => get<FormSummary>(path, context.signal), (summary) => show_results(summary, context, () => void load()), kNoForm);
  await load();
}
