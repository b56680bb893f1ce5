// Notes of instructors to an attempt.

import { send } from "../lib/api.ts";
import { h, replace_children } from "../lib/dom.ts";

import type { Note } from "../lib/types.ts";
import { plural, t } from "../lib/words.ts";
import { is_admin, session } from "../session.ts";
import { ask } from "../ui/dialog.ts";
import { card, run_once, text_area, time_element } from "../ui/parts.ts";
import { error_box, toast } from "../ui/states.ts";

const kMostCharacters = 2000;

export function notes_card(attempt: string, given: Note[]): HTMLElement {
  let notes = given;
  const list = h("ul", { class: "comments" });
  const problem = h("div", {});
  const remove = (note: Note): void =>
    ask({
      title: t("Delete this note?"),
      text: t("This cannot be undone."),
      action: t("Delete"),
      run: async () => {
        await send("DELETE", `/api/notes/${encodeURIComponent(note.id)}`, {});
        notes = notes.filter((one) => one !== note);
        show();
        toast(t("The note was deleted."));
      },
    });
  const show = (): void => {
    replace_children(
      list,
      notes.map((note) => {
        const may_delete = is_admin() || note.author === session.me?.account.name;
        return h(
          "li",
          {},
          h("p", { class: "comment" }, note.text),
          h("p", { class: "help" }, `${note.author}, `, time_element(note.written_s)),
          may_delete && h("button", { type: "button", class: "button button-small no-print", on: { click: () => remove(note) } }, t("Delete note …")),
        );
      }),
      notes.length === 0 && h("li", { class: "dim" }, t("No notes yet.")),
    );
  };
  const field = text_area(t("New note"), { maxlength: String(kMostCharacters), rows: "3" });
  const button = h("button", { type: "submit", class: "button" }, t("Add note"));
  const add = async (): Promise<void> => {
    replace_children(problem);
    field.set_error(field.input.value.trim() ? null : t("Enter a text."));
    if (!field.input.value.trim()) {
      field.input.focus();
      return;
    }
    try {
      notes = [...notes, await send<Note>("POST", `/api/attempts/${encodeURIComponent(attempt)}/notes`, { text: field.input.value })];
      field.input.value = "";
      show();
      toast(plural(notes.length, "The note was saved: {0} note in all.", "The note was saved: {0} notes in all."));
    } catch (error) {
      replace_children(problem, error_box(error));
    }
  };
  const form = h("form", { class: "form no-print", novalidate: true }, field.element, problem, button);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void run_once(button, add);
  });
  show();
  return card(t("Notes"), { class: "card-notes" }, h("p", { class: "help" }, t("Every instructor can read the notes. They are deleted with the person.")), list, form);
}
