// What the tests share: folders, results files as JSON, the browser.
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const folder = process.env.PAGE_FOLDER;
export const program = process.env.RADIOSITY;

export function results(name, ...options) {
  const script = join(process.env.PAGE_ROOT, "tests/page/browser/results.py");
  return JSON.parse(
    execFileSync("/usr/bin/python3", [script, join(folder, "pages", name), ...options], { maxBuffer: 1 << 30 }),
  );
}

export const module = (name) => import(join(folder, "modules", `${name}.mjs`));

/** The data of a page as its own reader sees them. */
export async function pageData(name) {
  const { unpack } = await module("load");
  const { readContainer } = await module("container");
  const text = readFileSync(join(folder, "pages", name), "utf8").match(
    /<script id="radiosity-data"[^>]*>([^]*?)<\/script>/,
  )[1];
  return readContainer(await unpack(text, () => {}));
}

export function launch() {
  const browser = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser"].find(
    (path) => path && existsSync(path),
  );
  if (!browser) throw new Error("The tests of the page need Debian's package chromium");
  return chromium.launch({
    executablePath: browser,
    args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"],
  });
}

/** A page that was loaded, and what its console said. */
export async function open(browser, name, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, reducedMotion: "reduce", ...options });
  const said = [];
  page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  await page.goto(`file://${join(folder, "pages", name)}`);
  await page.waitForFunction(
    () => document.documentElement.dataset.ready || document.querySelector("#loading.failed"),
    null,
    { timeout: 60000 },
  );
  return { page, said };
}

/** Irradiance of patches as the page shows it. */
export async function irradiance(page, patches) {
  const shown = [];
  for (const patch of patches) {
    await page.locator("#pick-first").fill(String(patch));
    await page.locator("#pick-first").press("Enter");
    const row = await page
      .locator('[data-pick="first"] tr[data-row] data')
      .evaluateAll((cells) => cells.map((c) => Number(c.value)));
    shown.push(...row.slice(6, 9));
  }
  return shown;
}

/** Root of the sum of squared differences, over that of the second. */
export function relativeError(values, truth) {
  let difference = 0,
    size = 0;
  truth.forEach((x, k) => {
    difference += (values[k] - x) ** 2;
    size += x * x;
  });
  return Math.sqrt(difference / size);
}
