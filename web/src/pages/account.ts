// One's own account, its password; for administrators all accounts, and whether PINs are required.

import { get, send } from "../lib/api.ts";
import { h, new_id, replace_children, type Child } from "../lib/dom.ts";
import { said_words } from "../lib/format.ts";
import type { PageContext } from "../lib/router.ts";
import type { Account } from "../lib/types.ts";
import { t } from "../lib/words.ts";
import { is_admin, session } from "../session.ts";
import { ask } from "../ui/dialog.ts";
import { card, run_once, select_field, text_field, type TextField } from "../ui/parts.ts";
import { error_box, load_into, toast } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";

const password_help = (): string => t("12 to 128 characters. Not a common password, not the name.");

/** Role of an account. */
function role_text(role: string): string {
  return role === "admin" ? t("Administrator") : role === "instructor" ? t("Instructor") : said_words(role);
}

/** What is wrong with a new password before the server sees it; null if nothing is. */
export function password_problem(password: string, name: string): string | null {
  const length = [...password].length;
  if (length < 12) return t("Use at least 12 characters.");
  if (length > 128) return t("Use at most 128 characters.");
  return password.trim().toLocaleLowerCase() === name.trim().toLocaleLowerCase() ? t("The password must not be the name.") : null;
}

function focus_first_error(fields: TextField[]): boolean {
  const wrong = fields.find((one) => one.input.hasAttribute("aria-invalid"));
  wrong?.input.focus();
  return wrong !== undefined;
}

function submit_form(button: HTMLButtonElement, action: () => Promise<void>, ...children: Child[]): HTMLElement {
  const form = h("form", { class: "form", novalidate: true }, children, button);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void run_once(button, action);
  });
  return form;
}

function password_card(): HTMLElement {
  const old = text_field(t("Current password"), { type: "password", autocomplete: "current-password" });
  const fresh = text_field(t("New password"), { type: "password", autocomplete: "new-password" }, password_help());
  const again = text_field(t("New password again"), { type: "password", autocomplete: "new-password" });
  const problem = h("div", {});
  const fields = [old, fresh, again];
  const change = async (): Promise<void> => {
    replace_children(problem);
    old.set_error(old.input.value ? null : t("Enter your current password."));
    fresh.set_error(password_problem(fresh.input.value, session.me?.account.name ?? ""));
    again.set_error(again.input.value === fresh.input.value ? null : t("The two new passwords differ."));
    if (focus_first_error(fields)) return;
    try {
      await send("POST", "/api/password", { old: old.input.value, new: fresh.input.value });
      fields.forEach((one) => (one.input.value = ""));
      toast(t("The password was changed. Other browsers of this account were signed out."));
    } catch (error) {
      replace_children(problem, error_box(error));
    }
  };
  const button = h("button", { type: "submit", class: "button button-primary" }, t("Change password"));
  const name = h("input", { type: "text", autocomplete: "username", value: session.me?.account.name ?? "", hidden: true, readonly: true, "aria-hidden": "true", tabindex: "-1" });
  return card(t("Password"), {}, submit_form(button, change, name, old.element, fresh.element, again.element, problem));
}

function new_account_card(reload: () => void): HTMLElement {
  const name = text_field(t("Name"), { maxlength: "100" });
  const password = text_field(t("First password"), { type: "password", autocomplete: "new-password" }, password_help());
  const problem = h("div", {});
  let role = "instructor";
  const roles = select_field(t("Role"), ["instructor", "admin"].map((value) => ({ value, label: role_text(value) })), role, (value) => (role = value));
  const create = async (): Promise<void> => {
    replace_children(problem);
    name.set_error(name.input.value.trim() ? null : t("Enter a name."));
    password.set_error(password_problem(password.input.value, name.input.value));
    if (focus_first_error([name, password])) return;
    try {
      await send("POST", "/api/accounts", { name: name.input.value.trim(), password: password.input.value, role });
      toast(t("The account {0} was added.", name.input.value.trim()));
      name.input.value = password.input.value = "";
      reload();
    } catch (error) {
      replace_children(problem, error_box(error));
    }
  };
  return card(t("New account"), {}, submit_form(h("button", { type: "submit", class: "button button-primary" }, t("Add account")), create, name.element, roles, password.element, problem));
}

