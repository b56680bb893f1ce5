// A browser on the page under test: the mock server, or the server that TROCAR_WEB_URL names.

import assert from "node:assert/strict";
import { setTimeout as sleep } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { chromium, type Browser, type Locator, type Page } from "playwright-core";
import { MockServer } from "../mock/server.ts";

export const kFolder = process.env.TROCAR_WEB_FOLDER ?? fileURLToPath(new URL("../../../../data/web", import.meta.url));
export const real_url = process.env.TROCAR_WEB_URL ?? null;
export const kName = process.env.TROCAR_WEB_NAME ?? "Dr. Weber";
export const kPassword = process.env.TROCAR_WEB_PASSWORD ?? "a long test password";

export async function start_browser(): Promise<Browser> {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
}

export interface Site {
  url: string;
  /** Null at a real server. */
  mock: MockServer | null;
  stop: () => Promise<void>;
}
export async function start_site(): Promise<Site> {
  if (real_url) return { url: real_url.replace(/\/$/, ""), mock: null, stop: async () => {} };
  const mock = new MockServer(kFolder);
  return { url: await mock.start(), mock, stop: () => mock.stop() };
}

export interface Look {
  width?: number;
  height?: number;
  theme?: "dark" | "light";
  touch?: boolean;
  /** Of the browser; English if it is left out. */
  locale?: string;
}
/** A page in a context of its own. Every message of the console that is an error is collected. */
export async function open_page(browser: Browser, site: Site, look: Look = {}): Promise<{ page: Page; problems: string[] }> {
  const context = await browser.newContext({
    baseURL: site.url, viewport: { width: look.width ?? 1280, height: look.height ?? 900 }, colorScheme: look.theme ?? "dark", ignoreHTTPSErrors: true, reducedMotion: "reduce", hasTouch: look.touch ?? false, locale: look.locale ?? "en-US",
  });
  const page = await context.newPage();
  page.setDefaultTimeout(10_000);
  const problems: string[] = [];
  page.on("pageerror", (error) => problems.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error" && !/Failed to load resource/.test(message.text())) problems.push(message.text());
  });
  page.on("request", (request) => {
    if (!request.url().startsWith(site.url) && !request.url().startsWith("data:")) problems.push(`request to another host: ${request.url()}`);
  });
  return { page, problems };
}

/** Waits until exactly so many elements are there: what a click opens may be made by a later event. */
export async function has_count(found: Locator, expected: number): Promise<void> {
  const end = performance.now() + 10_000;
  while ((await found.count()) !== expected && performance.now() < end) await sleep(20);
  assert.equal(await found.count(), expected);
}

export async function settled(page: Page): Promise<void> {
  await page.waitForFunction(() => !document.querySelector("[aria-busy=true]") && document.querySelector("h1") !== null);
}

export async function login(page: Page, name = kName, password = kPassword): Promise<void> {
  await page.goto("/login");
  await page.getByLabel("Name").fill(name);
  await page.getByLabel("Password").fill(password);
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByRole("heading", { level: 1, name: "Cohort" }).waitFor();
  await settled(page);
}

/** The path of the person with the most attempts, from the cohort's own order. */
export async function busiest_person(page: Page): Promise<string> {
  await page.goto("/?order=attempts.down");
  await settled(page);
  return first_link(page, "/people/");
}

/** The path of the first link whose address begins so. */
export async function first_link(page: Page, start: string): Promise<string> {
  return (await page.locator(`main table a[href^="${start}"]`).first().getAttribute("href"))!;
}
