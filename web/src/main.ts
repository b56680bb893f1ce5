// Start: language, theme, frame, routes, session.

import { ApiError, get, on_session_expired, send, set_csrf } from "./lib/api.ts";
import { keeping_choices } from "./lib/choices.ts";
import { navigate, show_again, start_router, type Route } from "./lib/router.ts";
import type { Me } from "./lib/types.ts";
import { t } from "./lib/words.ts";
import { session } from "./session.ts";
import { make_shell } from "./ui/shell.ts";
import { error_box, toast } from "./ui/states.ts";
import { start_printing } from "./ui/print.ts";
import { start_theme } from "./ui/theme.ts";
import { load_server_words, start_language } from "./words/languages.ts";

const kRoutes: Route[] = [
  { pattern: /^\/$/, section: "/", load: async () => (await import("./pages/cohort.ts")).cohort_page },
  { pattern: /^\/login$/, is_public: true, load: async () => (await import("./pages/login.ts")).login_page },
  { pattern: /^\/people\/([^/]+)$/, section: "/", load: async () => (await import("./pages/person.ts")).person_page },
  { pattern: /^\/attempts\/([^/]+)$/, section: "/", load: async () => (await import("./pages/attempt.ts")).attempt_page },
  { pattern: /^\/courses$/, section: "/courses", load: async () => (await import("./pages/courses.ts")).courses_page },
  { pattern: /^\/course$/, section: "/courses", load: async () => (await import("./pages/course.ts")).course_page },
  { pattern: /^\/metrics$/, section: "/metrics", load: async () => (await import("./pages/metrics.ts")).metrics_page },
  { pattern: /^\/proficiency$/, section: "/proficiency", load: async () => (await import("./pages/proficiency.ts")).proficiency_page },
  { pattern: /^\/validity$/, section: "/validity", load: async () => (await import("./pages/validity.ts")).validity_page },
  { pattern: /^\/forms$/, section: "/forms", load: async () => (await import("./pages/forms.ts")).forms_page },
  { pattern: /^\/forms\/(new)$/, section: "/forms", load: async () => (await import("./pages/form_editor.ts")).form_editor_page },
  { pattern: /^\/forms\/([^/]+)\/edit$/, section: "/forms", load: async () => (await import("./pages/form_editor.ts")).form_editor_page },
  { pattern: /^\/forms\/([^/]+)$/, section: "/forms", load: async () => (await import("./pages/form_results.ts")).form_results_page },
  { pattern: /^\/account$/, section: "/account", load: async () => (await import("./pages/account.ts")).account_page },
  { pattern: /^\/q\/([^/]+)$/, is_public: true, load: async () => (await import("./pages/questionnaire.ts")).questionnaire_page },
  { pattern: /./, is_public: true, load: async () => (await import("./pages/not_found.ts")).not_found_page },
];

function set_me(me: Me | null): void {
  session.me = me;
  set_csrf(me?.csrf ?? null);
}

async function sign_out(): Promise<void> {
  try {
    // The server tells the browser to delete what the page has stored: drafts must not stay for the next person.
    await keeping_choices(() => send("POST", "/api/logout", {}, { without_session: true }));
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 401) {
      toast(t("You are still signed in: the server does not answer. Try again."));
      return;
    }
  }
  set_me(null);
  navigate("/login");
}

/** Every text of the page is made after its language is there. */
function start(): void {
  start_printing();
  const shell = make_shell(() => void sign_out());
  on_session_expired(() => {
    if (location.pathname === "/login") return;
    const had_session = session.me !== null;
    set_me(null);
    const next = encodeURIComponent(location.pathname + location.search);
    navigate(`/login?next=${next}${had_session ? "&expired=1" : ""}`, true);
  });

  document.addEventListener("wordschange", show_again);
  start_router(shell.main, kRoutes, async (route) => {
    if (!route.is_public && !session.me) {
      try {
        set_me(await get<Me>("/api/me"));
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 401) {
          shell.set_account(null);
          shell.main.replaceChildren(error_box(error, () => location.reload()));
        }
        return false;
      }
    }
    if (!route.is_public) await load_server_words();
    shell.set_account(route.is_public ? null : session.me);
    shell.set_section(route.section ?? null);
    return true;
  });
}

start_theme();
void start_language().then(start);
