// Loading, empty and failed states of a part of a page.

import { ApiError } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";
import { t } from "../lib/words.ts";

/** Where to go when what a page shows does not exist (any more). */
export interface Missing {
  title: string;
  text: string;
  link: { label: string; path: string };
}

/** The heading of the page where it has none yet: a page without its content still needs one. */
function title_element(text: string): HTMLElement {
  return document.querySelector("main h1") ? h("p", { class: "notice-title" }, text) : h("h1", { class: "notice-title" }, text);
}

export function error_box(error: unknown, retry?: () => void): HTMLElement {
  const known = error instanceof ApiError ? error : null;
  const wait = known?.retry_after_s ? h("p", {}, t("Try again in {0} s.", known.retry_after_s)) : null;
  return h(
    "div",
    { class: "notice notice-bad", role: "alert" },
    title_element(known ? known.message : t("The page could not be shown")),
    h("p", {}, known ? known.advice : t("Reload the page.")),
    wait,
    retry && h("button", { type: "button", class: "button", on: { click: retry } }, t("Try again")),
  );
}

export function missing_box(missing: Missing): HTMLElement {
  return h("div", { class: "notice notice-bad", role: "alert" }, title_element(missing.title), h("p", {}, missing.text), h("p", {}, h("a", { href: missing.link.path }, missing.link.label)));
}

export function empty_box(title: string, ...text: Child[]): HTMLElement {
  return h("div", { class: "notice" }, h("p", { class: "notice-title" }, title), h("p", {}, text));
}

export function loading_box(): HTMLElement {
  return h("div", { class: "loading", role: "status" }, h("span", { class: "spinner", "aria-hidden": "true" }), t("Loading …"));
}

/** Number of the last load of each place: an answer that arrives after a newer load began is dropped. */
const last_load = new WeakMap<Element, number>();

/** Shows the loading state in `place`, then what `render` makes of the answer, or the error with a retry. `missing`: shown for 404. */
export async function load_into<T>(place: Element, signal: AbortSignal, load: () => Promise<T>, render: (answer: T) => Child, missing?: Missing): Promise<void> {
  const own = (last_load.get(place) ?? 0) + 1;
  last_load.set(place, own);
  const is_over = (): boolean => signal.aborted || last_load.get(place) !== own;
  replace_children(place, loading_box());
  place.classList.add("stack");
  place.setAttribute("aria-busy", "true");
  try {
    const answer = await load();
    if (is_over()) return;
    replace_children(place, render(answer));
  } catch (error) {
    if (is_over()) return;
    if (!(error instanceof ApiError)) console.error(error);
    place.replaceChildren();
    const is_missing = missing !== undefined && error instanceof ApiError && error.status === 404;
    replace_children(place, is_missing ? missing_box(missing) : error_box(error, () => void load_into(place, signal, load, render, missing)));
  }
  place.removeAttribute("aria-busy");
}

/** A short message at the page's lower edge, also read aloud. */
export function toast(text: string): void {
  let region = document.getElementById("toasts");
  if (!region) {
    region = h("div", { id: "toasts", role: "status" });
    document.body.append(region);
  }
  const message = h("div", { class: "toast" }, text);
  region.append(message);
  setTimeout(() => message.remove(), 6000);
}
