import { send, set_csrf } from "../lib/api.ts";
import { h, replace_children } from "../lib/dom.ts";
import { navigate, type PageContext } from "../lib/router.ts";
import type { Me } from "../lib/types.ts";
import { t } from "../lib/words.ts";
import { session } from "../session.ts";
import { run_once, text_field } from "../ui/parts.ts";
import { error_box } from "../ui/states.ts";

/** A path of this server; anything else leads to the cohort. */
export function safe_path(next: string | null): string {
  return next && /^\/(?![/\\])/.test(next) && !/^\/login/.test(next) ? next : "/";
}

export function login_page({ main, query, set_title }: PageContext): void {
  set_title(t("Sign in"));
  const name = text_field(t("Name"), { name: "username", autocomplete: "username", required: true, maxlength: "200" });
  const password = text_field(t("Password"), { name: "password", type: "password", autocomplete: "current-password", required: true, maxlength: "200" });
  const problem = h("div", {});
  const button = h("button", { type: "submit", class: "button button-primary button-wide" }, t("Sign in"));

  const submit = async (): Promise<void> => {
    name.set_error(name.input.value.trim() ? null : t("Enter your name."));
    password.set_error(password.input.value ? null : t("Enter your password."));
    const missing = [name, password].find((one) => one.input.hasAttribute("aria-invalid"));
    if (missing) {
      missing.input.focus();
      return;
    }
    replace_children(problem);
    try {
      const me = await send<Me>("POST", "/api/login", { name: name.input.value.trim(), password: password.input.value }, { without_session: true });
      session.me = me;
      set_csrf(me.csrf);
      navigate(safe_path(query.get("next")), true);
    } catch (error) {
      replace_children(problem, error_box(error));
      password.input.value = "";
      password.input.focus();
    }
  };
  const form = h("form", { novalidate: true, class: "form" }, name.element, password.element, problem, button);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void run_once(button, submit);
  });
  main.append(
    h(
      "div",
      { class: "narrow card" },
      h("h1", {}, t("Sign in")),
      query.has("expired") && h("p", { class: "notice", role: "status" }, t("You were signed out. Sign in to continue where you were.")),
      h("p", { class: "dim" }, t("Results of the needle training, for instructors.")),
      form,
    ),
  );
  name.input.focus();
}
