// The page in German: chosen by the browser or in the head, without English texts, cut texts or violations of WCAG, at two sizes.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import type { Browser, Page } from "playwright-core";
import { login, open_page, real_url, settled, start_browser, start_site, type Site } from "./browser.ts";
import { every_path, login_anyhow, violations } from "./walk.ts";

const needs_mock = { skip: real_url ? "needs the mock server" : false };
const web = fileURLToPath(new URL("../../../", import.meta.url));
const read = (...path: string[]): { texts: Record<string, string>; server?: Record<string, string> } => {
  const file = join(web, ...path);
  return existsSync(file) ? JSON.parse(readFileSync(file, "utf8")) : { texts: {} };
};
const page_words = read("src", "words", "de.json");
const all_words: Record<string, string> = { ...page_words.server, ...read("..", "data", "language", "de.json").texts, ...page_words.texts };
/** Texts whose German differs. */
const english = Object.keys(all_words).filter((one) => all_words[one] !== one && /\p{L}{2}/u.test(one));
/** What people wrote stays as it is. */
const kGiven = ["What should be improved?", "The images and the body look realistic.", "The forces at the needle feel realistic."];

let browser: Browser;
let site: Site;
before(async () => {
  site = await start_site();
  browser = await start_browser();
});
after(async () => {
  await browser?.close();
  await site?.stop();
});

/** Texts and labels that are English ones of the dictionaries. */
async function english_texts(page: Page): Promise<string[]> {
  return page.evaluate(
    ({ known, given }) => {
      const keys = new Set(known);
      const found: string[] = [];
      const look = (text: string | null, where: string): void => {
        const one = (text ?? "").trim().replace(/\s+/g, " ");
        if (keys.has(one) && !given.includes(one)) found.push(`${where}: ${one}`);
      };
      const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
      for (let node = walker.nextNode(); node; node = walker.nextNode()) {
        const parent = node.parentElement!;
        if (!parent.closest("[lang=en], noscript")) look(node.textContent, parent.tagName);
      }
      for (const one of document.querySelectorAll("[aria-label], [title], [placeholder], [data-label]")) {
        for (const name of ["aria-label", "title", "placeholder", "data-label"]) look(one.getAttribute(name), `${one.tagName} ${name}`);
      }
      look(document.title.replace(/ – Trocar$/, ""), "title");
      return [...new Set(found)];
    },
    { known: english, given: kGiven },
  );
}

/** Visible texts that reach out of their own box, or that a box around them cuts off. */
async function cut_texts(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const found: string[] = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const text = node.textContent!.trim();
      const own = node.parentElement!;
      let is_for_readers = false;
      for (let at: Element | null = own; at && !is_for_readers; at = at.parentElement) is_for_readers = getComputedStyle(at).clipPath !== "none";
      if (is_for_readers || !text || own.closest(".hidden, .skip, option, noscript, svg, .scroll, [aria-hidden=true]") || !own.checkVisibility()) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      const box = range.getBoundingClientRect();
      if (box.width < 2 || box.height < 2) continue;
      for (let at: Element | null = own; at && at !== document.body; at = at.parentElement) {
        const style = getComputedStyle(at);
        const is_closed = style.overflowX !== "visible";
        if (style.display === "inline" || (!is_closed && !at.matches("button, .button, .badge, .nav-link, .card, th, td, label, dd, dt"))) continue;
        if (at.matches(".account-name") || style.overflowX === "auto") break;  // ends with … on purpose; can be scrolled
        const around = at.getBoundingClientRect();
        if (box.right > around.right + 1.5 || box.left < around.left - 1.5 || (is_closed && box.bottom > around.bottom + 2)) {
          found.push(`${at.tagName}.${at.getAttribute("class") ?? ""}: ${text.slice(0, 60)} (${Math.round(box.left)}–${Math.round(box.right)} of ${Math.round(around.left)}–${Math.round(around.right)})`);
          break;
        }
      }
    }
    for (const one of document.querySelectorAll<HTMLElement>("button, .button, .nav-link, select")) {
      if (one.checkVisibility() && !one.closest("thead") && one.scrollWidth > one.clientWidth + 1 && !one.matches("select")) found.push(`${one.tagName} ${one.textContent} is ${one.scrollWidth} wide in ${one.clientWidth}`);
    }
    return [...new Set(found)];
  });
}

for (const [width, height] of [[1280, 800], [390, 844]] as const) {
  test(`every page in German at ${width}×${height}`, needs_mock, async () => {
    const { page, problems } = await open_page(browser, site, { width, height, locale: "de-DE", touch: width < 600 });
    const found: string[] = [];
    const look = async (name: string): Promise<void> => {
      assert.equal(await page.evaluate(() => document.documentElement.lang), "de");
      for (const one of await english_texts(page)) found.push(`${name} is English: ${one}`);
      for (const one of await cut_texts(page)) found.push(`${name} is cut: ${one}`);
      for (const one of await violations(page)) found.push(`${name} axe: ${one}`);
      const [wide, view] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
      if (wide > view) found.push(`${name} is ${wide} px wide`);
    };
    await page.goto("/login?expired=1");
    await settled(page);
    await page.locator("form button").click();
    await look("/login");
    await login_anyhow(page);
    if (width > 1200) {
      // The narrowest window with the whole navigation, and a long name.
      await page.setViewportSize({ width: 1201, height });
      await page.evaluate(() => (document.querySelector(".account-name")!.textContent = "Prof. Dr. Karoline von Hohenstein-Großmann"));
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 1201 && document.querySelector(".head-choices")!.getBoundingClientRect().right <= 1201));
      await page.setViewportSize({ width, height });
    } else {
      await page.locator(".menu-button").click();
      await look("menu");
    }
    for (const path of await every_path(page)) {
      await page.goto(path);
      await settled(page);
      await page.evaluate(() => document.querySelectorAll("details").forEach((one) => (one.open = true)));
      await page.waitForTimeout(250);
      await look(path);
    }
    assert.deepEqual(found, []);
    assert.deepEqual(problems, []);
    await page.context().close();
  });
}

