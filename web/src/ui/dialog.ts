// A modal question before an action: one that cannot be undone, or one with fields.

import { error_box } from "./states.ts";
import { run_once, text_field } from "./parts.ts";
import { h, new_id, replace_children, type Child } from "../lib/dom.ts";
import { t } from "../lib/words.ts";

interface Question {
  title: string;
  text?: string;
  action: string;
  /** Loses nothing: the button of the action is not marked as dangerous. */
  is_harmless?: boolean;
  /** Fields between text and buttons. */
  fields?: Child;
  /** Whether the fields are right; it marks those that are not. */
  check?: () => boolean;
  /** Text that has to be typed before the action is possible. */
  typed?: { label: string; value: string };
  run: () => Promise<void>;
}

export function ask(question: Question): void {
  const title_id = new_id("dialog");
  const problem = h("div", {});
  const typed = question.typed ? text_field(question.typed.label, { spellcheck: "false" }) : null;
  const confirm = h("button", { type: "submit", class: `button ${question.is_harmless ? "button-primary" : "button-danger"}` }, question.action);
  const submit = (event: Event): void => {
    event.preventDefault();
    if (typed && typed.input.value.trim() !== question.typed!.value.trim()) {
      typed.set_error(t("Type exactly: {0}", question.typed!.value));
      typed.input.focus();
      return;
    }
    if (question.check && !question.check()) {
      dialog.querySelector<HTMLElement>("[aria-invalid]")?.focus();
      return;
    }
    void run_once(confirm, async () => {
      try {
        await question.run();
        dialog.close();
      } catch (error) {
        replace_children(problem, error_box(error));
      }
    });
  };
  const dialog = h(
    "dialog",
    { class: "dialog", "aria-labelledby": title_id, on: { close: () => dialog.remove() } },
    h(
      "form",
      { novalidate: true, on: { submit } },
      h("h2", { id: title_id }, question.title),
      question.text && h("p", {}, question.text),
      question.fields,
      typed?.element,
      problem,
      h("div", { class: "buttons" }, h("button", { type: "button", class: "button", on: { click: () => dialog.close() } }, t("Cancel")), confirm),
    ),
  );
  document.body.append(dialog);
  dialog.showModal();
}
