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

/** Makes a page that of a person who was here before, who is not offered the tour. */
export const visited = (page) => page.addInitScript(() => localStorage.setItem("radiosity-visited", "1"));

/** A page that was loaded, and what its console said. `again`: visited() before. */
export async function open(browser, name, options = {}, fragment = "", again = true) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, reducedMotion: "reduce", ...options });
  if (again) await visited(page);
  const said = [];
  page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  await page.goto(`file://${join(folder, "pages", name)}${fragment}`);
  await page.waitForFunction(
    () => document.documentElement.dataset.ready || document.querySelector("#loading.failed"),
    null,
    { timeout: 60000 },
  );
  return { page, said };
}

/** Of the page's command, the options that set lamps and materials. */
export async function setOptions(page) {
  const command = await page.locator("#command").textContent();
  return [...command.matchAll(/(--set|--light|--sky) (\S+)/g)].flatMap(([, option, value]) => [option, value]);
}

/** Clicks a button and saves what it gives. */
export async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator(button).click()]);
  const file = join(folder, "pages", download.suggestedFilename());
  await download.saveAs(file);
  return file;
}

/** Runs the page's command as a shell does, without `leftOut`. The picture's file, and the command. */
export async function commandPicture(page, name, leftOut = "") {
  const file = join(folder, "pages", name);
  const command = await page.locator("#command").textContent();
  const words = command.replace(leftOut, "").replace("radiosity render", `'${program}' render --quiet`).replace(/-o \S+$/, `-o '${file}'`);
  execFileSync("/bin/sh", ["-c", words]);
  return [file, command];
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

/** Colours of a grid of points of the picture without what the pointer says, sRGB 0 to 255; the browser itself decodes the screenshot. */
export async function colours(where) {
  await where.waitForFunction(() => !document.getElementById("picture").hasAttribute("data-moving"));
  await where.waitForTimeout(150);
  const png = (await where.locator("#picture").screenshot({ style: "#pointer-value { visibility: hidden }" })).toString("base64");
  return where.evaluate(async (data) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const points = [];
    for (let y = 0.05; y < 1; y += 0.1) {
      for (let x = 0.05; x < 1; x += 0.1)
        points.push(...context.getImageData(x * image.width, y * image.height, 1, 1).data.slice(0, 3));
    }
    return points;
  }, png);
}
/** The same grid of points of a PNG, with alpha. */
export function pixels(file) {
  const script = [
    "import sys, json",
    "from PIL import Image",
    "shown = Image.open(sys.argv[1]).convert('RGBA')",
    "image = Image.new('RGBA', shown.size, (0, 0, 0, 0))",
    "image.alpha_composite(shown)",
    "at = lambda x, y: (int((.05 + .1 * x) * image.width), int((.05 + .1 * y) * image.height))",
    "print(json.dumps([list(image.getpixel(at(x, y))) for y in range(10) for x in range(10)]))",
  ].join("\n");
  return JSON.parse(execFileSync("/usr/bin/python3", ["-c", script, file]));
}

/** Root mean square. */
export const apart = (a, b) => Math.sqrt(a.reduce((sum, x, k) => sum + (x - b[k]) ** 2, 0) / a.length);

/** Of these colours, those of the picture's left or right half. */
export const half = (values, left) => values.filter((_, k) => Math.floor(k / 3) % 10 < 5 === left);

/** A computed style of the first element of `selector`. */
export const style = (where, selector, name) =>
  where.locator(selector).first().evaluate((e, property) => getComputedStyle(e)[property], name);
