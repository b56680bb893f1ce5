// Questionnaires: make, publish, answer, see the means; at a phone's width and by keyboard.

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

const kTitle = `Test of the page ${process.pid}`;

/** Makes a form of one statement and one text; the result is its own path and the public one. */
async function make_form(page: Page, title: string): Promise<{ own: string; open: string }> {
  await page.goto("/forms/new");
  await page.getByLabel("Title").fill(title);
  await page.getByLabel(/^1\. Statement/).fill("The training is useful.");
  await page.getByRole("button", { name: "Save" }).click();
  await page.getByRole("heading", { level: 1, name: title }).waitFor();
  await settled(page);
  const publish = page.getByRole("button", { name: "Open for answers" });
  if (await publish.isVisible()) {
    await publish.click();
    await page.getByRole("button", { name: "Close for answers" }).waitFor();
    await settled(page);
  }
  const open = new URL(await page.getByLabel("Address of the questionnaire").inputValue()).pathname;
  return { own: new URL(page.url()).pathname, open };
}

describe("questionnaire", () => {
  test("made, answered on a phone, summed up, closed and deleted", async () => {
    const { page, problems } = await open_page(browser, site);
    await login(page);
    const { own, open } = await make_form(page, kTitle);
    const phone = await open_page(browser, site, { width: 360, height: 740, touch: true });
    for (const [answer, comment] of [["1", "More cases, please."], ["2", ""], ["6", ""]]) {
      await phone.page.goto(open);
      await phone.page.getByRole("radio").nth(Number(answer) - 1).tap();
      if (comment) await phone.page.getByLabel(/^2\./).fill(comment);
      await phone.page.getByRole("button", { name: "Send answers" }).tap();
      await phone.page.getByRole("heading", { name: "Thank you" }).waitFor();
    }
    // The server may keep a summary for some seconds.
    for (let k = 0; k < 30; k += 1) {
      await page.goto(own);
      await settled(page);
      if (await page.getByRole("heading", { name: "Results: 3 responses" }).isVisible()) break;
      await page.waitForTimeout(1000);
    }
    await page.getByRole("heading", { name: "Results: 3 responses" }).waitFor();
    assert.equal(await page.locator(".mean").first().textContent(), "3.0");
    assert.deepEqual(await page.locator(".distribution-count").allTextContents(), ["1", "1", "0", "0", "0", "1"]);
    await page.getByText("More cases, please.").waitFor();
    await page.getByRole("button", { name: "Close for answers" }).click();
    await page.getByRole("button", { name: "Open for answers" }).waitFor();
    await phone.page.goto(open);
    await phone.page.getByRole("heading", { name: "This questionnaire is not open" }).waitFor();
    await page.getByRole("button", { name: "Delete …" }).click();
    await page.getByRole("dialog").getByRole("button", { name: "Delete" }).click();
    await page.waitForURL(/\/forms$/);
    await settled(page);
    await has_count(page.getByRole("link", { name: kTitle, exact: true }), 0);
    assert.deepEqual([...problems, ...phone.problems], []);
    await page.context().close();
    await phone.page.context().close();
  });

  test("items are added, moved and removed, and the preview follows", async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    await page.goto("/forms/new");
    assert.equal(await page.getByLabel("Introduction").getAttribute("maxlength"), "2000");
    const ends = page.locator(".preview .scale-ends").first();
    assert.equal(await ends.isVisible(), true);
    assert.deepEqual(await ends.locator("span").allTextContents(), ["strongly agree", "strongly disagree"]);
    await page.getByRole("button", { name: "Add a statement" }).click();
    await page.keyboard.type("Third");
    await page.getByRole("button", { name: "Move up item 3" }).click();
    assert.equal(await page.getByLabel(/^2\. Statement/).inputValue(), "Third");
    assert.equal(await page.evaluate(() => document.activeElement?.getAttribute("aria-label")), "Move up item 2");
    await page.locator(".preview legend", { hasText: "2. Third" }).waitFor();
    await page.getByRole("button", { name: "Remove item 2" }).click();
    await has_count(page.locator(".item-editor"), 2);
    await page.getByRole("button", { name: "Save" }).click();
    await page.getByRole("alert").filter({ hasText: "Enter a title." }).waitFor();
    await page.context().close();
  });

  test("unsaved changes outlive a session that ends, and can be discarded", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    await page.goto("/forms/1/edit");
    await page.getByLabel("Title").fill("Changed title");
    site.mock!.expire_sessions();
    await page.getByRole("button", { name: "Save" }).click();
    await page.getByText("You were signed out").waitFor();
    await page.getByLabel("Name").fill("Dr. Weber");
    await page.getByLabel("Password").fill("a long test password");
    await page.keyboard.press("Enter");
    await page.getByText("Unsaved changes were restored.").waitFor();
    assert.equal(await page.getByLabel("Title").inputValue(), "Changed title");
    await page.getByRole("button", { name: "Discard them" }).click();
    await page.waitForFunction(() => (document.querySelector("form input") as HTMLInputElement | null)?.value === "Simulator study");
    await page.reload();
    await settled(page);
    assert.equal(await page.getByLabel("Title").inputValue(), "Simulator study");
    await page.context().close();
  });

  test("answered by keyboard alone; the first missing answer gets the focus", needs_mock, async () => {
    const { page, problems } = await open_page(browser, site);
    await page.goto("/q/test-token-1-abcdefghijklmnop");
    await page.getByRole("heading", { level: 1 }).waitFor();
    const send = page.getByRole("button", { name: "Send answers" });
    await send.focus();
    await page.keyboard.press("Enter");
    await page.getByRole("alert").filter({ hasText: "4 answers are missing" }).waitFor();
    assert.equal(await page.evaluate(() => (document.activeElement as HTMLInputElement).type), "radio");
    for (let k = 0; k < 4; k += 1) {
      await page.keyboard.press("Space");
      await page.keyboard.press("ArrowRight");
      await page.keyboard.press("Tab");
    }
    await page.keyboard.type("By keyboard");
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { name: "Thank you" }).waitFor();
    const form = site.mock!.forms.find("1")!;
    const summary = site.mock!.forms.summary(form) as { items: { counts?: number[]; comments?: { text: string }[] }[] };
    assert.ok(summary.items[4].comments!.some((one) => one.text === "By keyboard"));
    assert.deepEqual(problems, []);
    await page.context().close();
  });

  test("answers stay when the network fails and after a reload, and go once", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await page.goto("/q/test-token-1-abcdefghijklmnop");
    for (let k = 0; k < 4; k += 1) await page.locator(".item").nth(k).getByRole("radio").nth(k).click();
    await page.getByLabel(/^5\./).fill("Kept text");
    const before = site.mock!.answers_received;
    await page.route("**/answers", (route) => route.abort());
    const send = page.getByRole("button", { name: "Send answers" });
    await send.click();
    await page.getByRole("alert").filter({ hasText: "They are kept on this page" }).waitFor();
    await page.unroute("**/answers");
    await page.reload();
    await page.getByRole("heading", { level: 1 }).waitFor();
    assert.equal(await page.getByLabel(/^5\./).inputValue(), "Kept text");
    await has_count(page.locator("input[type=radio]:checked"), 4);
    await page.route("**/answers", async (route) => {
      await new Promise((done) => setTimeout(done, 300));
      await route.continue();
    });
    await send.click();
    await page.getByRole("button", { name: "Sending …" }).click({ force: true });
    await page.getByRole("heading", { name: "Thank you" }).waitFor();
    assert.equal(site.mock!.answers_received, before + 1);
    await page.getByRole("button", { name: "Answer for another person" }).click();
    await has_count(page.locator("input[type=radio]:checked"), 0);
    await page.context().close();
  });

  test("answers that arrived although the page lost the server's word are counted once", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    const form = site.mock!.forms.find("1")!;
    const responses = (): number => (site.mock!.forms.summary(form) as { responses: number }).responses;
    const before = responses();
    await page.goto("/q/test-token-1-abcdefghijklmnop");
    for (let k = 0; k < 4; k += 1) await page.locator(".item").nth(k).getByRole("radio").first().click();
    await page.route("**/answers", async (route) => {
      await route.fetch();
      await route.abort();
    });
    await page.getByRole("button", { name: "Send answers" }).click();
    await page.getByRole("alert").waitFor();
    assert.equal(responses(), before + 1);
    await page.unroute("**/answers");
    await page.reload();
    await page.getByRole("button", { name: "Send answers" }).click();
    await page.getByRole("heading", { name: "Thank you" }).waitFor();
    assert.equal(responses(), before + 1);
    await page.context().close();
  });

  test("the standard questionnaire is one click", async () => {
    const { page } = await open_page(browser, site);
    await login(page);
    await page.goto("/forms");
    await settled(page);
    await page.getByRole("button", { name: "Standard questionnaire" }).click();
    await page.waitForURL(/\/forms\/[^/]+$/);
    await page.getByRole("heading", { name: "Results: 0 responses" }).waitFor();
    await has_count(page.locator(".table tbody tr"), 4);
    await page.getByRole("button", { name: "Delete …" }).click();
    await page.getByRole("dialog").getByRole("button", { name: "Delete" }).click();
    await page.waitForURL(/\/forms$/);
    await page.context().close();
  });

  test("an error of the server is shown with its advice, and the answers stay", needs_mock, async () => {
    const { page } = await open_page(browser, site);
    await page.goto("/q/test-token-1-abcdefghijklmnop");
    for (let k = 0; k < 4; k += 1) await page.locator(".item").nth(k).getByRole("radio").first().click();
    for (const status of [500, 429, 400]) {
      site.mock!.fail_next("/api/public/forms/test-token-1-abcdefghijklmnop/answers", status, status === 429 ? { "Retry-After": "30" } : {});
      await page.getByRole("button", { name: "Send answers" }).click();
      await page.getByRole("alert").filter({ hasText: `failure ${status} for the test` }).waitFor();
      await page.getByText("advice for the test").waitFor();
      if (status === 429) await page.getByText("Try again in 30 s").waitFor();
      await has_count(page.locator("input[type=radio]:checked"), 4);
    }
    await page.context().close();
  });

  test("HTML in a comment is text", needs_mock, async () => {
    const { page, problems } = await open_page(browser, site);
    await login(page);
    await page.goto("/forms/1");
    await page.getByText("<script>alert('comment')</script>").waitFor();
    await has_count(page.locator("main script"), 0);
    assert.deepEqual(problems, []);
    await page.context().close();
  });
});
