// Every page: WCAG 2.2 AA by axe in both themes, no horizontal scrolling at 360 px, keyboard, errors, expired session.

import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { kPolicy } from "../mock/server.ts";
import { first_link, has_count, kName, kPassword, login, open_page, real_url, settled, start_browser, start_site, type Site } from "./browser.ts";
import { every_path, violations } from "./walk.ts";

const needs_mock = { skip: real_url ? "needs the mock server" : false };
let browser: Browser;
let site: Site;
let paths: string[] = [];

before(async () => {
  site = await start_site();
  browser = await start_browser();
  const { page } = await open_page(browser, site);
  await login(page);
  paths = await every_path(page);
  await page.context().close();
});
after(async () => {
  await browser?.close();
  await site?.stop();
});

// Each page is loaded once, then seen in each theme and width: loading takes most of the time.
const looks = real_url ? [["light", 360]] as const : [["dark", 1280], ["light", 1280], ["light", 360]] as const;

test("no page has a violation that axe finds", async () => {
  const { page, problems } = await open_page(browser, site, { theme: looks[0][0], width: looks[0][1] });
  const look = async (name: string): Promise<void> => {
    for (const [theme, width] of looks) {
      await page.emulateMedia({ colorScheme: theme });
      await page.setViewportSize({ width, height: 900 });
      await page.waitForTimeout(150);
      assert.deepEqual(await violations(page), [], `${name} in ${theme} at ${width}`);
    }
  };
  await page.goto("/login");
  await settled(page);
  await look("/login");
  await page.goto("/login?next=%2F&expired=1");
  await settled(page);
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByText("Enter your name.").waitFor();
  await look("/login with errors");
  await login(page);
  for (const path of paths) {
    await page.goto(path);
    await settled(page);
    await look(path);
  }
  assert.deepEqual(problems, []);
  await page.context().close();
});

test("no page scrolls sideways, from 320 px on", async () => {
  const { page } = await open_page(browser, site, { width: 1024, height: 740, touch: true });
  await login(page);
  for (const path of paths) {
    await page.goto(path);
    await settled(page);
    for (const width of [1024, 880, 768, 360, 320]) {
      await page.setViewportSize({ width, height: 740 });
      await page.waitForTimeout(150);
      const [wide, view] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
      const beyond = await page.evaluate(() => [...document.querySelectorAll("main *")].filter((one) => one.getBoundingClientRect().right > document.documentElement.clientWidth && !one.closest(".scroll")).map((one) => `${one.tagName}.${one.getAttribute("class")}`));
      assert.ok(wide <= view, `${path}: ${wide} px wide in a window of ${view} px: ${beyond.slice(0, 5)}`);
    }
  }
  await page.context().close();
});

test("long pages are folded on a phone: at most three screens before anything is opened", async () => {
  const { page } = await open_page(browser, site, { width: 390, height: 844, touch: true });
  await login(page);
  for (const path of paths.filter((one) => /^\/(attempts|validity|people)/.test(one))) {
    await page.goto(path);
    await settled(page);
    await page.waitForTimeout(150);
    const tall = await page.evaluate(() => document.documentElement.scrollHeight);
    assert.ok(tall <= 3.2 * 844, `${path}: ${tall} px`);
  }
  await page.context().close();
});

test("buttons and choices are at least 24 px high and wide on a phone, answers 44 px", async () => {
  const { page } = await open_page(browser, site, { width: 360, height: 740, touch: true });
  await login(page);
  for (const path of paths) {
    await page.goto(path);
    await settled(page);
    const small = await page.evaluate((is_public) => {
      const least = is_public ? 44 : 24;
      return [...document.querySelectorAll<HTMLElement>("main button, main select, main .button, .scale-choice label")]
        .filter((one) => one.offsetParent !== null && (!is_public || one.matches(".scale-choice label, button")))
        .filter((one) => one.getBoundingClientRect().height < least || one.getBoundingClientRect().width < least)
        .map((one) => `${one.textContent} ${one.getBoundingClientRect().width}x${one.getBoundingClientRect().height}`);
    }, path.startsWith("/q/"));
    assert.deepEqual(small, [], path);
  }
  await page.context().close();
});

