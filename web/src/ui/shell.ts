// The frame of every page: brand, navigation, theme, account.

import { h, replace_children } from "../lib/dom.ts";
import type { Me } from "../lib/types.ts";
import { current_theme, switch_theme } from "./theme.ts";

const kSections = [
  { path: "/", label: "Cohort" },
  { path: "/courses", label: "Courses" },
  { path: "/metrics", label: "Metrics" },
  { path: "/proficiency", label: "Proficiency" },
  { path: "/validity", label: "Validity" },
  { path: "/forms", label: "Questionnaires" },
  { path: "/account", label: "Account" },
];

export interface Shell {
  main: HTMLElement;
  /** Navigation for a signed-in account; null: only the brand (login, public questionnaire). */
  set_account: (me: Me | null) => void;
  set_section: (path: string | null) => void;
}

function theme_button(): HTMLElement {
  const label = (): string => (current_theme() === "dark" ? "Light theme" : "Dark theme");
  const button = h("button", { type: "button", class: "button button-quiet" }, label());
  button.addEventListener("click", () => switch_theme());
  document.addEventListener("themechange", () => (button.textContent = label()));
  return button;
}

export function make_shell(sign_out: () => void): Shell {
  const main = h("main", { id: "content", class: "main", tabindex: "-1" });
  const links = new Map(kSections.map((one) => [one.path, h("a", { href: one.path, class: "nav-link" }, one.label)]));
  const account_name = h("span", { class: "account-name" });
  const menu_button = h("button", { type: "button", class: "button menu-button", "aria-expanded": "false", "aria-controls": "menu" }, "Menu");
  const menu = h(
    "div",
    { id: "menu", class: "menu" },
    h("nav", { "aria-label": "Main" }, h("ul", { class: "nav" }, [...links.values()].map((one) => h("li", {}, one)))),
    h("div", { class: "menu-end" }, account_name, h("button", { type: "button", class: "button button-quiet", on: { click: sign_out } }, "Sign out")),
  );
  const set_menu = (is_open: boolean): void => {
    menu_button.setAttribute("aria-expanded", String(is_open));
    menu.classList.toggle("is-open", is_open);
  };
  menu_button.addEventListener("click", () => set_menu(menu_button.getAttribute("aria-expanded") !== "true"));
  menu.addEventListener("click", (event) => {
    if ((event.target as Element).closest("a")) set_menu(false);
  });

  const brand = h("div", { class: "brand" });
  const header = h("header", { class: "header" }, brand, menu_button, menu, theme_button());
  const footer = h("footer", { class: "footer" });
  const skip = h("a", { class: "skip", href: "#content" }, "Skip to content");
  document.body.replaceChildren(skip, header, main, footer);
  skip.addEventListener("click", (event) => {
    event.preventDefault();
    main.focus();
  });
  return {
    main,
    set_account: (me) => {
      document.body.classList.toggle("is-signed-in", me !== null);
      replace_children(brand, me ? h("a", { href: "/" }, "Trocar") : h("span", {}, "Trocar"));
      account_name.textContent = me?.account.name ?? "";
      const version = me?.program_version ? `Trocar ${me.program_version}. ` : "";
      footer.textContent = `${version}A trainer, not a medical device.`;
    },
    set_section: (path) => {
      set_menu(false);
      for (const [own, link] of links) {
        if (own === path) link.setAttribute("aria-current", "page");
        else link.removeAttribute("aria-current");
      }
    },
  };
}
