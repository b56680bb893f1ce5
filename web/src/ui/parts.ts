// Small parts that several pages use.

import { h, new_id, type Attributes, type Child } from "../lib/dom.ts";
import { date_time_text, group_text, sentence } from "../lib/format.ts";
import { said, t } from "../lib/words.ts";

export function simulated_badge(): HTMLElement {
  return h("span", { class: "badge badge-simulated", title: t("A scripted operator of Trocar, not a person") }, t("Simulated"));
}

export function group_badge(group: string): HTMLElement {
  return h("span", { class: `badge badge-${group === "expert" ? "expert" : "plain"}` }, group_text(group));
}

export function person_badges(person: { group?: string; simulated: boolean }): HTMLElement {
  return h("span", { class: "badges" }, person.group === "expert" && group_badge(person.group), person.simulated && simulated_badge());
}

/** The reasons why an attempt did not pass, as a list of sentences. */
export function reasons_list(attempt: { passed: boolean | null; score: number | null; fails?: string[]; not_scored?: string | boolean | null }): Child {
  if (attempt.passed === true) return null;
  const given = typeof attempt.not_scored === "string" && attempt.not_scored ? [attempt.not_scored] : [];
  const reasons = [...given, ...(attempt.fails ?? [])];
  return reasons.length > 0 && h("ul", { class: "reasons" }, reasons.map((one) => h("li", {}, sentence(said(one)))));
}

export function passed_text(passed: boolean | null, score: number | null): HTMLElement {
  if (passed === null) return h("span", { class: "outcome" }, t("Does not count"));
  if (score === null) return h("span", { class: "outcome outcome-bad" }, h("span", { "aria-hidden": "true" }, "✕ "), t("Not passed: no result"));
  return passed
    ? h("span", { class: "outcome outcome-good" }, h("span", { "aria-hidden": "true" }, "✓ "), t("Passed"))
    : h("span", { class: "outcome outcome-bad" }, h("span", { "aria-hidden": "true" }, "✕ "), t("Not passed"));
}

export function time_element(seconds: number | null): HTMLElement | string {
  if (seconds === null) return "–";
  return h("time", { datetime: new Date(seconds * 1000).toISOString() }, date_time_text(seconds));
}

export function card(title: string | null, attributes: Attributes, ...children: Child[]): HTMLElement {
  const { class: more, ...rest } = attributes;
  if (title === null) return h("div", { class: `card ${more ?? ""}`, ...rest }, children);
  const id = new_id("card");
  return h("section", { class: `card ${more ?? ""}`, "aria-labelledby": id, ...rest }, h("h2", { id }, title), children);
}

export function is_phone(): boolean {
  return window.matchMedia("(max-width: 560px)").matches;
}

/** A card that can be closed. On a phone it begins closed, so that a page shows what it has at a glance. */
export function fold_card(title: string, attributes: Attributes, ...children: Child[]): HTMLDetailsElement {
  const { class: more, ...rest } = attributes;
  return h("details", { class: `card fold ${more ?? ""}`, open: !is_phone(), ...rest }, h("summary", {}, h("h2", {}, title)), h("div", { class: "stack" }, children));
}

export interface Choice {
  value: string;
  label: string;
}

export function select_field(label: string, choices: Choice[], value: string, on_change: (value: string) => void): HTMLElement {
  const id = new_id("select");
  const known = choices.some((one) => one.value === value) ? value : (choices[0]?.value ?? "");
  const select = h(
    "select",
    { id, class: "field", on: { change: () => on_change(select.value) } },
    choices.map((one) => h("option", { value: one.value }, one.label)),
  );
  select.value = known;
  return h("div", { class: "labelled" }, h("label", { for: id }, label), select);
}

export interface TextField {
  element: HTMLElement;
  input: HTMLInputElement;
  set_error: (text: string | null) => void;
}

/** A labelled input; its error is tied to it for screen readers. */
export function text_field(label: string, attributes: Attributes, help?: string): TextField {
  const id = new_id("field");
  const error = h("p", { class: "field-error", id: `${id}-error` });
  const input = h("input", {
    id,
    class: "field",
    type: "text",
    autocomplete: "off",
    "aria-describedby": help ? `${id}-help ${id}-error` : `${id}-error`,
    ...attributes,
  });
  const element = h("div", { class: "labelled" }, h("label", { for: id }, label), input, help && h("p", { class: "help", id: `${id}-help` }, help), error);
  return {
    element,
    input,
    set_error: (text) => {
      error.textContent = text ?? "";
      if (text) input.setAttribute("aria-invalid", "true");
      else input.removeAttribute("aria-invalid");
    },
  };
}

export interface TextArea {
  element: HTMLElement;
  input: HTMLTextAreaElement;
  set_error: (text: string | null) => void;
}

/** A labelled field of several lines. */
export function text_area(label: string, attributes: Attributes): TextArea {
  const id = new_id("area");
  const error = h("p", { class: "field-error", id: `${id}-error` });
  const input = h("textarea", { id, class: "field", rows: "3", "aria-describedby": `${id}-error`, ...attributes });
  return {
    element: h("div", { class: "labelled" }, h("label", { for: id }, label), input, error),
    input,
    set_error: (text) => {
      error.textContent = text ?? "";
      if (text) input.setAttribute("aria-invalid", "true");
      else input.removeAttribute("aria-invalid");
    },
  };
}

/** Disables the button while the action runs, so that it cannot run twice. */
export async function run_once(button: HTMLButtonElement, action: () => Promise<void>): Promise<void> {
  if (button.getAttribute("aria-disabled") === "true") return;
  button.setAttribute("aria-disabled", "true");
  try {
    await action();
  } finally {
    button.removeAttribute("aria-disabled");
  }
}

export function breadcrumb(...steps: { label: string; path?: string }[]): HTMLElement {
  return h(
    "nav",
    { class: "breadcrumb", "aria-label": t("Breadcrumb") },
    h("ol", {}, steps.map((one) => h("li", {}, one.path ? h("a", { href: one.path }, one.label) : h("span", { "aria-current": "page" }, one.label)))),
  );
}