describe("keyboard", () => {
  test("sign in, skip link, menu of a phone, sorting and opening a person need no mouse", async () => {
    const { page } = await open_page(browser, site, { width: 360, height: 740 });
    await page.goto("/login");
    await page.getByLabel("Name").waitFor();
    await page.keyboard.type(kName);
    await page.keyboard.press("Tab");
    await page.keyboard.type(kPassword);
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { level: 1, name: "Cohort" }).waitFor();
    await settled(page);
    await page.goto("/");
    await settled(page);
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement?.textContent), "Skip to content");
    await page.keyboard.press("Enter");
    assert.equal(await page.evaluate(() => document.activeElement?.id), "content");
    const menu = page.getByRole("button", { name: "Menu" });
    await menu.focus();
    await page.keyboard.press("Enter");
    assert.equal(await menu.getAttribute("aria-expanded"), "true");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await page.waitForURL(/\/courses/);
    assert.equal(await menu.getAttribute("aria-expanded"), "false");
    await page.waitForFunction(() => document.activeElement?.tagName === "H1");
    await page.context().close();
  });

  test("every control that has the focus shows it", async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    for (let k = 0; k < 25; k += 1) {
      await page.keyboard.press("Tab");
      const seen = await page.evaluate(() => {
        const one = document.activeElement as HTMLElement;
        if (one === document.body) return "";
        const style = getComputedStyle(one);
        return style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2 ? "" : `${one.tagName} ${one.textContent}`;
      });
      assert.equal(seen, "");
    }
    await page.context().close();
  });
});

describe("errors", () => {
  test("a session that expires leads to the login and back to the same page", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    await page.goto("/metrics?task=ptcd");
    await settled(page);
    site.mock!.expire_sessions();
    await page.getByLabel("Task").selectOption("lumbar-puncture");
    await page.getByText("You were signed out").waitFor();
    await page.getByLabel("Name").fill(kName);
    await page.getByLabel("Password").fill(kPassword);
    await page.keyboard.press("Enter");
    await page.waitForURL(/\/metrics\?/);
    await page.getByRole("heading", { level: 1, name: "Metrics" }).waitFor();
    await page.context().close();
  });

  test("500 and 429 are shown with the server's words, and a retry helps", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    for (const status of [500, 429]) {
      site.mock!.fail_next("/api/overview", status, status === 429 ? { "Retry-After": "12" } : {});
      await page.goto("/");
      const alert = page.getByRole("alert");
      await alert.filter({ hasText: `failure ${status} for the test` }).waitFor();
      assert.match((await alert.textContent())!, /advice for the test/i);
      if (status === 429) assert.match((await alert.textContent())!, /Try again in 12 s/);
      await page.getByRole("button", { name: "Try again" }).click();
      await page.locator("tbody tr").first().waitFor();
    }
    await page.context().close();
  });

  test("too many failed logins say when the next is possible", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await page.goto("/login");
    site.mock!.fail_next("/api/login", 429, { "Retry-After": "30" });
    await page.getByLabel("Name").fill("x");
    await page.getByLabel("Password").fill("y");
    await page.keyboard.press("Enter");
    await page.getByRole("alert").filter({ hasText: "Try again in 30 s" }).waitFor();
    await page.context().close();
  });

  test("a server that does not answer is said so", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    await page.route("**/api/overview", (route) => route.abort());
    await page.goto("/");
    await page.getByRole("alert").filter({ hasText: "The server does not answer" }).waitFor();
    await page.context().close();
  });
});

describe("deletion", () => {
  test("a person is deleted only after the name was typed", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    const person = site.mock!.results.people.find((one) => one.name === "Hiroshi Tanaka")!;
    await page.goto(`/people/${person.id}`);
    await settled(page);
    await page.getByRole("button", { name: "Delete person …" }).click();
    const dialog = page.getByRole("dialog");
    await dialog.getByRole("button", { name: "Delete" }).click();
    await dialog.getByText("Type exactly: Hiroshi Tanaka").waitFor();
    assert.ok(site.mock!.results.people.includes(person));
    await dialog.getByLabel(/Type the name/).fill("Hiroshi Tanaka");
    await dialog.getByRole("button", { name: "Delete" }).click();
    await page.getByRole("heading", { level: 1, name: "Cohort" }).waitFor();
    await settled(page);
    await has_count(page.getByRole("link", { name: "Hiroshi Tanaka" }), 0);
    await page.context().close();
  });
});

test("an instructor sees neither accounts nor deletion", needs_mock, async () => {
  const { page } = await open_page(browser, site);
  await login(page, "instructor", "another long password");
  await page.goto(await first_link(page, "/people/"));
  await settled(page);
  await has_count(page.getByRole("button", { name: "Delete person …" }), 0);
  await page.goto("/account");
  await settled(page);
  await has_count(page.getByRole("heading", { name: "Accounts" }), 0);
  await page.context().close();
});

test("the page works under the server's policy", async () => {
  const answer = await fetch(site.url);
  if (site.mock) assert.equal(answer.headers.get("content-security-policy"), kPolicy);
  const text = await answer.text();
  assert.doesNotMatch(text, /<script(?![^>]*src=)|style=|https?:\/\//);
});