test("dialogs in German", needs_mock, async () => {
  const { page } = await open_page(browser, site, { width: 390, height: 844, locale: "de-AT" });
  await login_anyhow(page);
  const person = site.mock!.results.people.find((one) => one.name === "Amara Osei")!;
  const openers = { "/": ["Kurs zuordnen …", "Person hinzufügen …"], [`/people/${person.id}`]: ["Umbenennen oder zuordnen …", "PIN festlegen …", "Person löschen …"], "/account": ["Zurücksetzen …"] };
  for (const [path, names] of Object.entries(openers)) {
    await page.goto(path);
    await settled(page);
    await page.evaluate(() => document.querySelectorAll("details").forEach((one) => (one.open = true)));
    for (const name of names) {
      await (name === "Zurücksetzen …" ? page.getByText(name) : page.getByRole("button", { name })).first().click();
      const dialog = page.getByRole("dialog");
      for (const field of await dialog.locator("input[type=text]").all()) await field.fill("");
      await dialog.locator("button[type=submit]").click();
      await dialog.locator(".field-error:not(:empty)").first().waitFor();
      assert.deepEqual([...(await english_texts(page)), ...(await cut_texts(page)), ...(await violations(page))], [], name);
      await dialog.getByRole("button", { name: "Abbrechen" }).click();
      await dialog.waitFor({ state: "detached" });
    }
  }
  await page.context().close();
});

describe("the choice of the language", () => {
  test("English browsers see English and load no other language", async () => {
    const { page } = await open_page(browser, site, { locale: "en-GB" });
    const files: string[] = [];
    page.on("request", (request) => files.push(request.url()));
    await login(page);
    assert.equal(await page.evaluate(() => document.documentElement.lang), "en");
    assert.deepEqual(files.filter((one) => /-de-/.test(one)), []);
    await page.context().close();
  });

  test("by keyboard, at once, kept after a reload and after signing out; numbers follow, exports do not", async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    await page.goto("/metrics?task=liver-biopsy");
    await page.locator(".auc").waitFor();
    assert.match((await page.locator(".auc").textContent())!, /0\.\d\d/);
    const choice = page.getByRole("combobox", { name: "Language" });
    await choice.focus();
    await page.keyboard.press("d");
    await page.waitForFunction(() => document.documentElement.lang === "de");
    await page.getByRole("heading", { level: 1, name: "Messgrößen" }).waitFor();
    await page.locator(".auc").waitFor();
    assert.match((await page.locator(".auc").textContent())!, /0,\d\d/);
    assert.equal(await page.evaluate(() => document.activeElement?.getAttribute("aria-label")), "Sprache");
    await page.reload();
    await page.getByRole("heading", { level: 1, name: "Messgrößen" }).waitFor();
    const csv = await page.evaluate(async () => (await fetch("/api/export/attempts.csv")).text());
    assert.match(csv, /^attempt,person/);
    await page.getByRole("button", { name: "Abmelden" }).click();
    await page.getByRole("heading", { level: 1, name: "Anmelden" }).waitFor();
    assert.equal(await page.evaluate(() => localStorage.getItem("trocar-language")), "de");
    await page.getByRole("combobox", { name: "Sprache" }).selectOption("en");
    await page.getByRole("heading", { level: 1, name: "Sign in" }).waitFor();
    await page.context().close();
  });

  test("unsent answers outlive it", needs_mock, async () => {
    const { page } = await open_page(browser, site, { locale: "de" });
    await page.goto("/q/test-token-1-abcdefghijklmnop");
    await page.getByRole("radio").nth(2).check({ force: true });
    await page.getByText("noch 2000 Zeichen").waitFor();
    await page.getByRole("combobox", { name: "Sprache" }).selectOption("en");
    await page.getByRole("button", { name: "Send answers" }).waitFor();
    assert.equal(await page.getByRole("radio").nth(2).isChecked(), true);
    await page.context().close();
  });

  test("a language that cannot be loaded leaves English, and a message of the server is translated", needs_mock, async () => {
    const broken = await open_page(browser, site, { locale: "de" });
    await broken.page.route("**/assets/words-de-*", (route) => route.abort());
    await broken.page.goto("/login");
    await broken.page.getByRole("heading", { level: 1, name: "Sign in" }).waitFor();
    await broken.page.context().close();
    const { page } = await open_page(browser, site, { locale: "de" });
    await page.goto("/login");
    await page.getByLabel("Name").fill("nobody");
    await page.getByLabel("Passwort").fill("x");
    await page.keyboard.press("Enter");
    await page.getByRole("alert").filter({ hasText: "Name oder Passwort ist falsch" }).waitFor();
    await page.context().close();
  });
});
