// Pages by path. A page fills `main`; leaving it aborts its signal, which ends its requests and listeners.

import { error_box } from "../ui/states.ts";
import { ApiError } from "./api.ts";
import { replace_children } from "./dom.ts";
import { t } from "./words.ts";

export interface PageContext {
  main: HTMLElement;
  params: string[];
  query: URLSearchParams;
  signal: AbortSignal;
  /** Text of the browser's tab, without the program's name. */
  set_title: (title: string) => void;
}
export type Page = (context: PageContext) => void | Promise<void>;
export interface Route {
  pattern: RegExp;
  load: () => Promise<Page>;
  is_public?: boolean;
  /** Path of the entry of the navigation that is marked as current. */
  section?: string;
}

interface State {
  routes: Route[];
  main: HTMLElement | null;
  controller: AbortController;
  before: (route: Route, path: string) => Promise<boolean>;
}
const state: State = { routes: [], main: null, controller: new AbortController(), before: async () => true };

async function show(is_first: boolean): Promise<void> {
  const main = state.main;
  if (!main) return;
  state.controller.abort();
  const controller = new AbortController();
  state.controller = controller;
  const path = location.pathname;
  const route = state.routes.find((one) => one.pattern.test(path))!;
  if (!(await state.before(route, path)) || controller.signal.aborted) return;
  let page: Page;
  try {
    page = await route.load();
  } catch {
    page = ({ main: place }) => replace_children(place, error_box(new ApiError(0, t("A part of the page could not be loaded"), t("Reload the page.")), () => location.reload()));
  }
  if (controller.signal.aborted) return;
  main.replaceChildren();
  const params = (route.pattern.exec(path) ?? []).slice(1).map((one) => decode(one ?? ""));
  await page({
    main,
    params,
    query: new URLSearchParams(location.search),
    signal: controller.signal,
    set_title: (title) => {
      document.title = title ? `${title} – Trocar` : "Trocar";
    },
  });
  if (!is_first && !controller.signal.aborted) focus_heading(main);
}

function decode(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

function focus_heading(main: HTMLElement): void {
  window.scrollTo(0, 0);
  const heading = main.querySelector("h1");
  if (heading && !main.contains(document.activeElement)) {
    heading.tabIndex = -1;
    heading.focus({ preventScroll: true });
  }
}

/** The same page again, in another language. The focus stays in the page's head. */
export function show_again(): void {
  void show(true);
}

export function navigate(path: string, replace = false): void {
  if (replace) history.replaceState(null, "", path);
  else history.pushState(null, "", path);
  void show(false);
}

/** Writes the page's state (filters, order) into its address without a new page. */
export function write_query(values: Record<string, string>): void {
  const query = new URLSearchParams(location.search);
  for (const [name, value] of Object.entries(values)) {
    if (value) query.set(name, value);
    else query.delete(name);
  }
  const text = query.toString();
  history.replaceState(null, "", text ? `${location.pathname}?${text}` : location.pathname);
}

/** The last route has to match every path. `before` may refuse a page after it has navigated elsewhere. */
export function start_router(main: HTMLElement, routes: Route[], before: State["before"]): void {
  state.routes = routes;
  state.main = main;
  state.before = before;
  window.addEventListener("popstate", () => void show(false));
  document.addEventListener("click", (event) => {
    if (event.defaultPrevented || event.button !== 0 || event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const link = (event.target as Element | null)?.closest("a");
    if (!link || link.target || link.hasAttribute("download") || link.origin !== location.origin) return;
    if (link.pathname.startsWith("/api/") || (link.hash && link.pathname === location.pathname)) return;
    event.preventDefault();
    navigate(link.pathname + link.search);
  });
  void show(true);
}
