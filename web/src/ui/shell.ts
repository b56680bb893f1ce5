// The frame of every page: brand, navigation, language, theme, account.

import { h, replace_children } from "../lib/dom.ts";
import type { Me } from "../lib/types.ts";
import { language, t } from "../lib/words.ts";
import { choose_language, kLanguages, language_name } from "../words/languages.ts";
import { toast } from "./states.ts";
import { current_theme, switch_theme } from "./theme.ts";

const sections = (): { path: string; label: string }[] => [
  { path: "/", label: t("Cohort") },
  { path: "/courses", label: t("Courses") },
  { path: "/metrics", label: t("Metrics") },
  { path: "/proficiency", label: t("Proficiency") },
  { path: "/validity", label: t("Validity") },
  { path: "/forms", label: t("Questionnaires") },
  { path: "/account", label: t("Account") },
];

export interface Shell {
  main: HTMLElement;
  /** Navigation for a signed-in account; null: only the brand (login, public questionnaire). */
  set_account: (me: Me | null) => void;
  set_section: (path: string | null) => void;
}

function theme_button(): HTMLButtonElement {
  return h("button", { type: "button", class: "button button-quiet", on: { click: () => switch_theme() } });
}

/** Every language by its own name. */
function language_choice(): HTMLSelectElement {
  const choice = h("select", { class: "language" }, kLanguages.map((code) => h("option", { value: code, lang: code }, language_name(code))));
  choice.addEventListener("change", () => {
    choose_language(choice.value).catch(() => {
      choice.value = language();
      toast(t("The language could not be loaded. Try again."));
    });
  });
  return choice;
}

/** The frame keeps its elements when the language changes; only their texts are written again. */
export function make_shell(sign_out: () => void): Shell {
  const main = h("main", { id: "content", class: "main", tabindex: "-1" });
  const links = new Map(sections().map(({ path }) => [path, h("a", { href: path, class: "nav-link" })]));
  const account_name = h("span", { class: "account-name" });
  const menu_button = h("button", { type: "button", class: "button menu-button", "aria-expanded": "false", "aria-controls": "menu" });
  const leave = h("button", { type: "button", class: "button button-quiet", on: { click: sign_out } });
  const nav = h("nav", {}, h("ul", { class: "nav" }, [...links.values()].map((one) => h("li", {}, one))));
  const menu = h("div", { id: "menu", class: "menu" }, nav, h("div", { class: "menu-end" }, account_name, leave));
  const set_menu = (is_open: boolean): void => {
    menu_button.setAttribute("aria-expanded", String(is_open));
    menu.classList.toggle("is-open", is_open);
  };
  menu_button.addEventListener("click", () => set_menu(menu_button.getAttribute("aria-expanded") !== "true"));
  menu.addEventListener("click", (event) => {
    if ((event.target as Element).closest("a")) set_menu(false);
  });

  const brand = h("div", { class: "brand" });
  const theme = theme_button();
  const languages = language_choice();
  const header = h("header", { class: "header" }, brand, menu_button, menu, h("div", { class: "head-choices" }, languages, theme));
  const footer = h("footer", { class: "footer" });
  const skip = h("a", { class: "skip", href: "#content" });
  document.body.replaceChildren(skip, header, main, footer);
  skip.addEventListener("click", (event) => {
    event.preventDefault();
    main.focus();
  });

  let account: Me | null = null;
  const write_theme = (): void => {
    theme.textContent = current_theme() === "dark" ? t("Light theme") : t("Dark theme");
  };
  const write_texts = (): void => {
    for (const { path, label } of sections()) links.get(path)!.textContent = label;
    menu_button.textContent = t("Menu");
    leave.textContent = t("Sign out");
    skip.textContent = t("Skip to content");
    nav.setAttribute("aria-label", t("Main"));
    languages.setAttribute("aria-label", t("Language"));
    languages.value = language();
    account_name.textContent = account?.account.name ?? "";
    const about = t("A trainer, not a medical device.");
    footer.textContent = account?.program_version ? `Trocar ${account.program_version}. ${about}` : about;
    write_theme();
  };
  document.addEventListener("themechange", write_theme);
  document.addEventListener("wordschange", write_texts);
  write_texts();
  return {
    main,
    set_account: (me) => {
      account = me;
      document.body.classList.toggle("is-signed-in", me !== null);
      replace_children(brand, me ? h("a", { href: "/" }, "Trocar") : h("span", {}, "Trocar"));
      write_texts();
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
