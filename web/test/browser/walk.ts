// Every page of a site, and what axe finds on one.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import type { Page } from "playwright-core";
import { busiest_person, first_link, kName, kPassword, settled } from "./browser.ts";

/** Paths of every kind of page. Somebody has to be signed in. */
export async function every_path(page: Page): Promise<string[]> {
  const person = await busiest_person(page);
  await page.goto(person);
  await page.locator("table a[href^='/attempts/']").first().waitFor({ state: "attached" });
  const attempt = await first_link(page, "/attempts/");
  await page.goto("/forms");
  await settled(page);
  const paths = ["/", "/?task=liver-biopsy", person, attempt, "/courses", "/course", "/metrics", "/validity", "/proficiency", "/forms", "/forms/new", "/account", "/no/such/page", `/people/${"0".repeat(32)}`, `/attempts/${"0".repeat(32)}`];
  const forms = await page.locator("table a[href^='/forms/']").count();
  if (forms > 0) {
    const form = await first_link(page, "/forms/");
    await page.goto(form);
    await settled(page);
    paths.push(form, `${form}/edit`);
    const address = page.locator(".address input");
    if (await address.isVisible()) paths.push(new URL(await address.inputValue()).pathname);
  }
  return paths;
}

/** Signs in whatever the language is. */
export async function login_anyhow(page: Page): Promise<void> {
  await page.goto("/login");
  await page.locator("input[autocomplete=username]").fill(kName);
  await page.locator("input[autocomplete=current-password]").fill(kPassword);
  await page.keyboard.press("Enter");
  await page.waitForURL((url) => url.pathname !== "/login");
  await settled(page);
}

const axe_source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
interface AxeResult {
  violations: { id: string; help: string; nodes: { target: unknown[]; failureSummary?: string }[] }[];
}
/** Violations of WCAG 2.2 A and AA. The source is given to the debugger, so that the page's policy stays as it is. */
export async function violations(page: Page): Promise<string[]> {
  const debugger_session = await page.context().newCDPSession(page);
  await debugger_session.send("Runtime.evaluate", { expression: axe_source });
  const { result } = await debugger_session.send("Runtime.evaluate", {
    expression: `axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"], rules: { "label-content-name-mismatch": { enabled: true } }, resultTypes: ["violations"] }).then((one) => JSON.stringify(one))`,
    awaitPromise: true, returnByValue: true,
  });
  const found = JSON.parse(result.value as string) as AxeResult;
  return found.violations.flatMap((one) => one.nodes.map((node) => `${one.id}: ${one.help}: ${String(node.target)} ${node.failureSummary ?? ""}`));
}
