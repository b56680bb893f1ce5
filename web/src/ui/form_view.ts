// The questionnaire as people answer it: for the public page and for the editor's preview.

import { h, new_id, type Child } from "../lib/dom.ts";
import { scale_labels } from "../lib/format.ts";
import type { FormItem } from "../lib/types.ts";
import { plural, t } from "../lib/words.ts";

export type Answers = Record<string, number | string>;
export const kMaxText = 2000;

export interface FormView {
  element: HTMLElement;
  answers: () => Answers;
  /** Shows an error at an item; null clears it. */
  set_error: (item: string, text: string | null) => void;
  focus: (item: string) => void;
  fill: (answers: Answers) => void;
}

interface ItemView {
  element: HTMLElement;
  error: HTMLElement;
  read: () => number | string | null;
  write: (value: number | string) => void;
  focus: () => void;
}

function required_mark(item: FormItem): Child {
  return item.is_required ? h("span", { class: "required" }, " ", t("(required)")) : h("span", { class: "dim" }, " ", t("(optional)"));
}

function scale_item(item: FormItem, number: number, error: HTMLElement, changed: () => void): ItemView {
  const name = new_id("scale");
  const chosen = h("p", { class: "chosen", "aria-hidden": "true" }, "\u00a0");
  const labels = scale_labels();
  const inputs = labels.map((_, k) =>
    h("input", {
      type: "radio", id: `${name}-${k}`, name, value: String(k + 1), required: item.is_required,
      on: { change: () => { show(); changed(); } },
    }),
  );
  const show = (): void => {
    const k = inputs.findIndex((one) => one.checked);
    chosen.textContent = k < 0 ? "\u00a0" : `${k + 1} – ${labels[k]}`;
  };
  const element = h(
    "fieldset",
    { class: "item", "aria-describedby": error.id },
    h("legend", {}, `${number}. ${item.text}`, required_mark(item)),
    h(
      "div",
      { class: "scale" },
      labels.map((label, k) => h("div", { class: "scale-choice" }, inputs[k], h("label", { for: `${name}-${k}` }, h("span", { class: "scale-number" }, String(k + 1)), h("span", { class: "scale-label" }, label)))),
    ),
    h("div", { class: "scale-ends", "aria-hidden": "true" }, h("span", {}, labels[0]), h("span", {}, labels[5])),
    chosen,
    error,
  );
  return {
    element,
    error,
    read: () => {
      const one = inputs.find((input) => input.checked);
      return one ? Number(one.value) : null;
    },
    write: (value) => {
      const input = inputs[Number(value) - 1];
      if (input) input.checked = true;
      show();
    },
    focus: () => inputs[0].focus(),
  };
}

function text_item(item: FormItem, number: number, error: HTMLElement, changed: () => void): ItemView {
  const id = new_id("text");
  const left = h("p", { class: "help", id: `${id}-left` });
  const area = h("textarea", { id, class: "field", rows: "5", maxlength: String(kMaxText), required: item.is_required, "aria-describedby": `${id}-left ${error.id}` });
  const show = (): void => {
    left.textContent = plural(kMaxText - area.value.length, "{0} character left", "{0} characters left");
  };
  area.addEventListener("input", () => {
    show();
    changed();
  });
  show();
  return {
    element: h("div", { class: "item" }, h("label", { for: id, class: "item-label" }, `${number}. ${item.text}`, required_mark(item)), area, left, error),
    error,
    read: () => area.value.trim() || null,
    write: (value) => {
      area.value = String(value);
      show();
    },
    focus: () => area.focus(),
  };
}

export function form_view(items: FormItem[], on_change: () => void = () => {}): FormView {
  const views = new Map<string, ItemView>();
  items.forEach((item, k) => {
    const error = h("p", { class: "field-error", id: new_id("error") });
    const changed = (): void => {
      error.textContent = "";
      on_change();
    };
    const view = item.kind === "scale" ? scale_item(item, k + 1, error, changed) : text_item(item, k + 1, error, changed);
    views.set(String(item.id ?? k), view);
  });
  return {
    element: h("div", { class: "items" }, [...views.values()].map((one) => one.element)),
    answers: () => {
      const answers: Answers = {};
      for (const [id, view] of views) {
        const value = view.read();
        if (value !== null) answers[id] = value;
      }
      return answers;
    },
    set_error: (item, text) => {
      const view = views.get(item);
      if (view) view.error.textContent = text ?? "";
    },
    focus: (item) => views.get(item)?.focus(),
    fill: (answers) => {
      for (const [id, value] of Object.entries(answers)) views.get(id)?.write(value);
    },
  };
}
