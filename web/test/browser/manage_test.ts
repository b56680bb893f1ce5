// What instructors change: people, courses, PINs, notes, passwords; and what must not be lost on the way.

import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import type { Browser, Page } from "playwright-core";
import { has_count, login, open_page, real_url, settled, start_browser, start_site, type Site } from "./browser.ts";

const needs_mock = { skip: real_url ? "needs the mock server" : false };
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

async function with_page(work: (page: Page) => Promise<void>, name?: string, password?: string): Promise<void> {
  const { page, problems } = await open_page(browser, site);
  await login(page, name, password);
  await work(page);
  assert.deepEqual(problems, []);
  await page.context().close();
}
const dialog_button = (page: Page, name: string): Promise<void> => page.getByRole("dialog").getByRole("button", { name, exact: true }).click();

describe("people and courses", () => {
  test("a person is added to a new course, renamed, moved, and gets a PIN", () =>
    with_page(async (page) => {
      const name = `Added ${process.pid}`;
      await page.getByRole("button", { name: "Add person …" }).click();
      await dialog_button(page, "Add");
      await page.getByRole("dialog").getByText("Enter a name.").waitFor();
      await page.getByRole("dialog").getByLabel("Name").fill(name);
      await page.getByRole("dialog").getByLabel("Course").fill("Course of the test");
      await dialog_button(page, "Add");
      await page.getByRole("heading", { level: 1, name }).waitFor();
      await settled(page);
      await page.getByText("Course: Course of the test. This person has no PIN.").waitFor();

      await page.getByRole("button", { name: "Rename or move …" }).click();
      await page.getByRole("dialog").getByLabel("Name").fill(`${name} renamed`);
      await page.getByRole("dialog").getByLabel("Course").fill("");
      await dialog_button(page, "Save");
      await page.getByRole("heading", { level: 1, name: `${name} renamed` }).waitFor();
      await page.getByText("Course: none.").waitFor();

      await page.getByRole("button", { name: "Set PIN …" }).click();
      await page.getByRole("dialog").getByLabel("New PIN (4 to 12 digits)").fill("12");
      await dialog_button(page, "Save");
      await page.getByRole("dialog").getByText("Enter 4 to 12 digits.").waitFor();
      await page.getByRole("dialog").getByLabel("New PIN (4 to 12 digits)").fill("4711");
      await page.getByRole("dialog").getByLabel("New PIN again").fill("4711");
      await dialog_button(page, "Save");
      await page.getByText("This person has a PIN.").waitFor();
      await page.getByRole("button", { name: "Remove PIN …" }).click();
      await dialog_button(page, "Remove");
      await page.getByText("This person has no PIN.").waitFor();

      await page.getByRole("button", { name: "Delete person …" }).click();
      await page.getByRole("dialog").getByLabel(/Type the name/).fill(`${name} renamed`);
      await dialog_button(page, "Delete");
      await page.getByRole("heading", { level: 1, name: "Cohort" }).waitFor();
    }));

  test("a name that another person has is refused with the server's words", needs_mock, () =>
    with_page(async (page) => {
      await page.getByRole("button", { name: "Add person …" }).click();
      await page.getByRole("dialog").getByLabel("Name").fill("chen wei");
      await dialog_button(page, "Add");
      await page.getByRole("dialog").getByRole("alert").filter({ hasText: "another person has this name" }).waitFor();
    }));

  test("chosen people move together", needs_mock, () =>
    with_page(async (page) => {
      await page.getByRole("button", { name: "Move people …" }).click();
      await dialog_button(page, "Move");
      await page.getByText("Choose at least one person.").waitFor();
      for (const name of ["Chen Wei", "Daniela Rossi"]) await page.getByRole("dialog").getByLabel(name).check();
      await page.getByRole("dialog").getByText(/^2 of \d+ people chosen$/).waitFor();
      await page.getByRole("dialog").getByRole("combobox", { name: "Course", exact: true }).fill("Moved together");
      await dialog_button(page, "Move");
      await page.getByText("Moved to Moved together: 2 people.").waitFor();
      await settled(page);
      await page.locator(".filters").getByLabel("Course").selectOption("Moved together");
      await has_count(page.locator("tbody tr"), 2);
    }));

  test("courses are compared, one is opened and renamed", needs_mock, () =>
    with_page(async (page) => {
      await page.goto("/courses");
      await settled(page);
      await page.getByRole("link", { name: "Hepatology course, autumn" }).click();
      await page.getByRole("heading", { level: 1, name: "Hepatology course, autumn" }).waitFor();
      await settled(page);
      for (const name of ["Scores", "Tasks", "Trainees"]) await page.getByRole("heading", { level: 2, name, exact: true }).waitFor();
      const trainees = site.mock!.results.people.filter((one) => one.course === "Hepatology course, autumn" && one.group === "trainee").length;
      await page.locator("dt", { hasText: /^Trainees$/ }).locator("xpath=following-sibling::dd").filter({ hasText: String(trainees) }).waitFor();
      await page.getByRole("button", { name: "Rename …" }).click();
      await page.getByRole("dialog").getByLabel("New name").fill("Hepatology 2027 / 1.0");
      await dialog_button(page, "Rename");
      await page.getByRole("heading", { level: 1, name: "Hepatology 2027 / 1.0" }).waitFor();
      await page.reload();
      await page.getByRole("heading", { level: 1, name: "Hepatology 2027 / 1.0" }).waitFor();
    }));

  test("PINs are made required by administrators alone", needs_mock, async () => {
    await with_page(async (page) => {
      await page.goto("/account");
      await page.getByLabel("Every person needs a PIN at a station").check();
      await page.getByText("Every person now needs a PIN.").waitFor();
      assert.equal(site.mock!.pins_required, true);
    });
    await with_page(async (page) => {
      await page.goto("/account");
      await settled(page);
      await has_count(page.getByLabel("Every person needs a PIN at a station"), 0);
    }, "instructor", "another long password");
  });
});

