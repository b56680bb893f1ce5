// A modal question before an action that cannot be undone.

import { error_box } from "./states.ts";
import { run_once, text_field } from "./parts.ts";
import { h, new_id, replace_children } from "../lib/dom.ts";

interface Question {
  title: string;
  text: string;
  action: string;
  /** Text that has to be typed before the action is possible. */
  typed?: { label: string; value: string };
  run: () => Promise<void>;
}

export function ask(question: Question): void {
  const title_id = new_id("dialog");
  const problem = h("div", {});
  const typed = question.typed ? text_field(question.typed.label, { spellcheck: "false" }) : null;
  const confirm = h("button", { type: "submit", class: "button button-danger" }, question.action);
  const submit = (event: Event): void => {
    event.preventDefault();
    if (typed && typed.input.value.trim() !== question.typed!.value.trim()) {
      typed.set_error(`Type exactly: ${question.typed!.value}`);
      typed.input.focus();
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
      { on: { submit } },
      h("h2", { id: title_id }, question.title),
      h("p", {}, question.text),
      typed?.element,
      problem,
      h("div", { class: "buttons" }, h("button", { type: "button", class: "button", on: { click: () => dialog.close() } }, "Cancel"), confirm),
    ),
  );
  document.body.append(dialog);
  dialog.showModal();
}
