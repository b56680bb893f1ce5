// The editor of a questionnaire: title, introduction, items to add, move and remove; a preview beside it.

import { get, send } from "../lib/api.ts";
import { h, new_id, replace_children, type Child } from "../lib/dom.ts";

import { navigate, type PageContext } from "../lib/router.ts";
import type { Form, FormItem } from "../lib/types.ts";
import { plural, t } from "../lib/words.ts";
import { form_view } from "../ui/form_view.ts";
import { breadcrumb, card, run_once, text_field } from "../ui/parts.ts";
import { error_box, load_into, toast } from "../ui/states.ts";
import { no_form } from "./forms.ts";

interface Draft {
  title: string;
  intro: string;
  items: FormItem[];
}

/** Characters of the introduction, as the server accepts them. */
const kMaxIntro = 2000;

const new_draft = (): Draft => ({
  title: "",
  intro: "",
  items: [{ kind: "scale", text: "", is_required: true }, { kind: "text", text: t("What should be improved?"), is_required: false }],
});

/** Changes that are not saved yet, for this tab: they outlive a session that ended while somebody was writing. */
function unsaved(id: string): { read: () => Draft | null; write: (draft: Draft) => void; clear: () => void } {
  const key = `trocar-form-${id}`;
  const quietly = <T>(action: () => T, otherwise: T): T => {
    try {
      return action();
    } catch {
      return otherwise;
    }
  };
  return {
    read: () => quietly(() => JSON.parse(sessionStorage.getItem(key) ?? "null") as Draft | null, null),
    write: (draft) => quietly(() => sessionStorage.setItem(key, JSON.stringify(draft)), undefined),
    clear: () => quietly(() => sessionStorage.removeItem(key), undefined),
  };
}

/** The first thing that keeps the form from being stored; null if nothing does. */
export function problem_of(draft: Draft): string | null {
  if (!draft.title.trim()) return t("Enter a title.");
  if (draft.items.length === 0) return t("Add a statement or a question.");
  const empty = draft.items.findIndex((one) => !one.text.trim());
  return empty >= 0 ? t("Enter the text of item {0}, or remove it.", empty + 1) : null;
}

export function moved<T>(items: T[], from: number, by: number): T[] {
  const to = from + by;
  if (to < 0 || to >= items.length) return items;
  const result = [...items];
  [result[from], result[to]] = [result[to], result[from]];
  return result;
}

function item_editor(draft: Draft, index: number, refresh: (focus: string | null) => void, changed: () => void): HTMLElement {
  const item = draft.items[index];
  const id = new_id("item");
  const area = h("textarea", { id, class: "field", rows: "2", maxlength: "500", value: item.text, on: { input: () => { item.text = area.value; changed(); } } });
  const required = h("input", { type: "checkbox", id: `${id}-required`, checked: item.is_required, on: { change: () => { item.is_required = required.checked; changed(); } } });
  const move = (by: number, label: string, sign: string, name: string): HTMLElement =>
    h(
      "button",
      {
        type: "button", class: "button button-small", "aria-label": label, "data-name": `${name}-${index}`, disabled: index + by < 0 || index + by >= draft.items.length,
        on: { click: () => { draft.items = moved(draft.items, index, by); refresh(`${name}-${index + by}`); } },
      },
      sign,
    );
  const remove = (): void => {
    draft.items.splice(index, 1);
    refresh("add-scale");
  };
  return h(
    "li",
    { class: "item-editor" },
    h("div", { class: "item-head" }, h("label", { for: id }, `${index + 1}. ${item.kind === "scale" ? t("Statement, six-point scale") : t("Question, free text")}`),
      h("span", { class: "item-buttons" }, move(-1, t("Move up item {0}", index + 1), "↑", "up"), move(1, t("Move down item {0}", index + 1), "↓", "down"), h("button", { type: "button", class: "button button-small", "aria-label": t("Remove item {0}", index + 1), on: { click: remove } }, t("Remove"))),
    ),
    area,
    h("div", { class: "check" }, required, h("label", { for: `${id}-required` }, t("Required"))),
  );
}