describe("attempts", () => {
  test("the list says why an attempt did not pass", needs_mock, () =>
    with_page(async (page) => {
      const all = site.mock!.results.attempts.filter((one) => one.task === "liver-biopsy");
      const harmed = all.find((one) => one.passed === false && one.score !== null && one.score >= 70)!;
      await page.goto(`/people/${harmed.person}?task=liver-biopsy`);
      await settled(page);
      const row = page.locator("tr", { has: page.locator(`a[href="/attempts/${harmed.id}"]`) });
      await row.getByText("The needle went 12 mm into the right portal vein.").waitFor();
      const low = all.find((one) => one.passed === false && one.score !== null && one.score < 70 && all.filter((other) => other.person === one.person).length < 50)!;
      await page.goto(`/people/${low.person}?task=liver-biopsy`);
      await page.locator("tr", { has: page.locator(`a[href="/attempts/${low.id}"]`) }).getByText("The score is below the pass mark of 70.").waitFor();
      await has_count(page.getByRole("columnheader", { name: "Help", exact: true }), 0);
      await page.getByRole("columnheader", { name: "Level of help" }).waitFor();
    }));

  test("a note is written, listed and deleted by its author or an administrator", needs_mock, async () => {
    const attempt = site.mock!.results.attempts[0];
    await with_page(async (page) => {
      await page.goto(`/attempts/${attempt.id}`);
      await settled(page);
      await page.getByRole("button", { name: "Add note" }).click();
      await page.getByText("Enter a text.").waitFor();
      await page.getByLabel("New note").fill("<b>Look</b> at the angle.");
      await page.getByRole("button", { name: "Add note" }).click();
      await page.locator(".comment", { hasText: "<b>Look</b> at the angle." }).waitFor();
      assert.equal(await page.getByLabel("New note").inputValue(), "");
      await page.goto(`/people/${attempt.person}?task=${attempt.task}`);
      await page.getByText("1 note", { exact: true }).waitFor();
    });
    await with_page(async (page) => {
      await page.goto(`/attempts/${attempt.id}`);
      await page.locator(".comment", { hasText: "at the angle" }).waitFor();
      await has_count(page.getByRole("button", { name: "Delete note …" }), 0);
    }, "instructor", "another long password");
    await with_page(async (page) => {
      await page.goto(`/attempts/${attempt.id}`);
      await page.getByRole("button", { name: "Delete note …" }).click();
      await dialog_button(page, "Delete");
      await page.getByText("No notes yet.").waitFor();
      assert.deepEqual(attempt.notes, []);
    });
  });
});

