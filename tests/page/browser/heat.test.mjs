// A page of heat: the program's temperatures and fluxes, on patches, by surface, and between two patches.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { apart, colours, folder, launch, open, results } from "./support.mjs";

let browser, page, said;
before(async () => {
  browser = await launch();
  ({ page, said } = await open(browser, "heat.html"));
});
after(() => browser?.close());

const near = (x, y) => Math.abs(x - y) <= 1e-6 * Math.abs(y) + 1e-9;

test("temperatures are shown first, with a legend, and each quantity has colours of its own", async () => {
  assert.equal(await page.locator("#show").inputValue(), "temperature");
  assert.match(await page.locator("#legend-title").textContent(), /Temperature, K/);
  const temperature = await colours(page);
  await page.locator("#show").selectOption("net-flux");
  assert.match(await page.locator("#legend-title").textContent(), /Net flux/);
  assert.ok(apart(temperature, await colours(page)) > 15);
  await page.locator("#show").selectOption("temperature");
});

test("the table by surface is that of radiosity heat", async () => {
  const [head, ...lines] = readFileSync(join(folder, "pages/heat.csv"), "utf8").trim().split("\n").map((l) => l.split(","));
  const column = (line, name) => Number(line[head.indexOf(name)]);
  const rows = await page.locator("#heat-surfaces tr").all();
  assert.equal(rows.length, lines.length);
  for (const [k, row] of rows.entries()) {
    assert.equal(await row.locator("th").textContent(), lines[k][0]);
    const shown = await row.locator("data").evaluateAll((cells) => cells.map((c) => Number(c.value)));
    const expected = [column(lines[k], "temperature_K"), column(lines[k], "net_flux_W_per_m2"),
      column(lines[k], "radiated_W") + column(lines[k], "convected_W")];
    shown.forEach((x, c) => assert.ok(near(x, expected[c]), `${lines[k][0]}: ${x}, not ${expected[c]}`));
  }
});

test("a picked patch has its temperature, two have their net exchange A F (J - J')", async () => {
  const truth = results("heat.h5");
  await page.evaluate(() => document.getElementById("patch-panel").setAttribute("open", ""));
  for (const [name, patch] of [["first", 3], ["second", 60]]) {
    await page.locator(`#pick-${name}`).fill(String(patch));
    await page.locator(`#pick-${name}`).press("Enter");
  }
  await page.locator('[data-pick="pair"]').waitFor();
  const value = async (of, label) =>
    Number(await page.locator(`[data-pick="${of}"] dt:text-is("${label}") + dd data`).getAttribute("value"));
  assert.ok(near(await value("first", "Temperature, K"), truth.temperature[3]));
  assert.ok(near(await value("second", "Net flux of heat, W/m²"), truth.net_flux[60]));
  const expected = truth.area[3] * truth.factors[3][60] * (truth.radiosity[3] - truth.radiosity[60]);
  const shown = await value("pair", "Net heat there, W");
  assert.ok(expected !== 0);
  // Form factors have 16 bits: 3e-4.
  assert.ok(Math.abs(shown - expected) <= 3e-4 * Math.abs(expected), `${shown}, not ${expected}`);
  assert.deepEqual(said, []);
});

test("two surfaces have their form factors both ways, and their net exchange", async () => {
  const truth = results("heat.h5");
  const names = await page.locator("#surface-first option").allTextContents();
  const of = ["ceiling", "floor"].map((part) => names.findIndex((name) => name.includes(part)) - 1);
  assert.ok(of.every((k) => k >= 0) && of[0] !== of[1], String(names));
  await page.locator("#surface-first").selectOption(String(of[0]));
  await page.locator("#surface-second").selectOption(String(of[1]));
  const value = async (label) =>
    Number(await page.locator(`#surface-pair dt:text-is("${label}") + dd data`).getAttribute("value"));
  const patches = of.map((k) => truth.surface.flatMap((s, i) => (s === k ? [i] : [])));
  const sum = (from, to, of) =>
    from.reduce((all, i) => all + to.reduce((row, j) => row + truth.area[i] * truth.factors[i][j] * of(i, j), 0), 0);
  const areas = patches.map((list) => list.reduce((all, i) => all + truth.area[i], 0));
  const expected = {
    "F there": sum(patches[0], patches[1], () => 1) / areas[0],
    "F back": sum(patches[1], patches[0], () => 1) / areas[1],
    "Area of the first, m²": areas[0],
    "Area of the second, m²": areas[1],
    "Net heat there, W": sum(patches[0], patches[1], (i, j) => truth.radiosity[i] - truth.radiosity[j]),
  };
  for (const [label, x] of Object.entries(expected)) {
    assert.ok(x !== 0);
    // Form factors have 16 bits: 3e-4.
    const shown = await value(label);
    assert.ok(Math.abs(shown - x) <= 3e-4 * Math.abs(x), `${label}: ${shown}, not ${x}`);
  }
  assert.ok((await value("Reciprocity, difference")) < 1e-5); // of single precision
  assert.deepEqual(said, []);
});
