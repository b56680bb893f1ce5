import { h } from "../lib/dom.ts";
import type { PageContext } from "../lib/router.ts";

export function not_found_page({ main, set_title }: PageContext): void {
  set_title("Page not found");
  main.append(h("h1", {}, "Page not found"), h("p", {}, `There is no page at ${location.pathname}.`), h("p", {}, h("a", { href: "/" }, "Go to the cohort")));
}