describe("accounts", () => {
  test("an administrator resets the password of another account", needs_mock, () =>
    with_page(async (page) => {
      await page.goto("/account");
      await page.getByRole("button", { name: "Reset the password of instructor" }).click();
      await page.getByRole("dialog").getByLabel("New password", { exact: true }).fill("short");
      await dialog_button(page, "Reset password");
      await page.getByText("Use at least 12 characters.").waitFor();
      const password = "another long password";
      await page.getByRole("dialog").getByLabel("New password", { exact: true }).fill(password);
      await page.getByRole("dialog").getByLabel("New password again").fill(password);
      await dialog_button(page, "Reset password");
      await page.getByText("instructor has a new password.").waitFor();
    }));

  test("signing out keeps the theme and deletes what else the page stored", () =>
    with_page(async (page) => {
      await page.getByRole("button", { name: "Light theme" }).click();
      await page.evaluate(() => sessionStorage.setItem("trocar-form-new", "draft"));
      await page.getByRole("button", { name: "Sign out" }).click();
      await page.waitForURL(/\/login$/);
      await page.getByRole("button", { name: "Dark theme" }).waitFor();
      await page.reload();
      await page.getByRole("button", { name: "Dark theme" }).waitFor();
      assert.equal(await page.evaluate(() => sessionStorage.getItem("trocar-form-new")), null);
    }));
});

test("an answer that arrives after a newer one was asked for is not shown", needs_mock, () =>
  with_page(async (page) => {
    await page.goto("/validity?task=liver-biopsy");
    await settled(page);
    let release = (): void => {};
    const held = new Promise<void>((done) => (release = done));
    await page.route(/\/api\/validity\?task=lumbar-puncture/, async (route) => {
      const answer = await route.fetch();
      await held;
      await route.fulfill({ response: answer });
    });
    await page.getByLabel("Task").selectOption("lumbar-puncture");
    await page.getByLabel("Task").selectOption("ptcd");
    await page.getByText("Fewer than 30 scored attempts.").first().waitFor();
    const late = page.waitForResponse(/task=lumbar-puncture/);
    release();
    await (await late).finished();
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.ok(await page.getByText("Fewer than 30 scored attempts.").first().isVisible());
  }));

test("a printed page has its tables as tables, in the light theme, with everything opened", needs_mock, () =>
  with_page(async (page) => {
    const attempt = site.mock!.results.attempts.find((one) => one.state === "finished")!;
    await page.setViewportSize({ width: 390, height: 844 });
    await page.goto(`/attempts/${attempt.id}`);
    await settled(page);
    assert.ok((await page.locator("details.fold:not([open])").count()) > 0);
    await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    await page.emulateMedia({ media: "print" });
    await has_count(page.locator("details.fold:not([open])"), 0);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "light");
    assert.equal(await page.locator("table[role=table] tbody tr").first().evaluate((one) => getComputedStyle(one).display), "table-row");
    assert.equal(await page.getByRole("button", { name: "Print" }).isVisible(), false);
    await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
    assert.ok((await page.locator("details.fold:not([open])").count()) > 0);
  }));
