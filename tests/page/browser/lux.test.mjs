// Lux at the pointer and isolines, against `radiosity render --show illuminance`.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { commandPicture, launch, module, open, results, saved, setOptions } from "./support.mjs";

let browser, page, said, picture;
before(async () => {
  browser = await launch();
  ({ page, said } = await open(browser, "cornell.html", {}, "#show=illuminance"));
  picture = page.locator("#picture");
});
after(() => browser?.close());

const lux = (...words) =>
  JSON.parse(execFileSync("/usr/bin/python3", [join(process.env.PAGE_ROOT, "tests/page/browser/lux.py"), ...words]));

async function valueAt(x, y) {
  await picture.hover({ position: { x, y } });
  await page.waitForTimeout(300); // what is said of the place before is over
  await page.evaluate(() => { delete document.getElementById("pointer-value").dataset.value; });
  await picture.hover({ position: { x, y: y + 0.25 } });
  await page.waitForFunction(() => document.getElementById("pointer-value").dataset.value);
  return Number(await page.locator("#pointer-value").getAttribute("data-value"));
}

test("the pointer has the lux of the place, as render has it", async (t) => {
  const [file] = await commandPicture(page, "lux.exr", /--range \S+/);
  const places = [[200, 300], [450, 300], [700, 300], [480, 120], [550, 480], [420, 690], [390, 500]];
  const truth = lux(file, ...places.map(String));
  for (const [k, [x, y]] of places.entries()) {
    const value = await valueAt(x, y);
    t.diagnostic(`${value.toFixed(1)} lx, render ${truth[k].toFixed(1)} lx`);
    // Elements of all patches are less fine than those of a picture: 1% of the light, and a pixel.
    assert.ok(Math.abs(value - truth[k]) < 0.02 * truth[k], `${x}, ${y}: ${value} lx, not ${truth[k]}`);
  }
  assert.match(await page.locator("#pointer-value").textContent(), /^[\d.]+ lx · .*block/);
  await page.locator("#show").selectOption("light");
  assert.ok(Math.abs(await valueAt(450, 301) - truth[1]) < 0.02 * truth[1], "the picture's light is measured, too");
  await page.locator("#show").selectOption("radiosity");
  await valueAt(450, 300);
  assert.match(await page.locator("#pointer-value").textContent(), / W\/m² · /);
  await picture.hover({ position: { x: 20, y: 20 } }); // beside the scene
  await page.waitForFunction(() => document.getElementById("pointer-value").hidden);
});

test("isolines lie at round numbers of lux", async (t) => {
  await page.locator("#show").selectOption("illuminance");
  await page.evaluate(() => document.getElementById("share-panel").setAttribute("open", ""));
  const [file] = await commandPicture(page, "lux.exr", /--range \S+/);
  const without = await saved(page, "#save-picture");
  execFileSync("/bin/cp", [without, `${without}.without.png`]);
  await page.locator("#isolines").check();
  assert.match(await page.locator("#isolines-step").textContent(), /, every 100 lx/);
  await page.waitForTimeout(500);
  const { share, count } = lux(file, "--lines", "100", `${without}.without.png`, await saved(page, "#save-picture"));
  t.diagnostic(`${count} pixels of lines, ${(100 * share).toFixed(1)}% of them beside a multiple of 100 lx`);
  assert.ok(count > 3000, `${count} pixels`);
  assert.ok(share > 0.95, `${share}`);
  await page.locator("#show").selectOption("row-sum"); // of patches: not interpolated, and without lines
  assert.equal(await page.locator("#isolines-step").textContent(), "");
  assert.deepEqual(said, []);
});

test("black bodies have their published chromaticities", async () => {
  const { planckian } = await module("colour");
  // x, y of CIE 15: illuminant A, and 5,000 K and 6,500 K of the Planckian locus. The fit is off by up to .0006.
  for (const [kelvin, x, y] of [[2856, 0.4476, 0.4074], [5000, 0.3451, 0.3516], [6500, 0.3135, 0.3237]]) {
    const [r, g, b] = planckian(kelvin);
    const X = 0.4124564 * r + 0.3575761 * g + 0.1804375 * b;
    const Y = 0.2126729 * r + 0.7151522 * g + 0.072175 * b;
    const Z = 0.0193339 * r + 0.119192 * g + 0.9503041 * b;
    assert.ok(Math.abs(X / (X + Y + Z) - x) < 1e-3 && Math.abs(Y / (X + Y + Z) - y) < 1e-3, `${kelvin} K`);
    assert.equal(Math.max(r, g, b), 1);
  }
});

test("a lamp has its lumens, which a colour temperature keeps", async () => {
  const truth = results("cornell.h5");
  const lumens = truth.area.reduce((sum, area, i) => {
    const [r, g, b] = truth.emission.slice(3 * i, 3 * i + 3);
    return sum + 683 * area * (0.2126 * r + 0.7152 * g + 0.0722 * b);
  }, 0);
  await page.evaluate(() => { document.getElementById("relight-panel").open = true; });
  const lamp = page.locator('.relight[data-name="light"][data-what="strength"]');
  const shown = async () => Number((await lamp.locator("span.note").last().textContent()).match(/^([\d.]+) lm$/)[1]);
  assert.ok(Math.abs((await shown()) - lumens) < 1e-3 * lumens, `${await shown()} lm, not ${lumens}`);
  await lamp.locator("input[type=number]").fill("2700");
  await lamp.locator("input[type=number]").press("Enter");
  await page.waitForFunction(() => document.getElementById("relight-facts").dataset.state === "solved");
  assert.ok(Math.abs((await shown()) - lumens) < 1e-3 * lumens, `${await shown()} lm, not ${lumens}`);
  const [, option] = await setOptions(page);
  const rgb = option.split("=")[1].split(",").map(Number);
  const { planckian } = await module("colour");
  rgb.forEach((x, b) => assert.ok(Math.abs(x / Math.max(...rgb) - planckian(2700)[b]) < 1e-5, option));
  await lamp.getByRole("button").click();
  assert.equal(await lamp.locator("input[type=number]").inputValue(), "");
});
