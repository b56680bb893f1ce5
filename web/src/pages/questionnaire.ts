// The public questionnaire: no login, works on a phone, keeps the answers until the server has them.

import { ApiError, get, send } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";

import type { PageContext } from "../lib/router.ts";
import type { PublicForm } from "../lib/types.ts";
import { plural, t } from "../lib/words.ts";
import { form_view, type Answers } from "../ui/form_view.ts";
import { run_once } from "../ui/parts.ts";
import { error_box, load_into } from "../ui/states.ts";

interface Draft {
  answers: Answers;
  /** Sent with the answers: the server stores a response once, however often it is sent. */
  response_id: string;
}

function new_id(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (one) => one.toString(16).padStart(2, "0")).join("");
}

/** Answers that are not sent yet, for this tab only: the next person at the same computer must not see them. */
function draft_of(token: string): { read: () => Draft; write: (draft: Draft) => void; clear: () => void } {
  const key = `trocar-answers-${token}`;
  const quietly = <T>(action: () => T, otherwise: T): T => {
    try {
      return action();
    } catch {
      return otherwise;
    }
  };
  return {
    read: () => ({ answers: {}, response_id: new_id(), ...quietly(() => JSON.parse(sessionStorage.getItem(key) ?? "{}") as Partial<Draft>, {}) }),
    write: (draft) => quietly(() => sessionStorage.setItem(key, JSON.stringify(draft)), undefined),
    clear: () => quietly(() => sessionStorage.removeItem(key), undefined),
  };
}

/** Ids of required items without an answer, in the order of the form. */
export function missing_items(items: PublicForm["items"], answers: Answers): string[] {
  return items.filter((one) => one.is_required && answers[String(one.id)] === undefined).map((one) => String(one.id));
}

function thanks(title: string, again: () => void): Child {
  const heading = h("h1", { tabindex: "-1" }, t("Thank you"));
  setTimeout(() => heading.focus());
  return h(
    "div",
    { class: "questionnaire card" },
    heading,
    h("p", {}, t("Your answers to “{0}” were received. You can close this page.", title)),
    h("button", { type: "button", class: "button", on: { click: again } }, t("Answer for another person")),
  );
}

function show_form(form: PublicForm, token: string, place: HTMLElement, context: PageContext): Child {
  context.set_title(form.title);
  const draft = draft_of(token);
  const { answers: kept, response_id } = draft.read();
  const view = form_view(form.items, () => draft.write({ answers: view.answers(), response_id }));
  view.fill(kept);
  const problem = h("div", {});
  const button = h("button", { type: "submit", class: "button button-primary button-wide" }, t("Send answers"));
  const submit = async (): Promise<void> => {
    const answers = view.answers();
    for (const item of form.items) view.set_error(String(item.id), null);
    const missing = missing_items(form.items, answers);
    if (missing.length > 0) {
      for (const item of missing) view.set_error(item, t("Please answer this question."));
      replace_children(problem, h("p", { class: "notice notice-bad", role: "alert" }, plural(missing.length, "{0} answer is missing. The first one has the focus.", "{0} answers are missing. The first one has the focus.")));
      view.focus(missing[0]);
      return;
    }
    replace_children(problem);
    button.textContent = t("Sending …");
    try {
      await send("POST", `/api/public/forms/${encodeURIComponent(token)}/answers`, { answers, response_id }, { without_session: true });
      draft.clear();
      replace_children(place, thanks(form.title, () => replace_children(place, show_form(form, token, place, context))));
    } catch (error) {
      const is_network = error instanceof ApiError && error.status === 0;
      const shown = is_network ? new ApiError(0, t("Your answers could not be sent"), t("They are kept on this page. Check the connection, then send them again.")) : error;
      replace_children(problem, error_box(shown));
    } finally {
      button.textContent = t("Send answers");
    }
  };
  const element = h("form", { novalidate: true, lang: form.language || null }, view.element, problem, button);
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    void run_once(button, submit);
  });
  return h(
    "div",
    { class: "questionnaire card" },
    h("h1", {}, form.title),
    form.intro.split(/\n+/).filter(Boolean).map((one) => h("p", { class: "lead" }, one)),
    h("p", { class: "help" }, t("Scale: 1 is strongly agree, 6 is strongly disagree.")),
    element,
  );
}

export async function questionnaire_page(context: PageContext): Promise<void> {
  const token = context.params[0];
  context.set_title(t("Questionnaire"));
  const place = h("div", {});
  context.main.append(place);
  const load = async (): Promise<PublicForm | null> => {
    try {
      return await get<PublicForm>(`/api/public/forms/${encodeURIComponent(token)}`, context.signal, { without_session: true });
    } catch (error) {
      if (error instanceof ApiError && error.status === 404) return null;
      throw error;
    }
  };
  await load_into(place, context.signal, load, (form) =>
    form
      ? show_form(form, token, place, context)
      : h("div", { class: "questionnaire card" }, h("h1", {}, t("This questionnaire is not open")), h("p", {}, t("It may be closed, or the address is incomplete. Ask the person who gave you the address."))),
  );
}