function reset_password(account: Account): void {
  const fresh = text_field(t("New password"), { type: "password", autocomplete: "new-password" }, password_help());
  const again = text_field(t("New password again"), { type: "password", autocomplete: "new-password" });
  ask({
    title: t("Reset the password of {0}", account.name),
    text: t("The person is signed out at once and signs in with the new password. Ask the person to change it then."),
    action: t("Reset password"),
    fields: [fresh.element, again.element],
    check: () => {
      fresh.set_error(password_problem(fresh.input.value, account.name));
      again.set_error(again.input.value === fresh.input.value ? null : t("The two new passwords differ."));
      return !fresh.input.hasAttribute("aria-invalid") && !again.input.hasAttribute("aria-invalid");
    },
    run: async () => {
      await send("PUT", `/api/accounts/${encodeURIComponent(account.name)}/password`, { password: fresh.input.value });
      toast(t("{0} has a new password.", account.name));
    },
  });
}

function show_pin_rule({ required }: { required: boolean }): Child {
  const id = new_id("pins");
  const box = h("input", { type: "checkbox", id, checked: required });
  const problem = h("div", {});
  box.addEventListener("change", () => {
    const wished = box.checked;
    replace_children(problem);
    send("PUT", "/api/pins", { required: wished }).then(
      () => toast(wished ? t("Every person now needs a PIN.") : t("PINs are now optional.")),
      (error: unknown) => {
        box.checked = !wished;
        replace_children(problem, error_box(error));
      },
    );
  });
  return [h("div", { class: "check" }, box, h("label", { for: id }, t("Every person needs a PIN at a station"))), h("p", { class: "help" }, t("A person without a PIN chooses one before the next attempt.")), problem];
}

function accounts_table(accounts: Account[], reload: () => void): HTMLElement {
  const remove = (account: Account): void =>
    ask({
      title: t("Delete the account {0}?", account.name),
      text: t("The person is signed out at once. No results are deleted."),
      action: t("Delete"),
      run: async () => {
        await send("DELETE", `/api/accounts/${encodeURIComponent(account.name)}`, {});
        toast(t("The account {0} was deleted.", account.name));
        reload();
      },
    });
  const is_own = (account: Account): boolean => account.name === session.me?.account.name;
  const columns: Column<Account>[] = [
    { name: "name", title: t("Name"), is_header: true, key: (one) => one.name, cell: (one) => one.name },
    { name: "role", title: t("Role"), key: (one) => one.role, cell: (one) => role_text(one.role) },
    {
      name: "password", title: t("Password"),
      cell: (one) => (is_own(one) ? h("span", { class: "dim" }, t("Your account")) : h("button", { type: "button", class: "button button-small", "aria-label": t("Reset the password of {0}", one.name), on: { click: () => reset_password(one) } }, t("Reset …"))),
    },
    {
      name: "delete", title: t("Delete"),
      cell: (one) => (is_own(one) ? h("span", { class: "dim" }, t("Your account")) : h("button", { type: "button", class: "button button-small", "aria-label": t("Delete the account {0}", one.name), on: { click: () => remove(one) } }, t("Delete …"))),
    },
  ];
  return data_table({ caption: t("Everybody who can sign in here"), columns, rows: accounts });
}

export async function account_page({ main, signal, set_title }: PageContext): Promise<void> {
  set_title(t("Account"));
  const account = session.me!.account;
  main.append(h("h1", {}, t("Account")), h("p", { class: "lead" }, account.role === "admin" ? t("{0}, administrator", account.name) : t("{0}, instructor", account.name)));
  const columns = h("div", { class: "two-columns" }, password_card());
  main.append(columns);
  if (!is_admin()) return;
  const place = h("div", {});
  const load = (): Promise<void> => load_into(place, signal, () => get<{ accounts: Account[] }>("/api/accounts", signal), ({ accounts }) => accounts_table(accounts, () => void load()));
  columns.append(new_account_card(() => void load()));
  const pins = h("div", {});
  main.append(card(t("Accounts"), {}, place), card(t("PINs of trainees"), {}, pins));
  await Promise.all([load(), load_into(pins, signal, () => get<{ required: boolean }>("/api/pins", signal), show_pin_rule)]);
}
