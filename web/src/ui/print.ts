// Printing: in the light theme, with everything that can be opened.

import { h } from "../lib/dom.ts";
import { t } from "../lib/words.ts";

export function print_button(): HTMLElement {
  return h("button", { type: "button", class: "button", on: { click: () => window.print() } }, t("Print"));
}

/** Opens folded cards and draws plots in the light theme while the page is printed. */
export function start_printing(): void {
  let opened: HTMLDetailsElement[] = [];
  let theme: string | undefined;
  const change_theme = (to: string | undefined): void => {
    document.documentElement.dataset.theme = to;
    document.dispatchEvent(new Event("themechange"));
  };
  window.addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll<HTMLDetailsElement>("details.fold:not([open])")];
    for (const one of opened) one.open = true;
    theme = document.documentElement.dataset.theme;
    change_theme("light");
  });
  window.addEventListener("afterprint", () => {
    for (const one of opened) one.open = false;
    if (theme !== undefined) change_theme(theme);
  });
}
