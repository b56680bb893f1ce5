// The instructor's pages in a browser: sign in, browse, replay, metrics, validity, questionnaire. With TROCAR_WEB_URL the
// same steps run against a real server; tests that need made-up data are skipped there.

import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import type { Browser, Page } from "playwright-core";
import { kHtmlName, kSqlName } from "../mock/cohort.ts";
import { busiest_person, has_count, login, open_page, real_url, settled, start_browser, start_site, type Site } from "./browser.ts";

const needs_mock = { skip: real_url ? "needs the data of the mock server" : false };
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

async function with_page(work: (page: Page) => Promise<void>, signed_in = true): Promise<void> {
  const { page, problems } = await open_page(browser, site);
  if (signed_in) await login(page);
  await work(page);
  assert.deepEqual(problems, []);
  await page.context().close();
}
const heading = (page: Page): Promise<string | null> => page.getByRole("heading", { level: 1 }).textContent();

describe("sign in", () => {
  test("a page without a session leads to the login and back to the page", () =>
    with_page(async (page) => {
      await page.goto("/validity");
      await page.waitForURL(/\/login\?next=%2Fvalidity/);
      await page.getByLabel("Name").fill(process.env.TROCAR_WEB_NAME ?? "Dr. Weber");
      await page.getByLabel("Password").fill(process.env.TROCAR_WEB_PASSWORD ?? "a long test password");
      await page.keyboard.press("Enter");
      await page.getByRole("heading", { level: 1, name: "Validity" }).waitFor();
      assert.match(page.url(), /\/validity/);
    }, false));

  test("a wrong password is said once for name and password", () =>
    with_page(async (page) => {
      await page.goto("/login");
      await page.getByLabel("Name").fill("nobody");
      await page.getByLabel("Password").fill("wrong password");
      await page.getByRole("button", { name: "Sign in" }).click();
      const alert = page.getByRole("alert");
      await alert.waitFor();
      assert.ok((await alert.textContent())!.length > 10);
      assert.equal(await page.getByLabel("Password").inputValue(), "");
      assert.match(page.url(), /\/login/);
    }, false));

  test("empty fields are named without a request", () =>
    with_page(async (page) => {
      await page.goto("/login");
      let requests = 0;
      page.on("request", (one) => (requests += one.url().endsWith("/api/login") ? 1 : 0));
      await page.getByRole("button", { name: "Sign in" }).click();
      await page.getByText("Enter your name.").waitFor();
      assert.equal(await page.getByLabel("Name").getAttribute("aria-invalid"), "true");
      assert.equal(requests, 0);
    }, false));

  test("signing out ends the session", () =>
    with_page(async (page) => {
      await page.getByRole("button", { name: "Sign out" }).click();
      await page.waitForURL(/\/login$/);
      await page.goto("/");
      await page.waitForURL(/\/login\?next/);
    }));
});

