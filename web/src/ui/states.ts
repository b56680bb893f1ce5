// Loading, empty and failed states of a part of a page.

import { ApiError } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";

export function error_box(error: unknown, retry?: () => void): HTMLElement {
  const known = error instanceof ApiError ? error : null;
  const wait = known?.retry_after_s ? ` Possible again in ${known.retry_after_s} s.` : "";
  return h(
    "div",
    { class: "notice notice-bad", role: "alert" },
    h("p", { class: "notice-title" }, known ? known.message : "The page could not be shown"),
    h("p", {}, (known ? known.advice : "Reload the page.") + wait),
    retry && h("button", { type: "button", class: "button", on: { click: retry } }, "Try again"),
  );
}

export function empty_box(title: string, ...text: Child[]): HTMLElement {
  return h("div", { class: "notice" }, h("p", { class: "notice-title" }, title), h("p", {}, text));
}

export function loading_box(): HTMLElement {
  return h("div", { class: "loading", role: "status" }, h("span", { class: "spinner", "aria-hidden": "true" }), "Loading …");
}

/** Shows the loading state in `place`, then what `render` makes of the answer, or the error with a retry. */
export async function load_into<T>(place: Element, signal: AbortSignal, load: () => Promise<T>, render: (answer: T) => Child): Promise<void> {
  replace_children(place, loading_box());
  place.classList.add("stack");
  place.setAttribute("aria-busy", "true");
  try {
    const answer = await load();
    if (signal.aborted) return;
    replace_children(place, render(answer));
  } catch (error) {
    if (signal.aborted) return;
    if (!(error instanceof ApiError)) console.error(error);
    replace_children(place, error_box(error, () => void load_into(place, signal, load, render)));
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
