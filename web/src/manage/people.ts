// Dialogs that add, change and move people, and set their PINs.

import { send } from "../lib/api.ts";
import { h, new_id, type Child } from "../lib/dom.ts";
import { group_text } from "../lib/format.ts";
import { navigate } from "../lib/router.ts";
import type { Course, Person } from "../lib/types.ts";
import { plural, t } from "../lib/words.ts";
import { ask } from "../ui/dialog.ts";
import { select_field, text_field, type Choice, type TextField } from "../ui/parts.ts";
import { toast } from "../ui/states.ts";

const groups = (): Choice[] => ["trainee", "expert"].map((value) => ({ value, label: group_text(value) }));

/** What is wrong with a PIN; null if nothing is. */
export function pin_problem(pin: string): string | null {
  return /^[0-9]{4,12}$/.test(pin) ? null : t("Enter 4 to 12 digits.");
}

/** A course by its name, with the names of those that there are. */
function course_field(courses: Course[], value: string, help: string): { elements: Child; field: TextField } {
  const list = new_id("courses");
  const field = text_field(t("Course"), { value, maxlength: "100", list }, help);
  return { elements: [field.element, h("datalist", { id: list }, courses.map((one) => h("option", { value: one.name })))], field };
}

interface PersonFields {
  elements: Child;
  check: () => boolean;
  values: () => { name: string; group: string; course: string };
}
function person_fields(person: { name: string; group: string; course: string }, courses: Course[]): PersonFields {
  const name = text_field(t("Name"), { value: person.name, maxlength: "100" });
  let group = person.group;
  const course = course_field(courses, person.course, t("Choose a course or enter the name of a new one. Empty: no course."));
  return {
    elements: [name.element, select_field(t("Group"), groups(), group, (value) => (group = value)), course.elements],
    check: () => {
      name.set_error(name.input.value.trim() ? null : t("Enter a name."));
      return !name.input.hasAttribute("aria-invalid");
    },
    values: () => ({ name: name.input.value.trim(), group, course: course.field.input.value.trim() }),
  };
}

export function add_person(courses: Course[]): void {
  const fields = person_fields({ name: "", group: "trainee", course: "" }, courses);
  ask({
    title: t("Add a person"),
    text: t("The person can then be chosen at every station of this database."),
    action: t("Add"),
    is_harmless: true,
    fields: fields.elements,
    check: fields.check,
    run: async () => {
      const added = await send<{ id: string; name: string }>("POST", "/api/people", fields.values());
      toast(t("{0} was added.", added.name));
      navigate(`/people/${encodeURIComponent(added.id)}`);
    },
  });
}

export function change_person(person: Person, courses: Course[], reload: () => void): void {
  const fields = person_fields({ name: person.name, group: person.group, course: String(person.course ?? "") }, courses);
  ask({
    title: t("Name, group and course"),
    text: t("All results stay with the person. Group and course decide with whom the results are compared."),
    action: t("Save"),
    is_harmless: true,
    fields: fields.elements,
    check: fields.check,
    run: async () => {
      const saved = await send<{ name: string }>("PUT", `/api/people/${encodeURIComponent(person.id)}`, fields.values());
      toast(t("The changes to {0} were saved.", saved.name));
      reload();
    },
  });
}

function pin_field(label: string): TextField {
  return text_field(label, { type: "password", inputmode: "numeric", autocomplete: "new-password", maxlength: "100" });
}

export function set_pin(person: Person, reload: () => void): void {
  const pin = pin_field(t("New PIN (4 to 12 digits)"));
  const again = pin_field(t("New PIN again"));
  const path = `/api/people/${encodeURIComponent(person.id)}/pin`;
  ask({
    title: person.has_pin ? t("Replace the PIN") : t("Set a PIN"),
    text: t("{0} enters the PIN at a station before an attempt. Nobody can read a PIN, only replace it.", person.name),
    action: t("Save"),
    is_harmless: true,
    fields: [pin.element, again.element],
    check: () => {
      pin.set_error(pin_problem(pin.input.value));
      again.set_error(again.input.value === pin.input.value ? null : t("The two PINs differ."));
      return !pin.input.hasAttribute("aria-invalid") && !again.input.hasAttribute("aria-invalid");
    },
    run: async () => {
      await send("PUT", path, { pin: pin.input.value });
      toast(t("{0} has a new PIN.", person.name));
      reload();
    },
  });
}

export function remove_pin(person: Person, reload: () => void): void {
  ask({
    title: t("Remove the PIN?"),
    text: t("Anybody at a station can then practise as {0}, unless PINs are required.", person.name),
    action: t("Remove"),
    run: async () => {
      await send("PUT", `/api/people/${encodeURIComponent(person.id)}/pin`, { pin: "" });
      toast(t("{0} has no PIN.", person.name));
      reload();
    },
  });
}

/** Moves some of `people` to a course. */
export function move_people(people: Person[], courses: Course[], reload: () => void): void {
  const names = new Map(courses.map((one) => [String(one.id), one.name]));
  const boxes = people.map((person) => ({ person, box: h("input", { type: "checkbox", id: new_id("move") }) }));
  const problem = h("p", { class: "field-error", role: "alert" });
  const count = h("span", { class: "dim", role: "status" });
  const chosen = (): Person[] => boxes.filter(({ box }) => box.checked).map(({ person }) => person);
  const show_count = (): void => {
    count.textContent = plural(people.length, "{1} of {0} person chosen", "{1} of {0} people chosen", chosen().length);
    problem.textContent = "";
  };
  const all = h("button", { type: "button", class: "button button-small" }, t("Choose all"));
  all.addEventListener("click", () => {
    for (const { box } of boxes) box.checked = true;
    show_count();
  });
  const course = course_field(courses, "", t("Choose a course or enter the name of a new one."));
  const list = h(
    "div",
    { class: "choices", tabindex: "0", role: "group", "aria-label": t("People to move") },
    h("ul", {}, boxes.map(({ person, box }) => h("li", { class: "check" }, box, h("label", { for: box.id }, person.name, h("span", { class: "dim" }, ` – ${person.course === null ? t("no course") : (names.get(String(person.course)) ?? String(person.course))}`))))),
  );
  list.addEventListener("change", show_count);
  show_count();
  ask({
    title: t("Move people to a course"),
    text: t("The list has the people that search and filters show."),
    action: t("Move"),
    is_harmless: true,
    fields: [list, h("div", { class: "more" }, all, count), problem, course.elements],
    check: () => {
      problem.textContent = chosen().length > 0 ? "" : t("Choose at least one person.");
      course.field.set_error(course.field.input.value.trim() ? null : t("Enter a course."));
      return chosen().length > 0 && !course.field.input.hasAttribute("aria-invalid");
    },
    run: async () => {
      const moved = chosen();
      const name = course.field.input.value.trim();
      await send("POST", "/api/people/move", { people: moved.map((one) => one.id), course: name });
      toast(plural(moved.length, "Moved to {1}: {0} person.", "Moved to {1}: {0} people.", name));
      reload();
    },
  });
}
