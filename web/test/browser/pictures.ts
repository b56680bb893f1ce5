// Pictures of every page: npm run pictures -- FOLDER. Three widths, two themes; LOCALE=de-DE for German.

import { mkdir } from "node:fs/promises";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { busiest_person, first_link, open_page, settled, start_browser, start_site } from "./browser.ts";
import { login_anyhow } from "./walk.ts";

const folder = process.argv[2] ?? "pictures";
const only = process.argv[3];
await mkdir(folder, { recursive: true });
const site = await start_site();
const browser = await start_browser();
const sizes: [number, number][] = [[1280, 800], [768, 1024], [390, 844]];

async function paths(page: Page): Promise<[string, string][]> {
  const person = process.env.PERSON ?? (await busiest_person(page));
  await page.goto(person);
  await settled(page);
  await page.waitForTimeout(300);
  const attempt = await first_link(page, "/attempts/");
  await page.goto("/forms");
  await settled(page);
  if ((await page.locator("table a[href^='/forms/']").count()) === 0) {
    await page.locator(".page-actions button").first().click();
    await page.waitForURL(/\/forms\/[^/]+$/);
    await page.goto("/forms");
    await settled(page);
  }
  const form = await first_link(page, "/forms/");
  await page.goto("/courses");
  await settled(page);
  const course = await first_link(page, "/course").catch(() => "/course");
  const list: [string, string][] = [["cohort", "/"], ["cohort_task", "/?task=liver-biopsy&order=mean.down"], ["person", person], ["attempt", attempt], ["courses", "/courses"], ["course", course], ["metrics", "/metrics?task=liver-biopsy&metric=target_distance"], ["validity", "/validity?task=liver-biopsy"], ["proficiency", "/proficiency?task=liver-biopsy"], ["forms", "/forms"], ["form", form], ["editor", `${form}/edit`], ["account", "/account"]];
  await page.goto(form);
  await settled(page);
  const address = await page.locator(".address input").inputValue();
  list.push(["questionnaire", new URL(address).pathname]);
  return list;
}

for (const theme of ["dark", "light"] as const) {
  for (const [width, height] of sizes) {
    const { page, problems } = await open_page(browser, site, { width, height, theme, locale: process.env.LOCALE ?? "en-US" });
    await page.goto("/login");
    await settled(page);
    await page.screenshot({ path: join(folder, `login_${theme}_${width}.png`), fullPage: true });
    await login_anyhow(page);
    for (const [name, path] of await paths(page)) {
      if (only && !only.split(",").includes(name)) continue;
      await page.goto(path);
      await settled(page);
      await page.waitForTimeout(250);
      if (name === "attempt" && width > 560) {
        await page.getByRole("slider").evaluate((one: HTMLInputElement) => {
          one.value = String(0.7 * Number(one.max));
          one.dispatchEvent(new Event("input"));
        });
      }
      if (name === "questionnaire") await page.locator("input[type=radio]").nth(1).check({ force: true });
      await page.screenshot({ path: join(folder, `${name}_${theme}_${width}.png`), fullPage: true });
    }
    if (problems.length) console.log(theme, width, problems);
    await page.context().close();
  }
}
await browser.close();
await site.stop();
