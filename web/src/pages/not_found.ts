import { h } from "../lib/dom.ts";
import type { PageContext } from "../lib/router.ts";
import { t } from "../lib/words.ts";

export function not_found_page({ main, set_title }: PageContext): void {
  set_title(t("Page not found"));
  main.append(h("h1", {}, t("Page not found")), h("p", {}, t("There is no page at {0}.", location.pathname)), h("p", {}, h("a", { href: "/" }, t("Go to the cohort"))));
}