function show_editor(form: Form | null, context: PageContext): Child {
  const kept = unsaved(String(form?.id ?? "new"));
  const restored = kept.read();
  const { title: first_title, intro: first_intro, items: first_items } = restored ?? form ?? new_draft();
  const draft: Draft = { title: first_title, intro: first_intro, items: first_items.map((one) => ({ ...one })) };
  const title = text_field(t("Title"), { value: draft.title, maxlength: "200", on: { input: () => { draft.title = title.input.value; changed(); } } });
  const intro_id = new_id("intro");
  const intro = h("textarea", { id: intro_id, class: "field", rows: "3", maxlength: String(kMaxIntro), value: draft.intro, on: { input: () => { draft.intro = intro.value; changed(); } } });
  const list = h("ol", { class: "item-list" });
  const preview = h("div", { class: "preview" });
  const problem = h("div", {});
  let is_changed = false;

  const draw_preview = (): void => {
    const items = draft.items.map((one, k) => ({ ...one, id: k, text: one.text || "…" }));
    replace_children(preview, h("p", { class: "preview-title" }, draft.title || t("Title")), draft.intro && h("p", {}, draft.intro), form_view(items).element);
  };
  const changed = (): void => {
    is_changed = true;
    kept.write(draft);
    draw_preview();
  };
  const refresh = (focus: string | null): void => {
    replace_children(list, draft.items.map((_, k) => item_editor(draft, k, refresh, changed)));
    changed();
    if (!focus) return;
    const wished = section.querySelector<HTMLButtonElement>(`[data-name="${focus}"]`);
    if (wished && !wished.disabled) wished.focus();
    else section.querySelector<HTMLButtonElement>(`[data-name="${focus.replace(/^up/, "down*").replace(/^down-/, "up-").replace("down*", "down")}"]`)?.focus();
  };
  const add = (kind: FormItem["kind"]): void => {
    draft.items.push({ kind, text: "", is_required: kind === "scale" });
    refresh(null);
    list.querySelector<HTMLElement>("li:last-child textarea")?.focus();
  };
  const save = h("button", { type: "submit", class: "button button-primary" }, t("Save"));
  const submit = async (): Promise<void> => {
    const text = problem_of(draft);
    if (text) {
      replace_children(problem, h("p", { class: "notice notice-bad", role: "alert" }, text));
      return;
    }
    try {
      const body = { title: draft.title.trim(), intro: draft.intro.trim(), items: draft.items.map((one) => ({ ...one, text: one.text.trim() })) };
      const saved = form ? await send<Form | undefined>("PUT", `/api/forms/${encodeURIComponent(String(form.id))}`, body) : await send<Form | undefined>("POST", "/api/forms", body);
      is_changed = false;
      kept.clear();
      toast(t("The questionnaire was saved."));
      const id = form?.id ?? saved?.id;
      navigate(id === undefined ? "/forms" : `/forms/${encodeURIComponent(String(id))}`);
    } catch (error) {
      if (!context.signal.aborted) replace_children(problem, error_box(error));
    }
  };
  const element = h(
    "form",
    { class: "form", novalidate: true },
    form !== null && form.responses > 0 && h("p", { class: "notice" }, plural(form.responses, "This questionnaire has {0} response.", "This questionnaire has {0} responses."), " ", t("If you change the text of an item, its answers stay with the old text, which is shown as retired; the new text starts without answers.")),
    restored && h("p", { class: "notice", role: "status" }, t("Unsaved changes were restored."), " ", h("button", { type: "button", class: "button button-small", on: { click: () => discard() } }, t("Discard them"))),
    title.element,
    h("div", { class: "labelled" }, h("label", { for: intro_id }, t("Introduction")), intro),
    h("h2", {}, t("Items")),
    list,
    h("div", { class: "buttons" }, h("button", { type: "button", class: "button", "data-name": "add-scale", on: { click: () => add("scale") } }, t("Add a statement")), h("button", { type: "button", class: "button", on: { click: () => add("text") } }, t("Add a text question"))),
    problem,
    h("div", { class: "buttons" }, save, h("a", { class: "button", href: form ? `/forms/${encodeURIComponent(String(form.id))}` : "/forms", on: { click: () => kept.clear() } }, t("Cancel"))),
  );
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    void run_once(save, submit);
  });
  window.addEventListener("beforeunload", (event) => { if (is_changed) event.preventDefault(); }, { signal: context.signal });
  const section = h("div", { class: "editor" }, card(null, {}, element), card(t("Preview"), { class: "card-preview" }, preview));
  replace_children(list, draft.items.map((_, k) => item_editor(draft, k, refresh, changed)));
  draw_preview();
  const discard = (): void => {
    kept.clear();
    context.main.replaceChildren();
    void form_editor_page(context);
  };
  const steps = form ? [{ label: form.title, path: `/forms/${encodeURIComponent(String(form.id))}` }, { label: t("Edit") }] : [{ label: t("New questionnaire") }];
  return [breadcrumb({ label: t("Questionnaires"), path: "/forms" }, ...steps), h("h1", {}, form ? t("Edit questionnaire") : t("New questionnaire")), section];
}

export async function form_editor_page(context: PageContext): Promise<void> {
  const id = context.params[0];
  context.set_title(id === "new" ? t("New questionnaire") : t("Edit questionnaire"));
  const place = h("div", {});
  context.main.append(place);
  const load = async (): Promise<Form | null> => {
    if (id === "new") return null;
    return (await get<{ form: Form }>(`/api/forms/${encodeURIComponent(id)}/summary`, context.signal)).form;
  };
  await load_into(place, context.signal, load, (form) => show_editor(form, context), no_form());
}