describe("browsing", () => {
  test("cohort, person, attempt, replay", () =>
    with_page(async (page) => {
      const person = await busiest_person(page);
      assert.equal(await heading(page), "Cohort");
      await page.locator(`table a[href="${person}"]`).click();
      await page.waitForURL(/\/people\//);
      await settled(page);
      await page.locator("table a[href^='/attempts/']").first().waitFor();
      const name = await heading(page);
      assert.equal(await page.title(), `${name} – Trocar`);
      await page.locator("table a[href^='/attempts/']").first().click();
      await page.waitForURL(/\/attempts\//);
      await settled(page);
      await page.getByRole("heading", { name: "Metrics compared with experts" }).waitFor();
      await page.goBack();
      await page.waitForURL(/\/people\//);
      await page.getByRole("heading", { level: 1, name: name! }).waitFor();
    }));

  test("search and filters stay in the address", () =>
    with_page(async (page) => {
      await page.getByRole("searchbox").fill("zzzz-nobody");
      await page.getByText("Nobody matches").waitFor();
      assert.match(page.url(), /search=zzzz-nobody/);
      await page.reload();
      await page.getByText("Nobody matches").waitFor();
      assert.equal(await page.getByRole("searchbox").inputValue(), "zzzz-nobody");
    }));

  test("a column is sorted by its header, and the direction is announced", () =>
    with_page(async (page) => {
      const header = page.getByRole("columnheader", { name: "Attempts" });
      await header.getByRole("button").click();
      assert.equal(await header.getAttribute("aria-sort"), "descending");
      const counts = (await page.locator("td[data-label='Attempts']").allTextContents()).map(Number);
      assert.ok(counts.length > 0);
      assert.deepEqual(counts, [...counts].sort((a, b) => b - a));
      await header.getByRole("button").click();
      assert.equal(await header.getAttribute("aria-sort"), "ascending");
    }));

  test("simulated people are marked, and can be filtered", needs_mock, () =>
    with_page(async (page) => {
      await page.getByLabel("Group").selectOption("simulated");
      await has_count(page.locator("tbody tr"), 14);
      await has_count(page.locator("tbody .badge-simulated"), 14);
      await page.getByLabel("Group").selectOption("people");
      await has_count(page.locator("tbody .badge-simulated"), 0);
    }));

  test("HTML and SQL in names are shown as text", needs_mock, () =>
    with_page(async (page) => {
      for (const name of [kHtmlName, kSqlName]) {
        await page.goto("/");
        await page.getByRole("link", { name, exact: true }).click();
        await page.getByRole("heading", { level: 1, name, exact: true }).waitFor();
        await settled(page);
      }
      await page.goto("/");
      await settled(page);
      await has_count(page.locator("main img"), 0);
      await has_count(page.locator("main b"), 0);
      assert.equal(await page.title(), "Cohort – Trocar");
    }));

  test("older attempts are loaded page by page without a gap", needs_mock, () =>
    with_page(async (page) => {
      const person = site.mock!.results.people.find((one) => site.mock!.results.attempts.filter((a) => a.person === one.id && a.task === "liver-biopsy").length > 50)!;
      const count = site.mock!.results.attempts.filter((one) => one.person === person.id && one.task === "liver-biopsy").length;
      await page.goto(`/people/${person.id}?task=liver-biopsy`);
      await settled(page);
      await page.getByRole("button", { name: "Older attempts" }).click();
      await page.waitForFunction((expected) => document.querySelectorAll("table[role=table] tbody tr").length === expected, count);
      const paths = await page.locator("table a[href^='/attempts/']").evaluateAll((all) => all.map((one) => one.getAttribute("href")));
      assert.equal(new Set(paths).size, count);
      await has_count(page.getByRole("button", { name: "Older attempts" }), 0);
    }));

  test("the learning curve has a text and a table with one row an attempt", needs_mock, () =>
    with_page(async (page) => {
      const person = site.mock!.results.people[3];
      const count = site.mock!.results.attempts.filter((one) => one.person === person.id && one.task === "liver-biopsy" && one.passed !== null).length;
      await page.goto(`/people/${person.id}?task=liver-biopsy`);
      const plot = page.getByRole("img", { name: /^Score by attempt/ });
      assert.match((await plot.getAttribute("aria-label"))!, new RegExp(`${count} attempts; moving mean now \\d+ of 100`));
      await page.getByText("Values as a table").first().click();
      await has_count(page.getByRole("region", { name: "Scores by attempt" }).locator("tbody tr"), count);
      await plot.locator("canvas").waitFor();
    }));

  test("metrics: another metric gives another distribution", () =>
    with_page(async (page) => {
      await page.goto("/metrics");
      await settled(page);
      const choice = page.getByLabel("Metric");
      const titles = await choice.locator("option").allTextContents();
      assert.ok(titles.length > 1);
      for (const title of titles.slice(0, 2)) {
        await choice.selectOption({ label: title });
        await page.getByRole("heading", { level: 2, name: title, exact: true }).waitFor();
        await page.locator(".histogram svg").first().waitFor();
      }
      assert.match(page.url(), /metric=/);
    }));

  test("validity: three figures and the table; simulated data are said to be simulated", () =>
    with_page(async (page) => {
      await page.goto("/validity");
      await settled(page);
      for (const name of ["Metrics that separate experts from novices", "Internal consistency", "Pass mark"]) await page.getByRole("heading", { name }).waitFor();
      if (site.mock) {
        await page.getByLabel("Task").selectOption("liver-biopsy");
        await page.getByText("they say nothing about people").waitFor();
        await has_count(page.locator("tbody tr"), 15);
        await page.getByLabel("Task").selectOption("ptcd");
        await page.getByText("Fewer than 30 scored attempts.").first().waitFor();
      }
    }));

  test("validity of a case and a level stays in the address", needs_mock, () =>
    with_page(async (page) => {
      await page.goto("/validity?task=liver-biopsy");
      await settled(page);
      await page.getByLabel("Case").selectOption("biopsy-2");
      await page.waitForURL(/patient=biopsy-2/);
      await settled(page);
      await page.getByLabel("Level of help").selectOption("exam");
      await page.waitForURL(/level=exam/);
      await settled(page);
      assert.equal(await page.getByLabel("Case").inputValue(), "biopsy-2");
      await page.getByLabel("Task").selectOption("ptcd");
      await page.waitForURL((url) => !url.search.includes("patient"));
    }));

  test("proficiency counts people who are not there yet, and the minutes of their instructors", () =>
    with_page(async (page) => {
      await page.goto("/proficiency");
      await settled(page);
      for (const name of ["Attempts to proficiency", "First-pass success", "Time to the target", "Time of instructors"]) await page.getByRole("heading", { name }).first().waitFor();
      await page.getByText("None entered", { exact: true }).first().waitFor();
      await page.getByRole("columnheader", { name: "Attempts to proficiency" }).first().waitFor();
      if (site.mock) await page.getByText("Not yet").first().waitFor();
    }));

  test("attempts without a result are not passed", needs_mock, () =>
    with_page(async (page) => {
      const one = site.mock!.results.attempts.find((attempt) => attempt.state === "unscored" && attempt.task === "liver-biopsy")!;
      await page.goto(`/people/${one.person}?task=liver-biopsy`);
      await settled(page);
      await page.getByText(/attempts counted \(\d+ ended without a result\)/).first().waitFor();
      await page.goto(`/attempts/${one.id}`);
      await settled(page);
      await page.getByText("Not passed: no result").first().waitFor();
    }));

  test("an unknown page and an unknown attempt have a clear end", () =>
    with_page(async (page) => {
      await page.goto("/no/such/page");
      assert.equal(await heading(page), "Page not found");
      for (const [path, title] of [["/attempts/", "There is no such attempt"], ["/people/", "There is no such person"], ["/forms/", "There is no such questionnaire"], ["/course?name=", "There is no such course"]]) {
        await page.goto(`${path}${"0".repeat(32)}`);
        await page.getByRole("heading", { level: 1, name: title }).waitFor();
        await page.getByRole("alert").getByRole("link", { name: /^Go to the/ }).waitFor();
        await has_count(page.getByRole("button", { name: "Try again" }), 0);
      }
    }));
});

describe("replay", () => {
  async function open_replay(page: Page): Promise<void> {
    const attempt = site.mock!.results.attempts.find((one) => one.task === "liver-biopsy" && one.state === "finished")!;
    await page.goto(`/attempts/${attempt.id}`);
    await settled(page);
    await page.getByRole("slider").waitFor();
  }
  const time = async (page: Page): Promise<number> => Number(await page.getByRole("slider").inputValue());

  test("Space plays and pauses, arrows step, Home and End jump", needs_mock, () =>
    with_page(async (page) => {
      await open_replay(page);
      const group = page.getByRole("group", { name: /^Replay/ });
      await group.focus();
      await page.keyboard.press("ArrowRight");
      assert.ok(Math.abs((await time(page)) - 0.2) < 0.021);
      await page.keyboard.press("Shift+ArrowRight");
      assert.ok(Math.abs((await time(page)) - 1.2) < 0.021);
      await page.keyboard.press("ArrowLeft");
      assert.ok(Math.abs((await time(page)) - 1.0) < 0.021);
      await page.keyboard.press("End");
      const end = await time(page);
      assert.ok(end > 20);
      await page.keyboard.press("Home");
      assert.equal(await time(page), 0);
      await page.keyboard.press("Space");
      await page.getByRole("button", { name: "Pause" }).waitFor();
      await page.waitForFunction(() => Number((document.querySelector("input[type=range]") as HTMLInputElement).value) > 0.2);
      await page.keyboard.press("Space");
      await page.getByRole("button", { name: "Play" }).waitFor();
      const stopped = await time(page);
      await page.keyboard.press("ArrowRight");
      assert.ok((await time(page)) > stopped);
    }));

  test("an event moves the replay to its time, and the words follow", needs_mock, () =>
    with_page(async (page) => {
      await open_replay(page);
      const before = await page.locator(".now").textContent();
      const event = page.locator(".event").last();
      await event.click();
      const [minutes, seconds] = (await event.locator(".event-time").textContent())!.split(":").map(Number);
      assert.ok(Math.abs((await time(page)) - (60 * minutes + seconds)) < 0.15);
      const now = await page.locator(".now").textContent();
      assert.match(now!, /^Depth [\d.]+ mm · resistance −?[\d.]+ N · \w+/);
      assert.notEqual(now, before);
    }));

  test("the pictures change with the time, and a click in a plot sets it", needs_mock, () =>
    with_page(async (page) => {
      await open_replay(page);
      const picture = (): Promise<string> => page.locator(".path-view canvas").first().evaluate((one: HTMLCanvasElement) => one.toDataURL());
      const start = await picture();
      const plot = page.locator(".replay-plots .u-over").first();
      const box = (await plot.boundingBox())!;
      await plot.click({ position: { x: box.width * 0.75, y: 20 } });
      const end = Number(await page.getByRole("slider").getAttribute("max"));
      assert.ok(Math.abs((await time(page)) / end - 0.75) < 0.02);
      assert.notEqual(await picture(), start);
    }));

  test("the 3D view is turned by keys and by buttons without moving the time", needs_mock, () =>
    with_page(async (page) => {
      await open_replay(page);
      const canvas = page.locator("canvas.is-turnable");
      const picture = (): Promise<string> => canvas.evaluate((one: HTMLCanvasElement) => one.toDataURL());
      const first = await picture();
      await canvas.focus();
      await page.keyboard.press("ArrowLeft");
      const second = await picture();
      assert.notEqual(second, first);
      assert.equal(await time(page), 0);
      await page.getByRole("button", { name: "Turn right" }).click();
      assert.equal(await picture(), first);
    }));
});
